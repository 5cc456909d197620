"""Pressures with a potential, whose tangent is symmetric."""

from collections import defaultdict

import numpy as np

from beamfem.model.load_arrays import forces_of
from beamfem.model.model import Model


def pressures_have_potential(model: Model, prescribed: set[int]) -> bool:
    """Return whether the work of all pressures depends on the configuration only.

    prescribed: numbers of the prescribed coordinates. Besides p times the change of area, a pressure p does the work
    p (x dy - y dx) / 2 at the end of its beam, and minus that at its start. This part is zero where x or y is
    prescribed, and cancels where a ring closes or another beam continues under the same pressure. If p varies along the
    beam, it remains at every point.
    """
    amplitudes = [load.amplitude for load in model.line_loads]  # kept alive, so that their ids stay different
    ends: defaultdict[tuple[int, bool, int], float] = defaultdict(float)
    for load, amplitude in zip(model.line_loads, amplitudes, strict=True):
        if load.axes != "axis":
            continue
        along, across = forces_of(load, np.zeros(1))[0].tolist()
        if not load.uniform or along != 0.0:
            return False
        mesh = model.mesh_of(load.beam.start)
        first, last = mesh.kinematics.dof[mesh.node[0, 0], 0], mesh.kinematics.dof[mesh.node[-1, -1], 0]
        for dof, sign in ((int(first), -1.0), (int(last), 1.0)):
            ends[id(amplitude), load.scale, dof] += sign * across
    return all(left == 0.0 or dof in prescribed or dof + 1 in prescribed for (_, _, dof), left in ends.items())
