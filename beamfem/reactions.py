"""Forces and moments that supports exert on a beam."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.analysis.equations import residual
from beamfem.errors import InputError
from beamfem.last_digits import exactly
from beamfem.model.beam import Point
from beamfem.model.system import system_of

if TYPE_CHECKING:
    from beamfem.solution import Solution


def reaction(solution: "Solution", point: Point) -> np.ndarray:
    """Return fx, fy [N] and m [N m] of the supports and springs at a point (steps, 3).

    Raises InputError where no support is.
    """
    model = solution.model
    mesh = model.mesh_of(point)
    near = [s for s in model.point_supports if s.point.beam is point.beam]
    if not any(abs(support.point.fraction - point.fraction) < 1e-9 for support in near):
        raise InputError(f"there is no support at {point}, so there is no reaction")
    dofs = mesh.coordinates_of(mesh.node_at(point.fraction))
    result = np.zeros((len(solution), 3))
    for column, name in enumerate(("r^x", "r^y", "theta")):
        if name in dofs:
            result[:, column] = solution.support_forces[:, dofs[name]]
    return result


def support_forces(solution: "Solution") -> np.ndarray:
    """Return the generalized forces (steps, n) that supports and springs exert on every coordinate."""
    model = solution.model
    system = system_of(model, solution.static)
    held = np.zeros(model.size, dtype=bool)
    held[system.held_dofs] = True
    for dof, _ in system.inclined:
        held[dof : dof + 2] = True
    springs = system.springs

    def forces(p: np.ndarray) -> np.ndarray:
        result = np.zeros(p.shape)
        for row, at in enumerate(solution.at):
            result[row] = np.where(held, residual(system, p[row], solution.v[row], solution.a[row], at), 0.0)
            np.subtract.at(result[row], springs.dof, springs.stiffness * (p[row, springs.dof] - springs.rest))
        return result

    return exactly(solution, forces)
