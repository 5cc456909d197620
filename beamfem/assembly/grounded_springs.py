"""Springs from single coordinates to the ground, in the form that the kernels expect."""

import numpy as np

from beamfem.assembly.equation_numbering import Unknowns
from beamfem.assembly.prescribed import COORDINATES
from beamfem.kernels.block import Springs
from beamfem.model.model import Model

_NONE = Springs(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0), np.empty(0, dtype=np.int64))


def grounded_springs(model: Model, unknowns: Unknowns, reference: np.ndarray) -> Springs:
    """Return the springs of a model, which are unstressed at the coordinates `reference` (n,)."""
    dofs, stiffness = [], []
    for support in model.point_supports:
        if springs := support.springs():
            mesh = model.mesh_of(support.point)
            coordinates = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            for direction, value in springs.items():
                dofs.append(coordinates[COORDINATES[direction]])
                stiffness.append(value)
    if not dofs:
        return _NONE
    where = np.array(dofs, dtype=np.int64)
    free = unknowns.free[where]
    positions = free.copy()
    positions[free >= 0] = unknowns.diagonal(free[free >= 0])
    return Springs(where, np.array(stiffness, dtype=float), reference[where], positions)
