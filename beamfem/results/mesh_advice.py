"""Elements that are bent so much that a mesh is too coarse for what the beam does."""

import numpy as np

from beamfem.model.beam_names import beam_in_words
from beamfem.model.model import Model
from beamfem.results.postprocess import nodal_rotations

_MUCH = 1.5  # [rad]: an element that turns by this much between its ends is far from the curve that it stands for


def advice(model: Model, p: np.ndarray) -> str:
    """Return "; ... use more elements" if an element is bent that much in a state p (n,), otherwise nothing."""
    worst, where = 0.0, 0
    for number, mesh in enumerate(model.meshes):
        rotation = nodal_rotations(mesh, p[None])[0]
        bent = float(np.abs(np.diff(rotation[mesh.node[:, [0, -1]]], axis=1)).max())
        if bent > worst:
            worst, where = bent, number
    if not worst > _MUCH:
        return ""
    return f"; an element of {beam_in_words(model.beams, where)} is bent by {worst:.2g} rad there: use more elements"
