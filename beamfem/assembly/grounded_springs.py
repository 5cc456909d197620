"""Springs of single coordinates to the ground, as the kernels take them."""

import numpy as np

from beamfem.assembly.layout import Unknowns
from beamfem.kernels.block import Springs
from beamfem.model.model import Model
from beamfem.model.supports import Spring


def grounded_springs(model: Model, unknowns: Unknowns, reference: np.ndarray) -> Springs:
    """Return the springs of a model whose coordinates are `reference` (n,) where no spring pulls."""
    dofs, stiffness = [], []
    for support in model.supports:
        if isinstance(support, Spring):
            mesh = model.mesh_of(support.point)
            known = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            for name, value in support.by_coordinate.items():
                if value > 0.0:
                    dofs.append(known[name])
                    stiffness.append(value)
    where = np.array(dofs, dtype=np.int64)
    free = unknowns.free[where]
    place = free.copy()
    place[free >= 0] = unknowns.diagonal(free[free >= 0])
    return Springs(where, np.array(stiffness, dtype=float), reference[where], place)
