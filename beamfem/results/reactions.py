"""Forces and moments that supports exert on a beam."""

from collections.abc import Sequence

import numpy as np

from beamfem.assembly.equations import residual
from beamfem.assembly.model_coordinates import COORDINATES, coordinate_of
from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport
from beamfem.results.roundoff_corrections import exactly
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading


def reaction(solution: Solution, point: Point) -> np.ndarray:
    """Return fx, fy [N] and m [N m] of the supports and springs at a point of a beam (steps, 3).

    Supports at joined points of other beams are not included. Raises InputError if the point has no support.
    """
    model = solution.model
    model.mesh_of(point)  # refuses what is no point of this model
    supports = model.supports_along.near(point, 1e-9)
    if not supports:
        raise InputError(f"there is no support at {point}, so there is no reaction")
    return reaction_of(solution, supports)


def reaction_of(solution: Solution, own: Sequence[PointSupport]) -> np.ndarray:
    """Return fx, fy [N] and m [N m] (steps, 3) of all supports at one point of a beam."""
    point = own[0].point
    mesh = solution.model.mesh_of(point)
    dofs = mesh.coordinates_of(mesh.node_at(point.fraction))
    prescribed = {coordinate_of(support, direction) for support in own for direction in support.prescribed()}
    if None in prescribed:  # an inclined roller
        prescribed |= {"r^x", "r^y"}
    result = np.zeros((len(solution), 3))
    for column, (direction, name) in enumerate(COORDINATES.items()):
        if name in dofs:
            stiffness = sum(support.springs().get(direction, 0.0) for support in own)
            result[:, column] = _of_some(solution, dofs[name], name in prescribed, stiffness)
    return result


def _of_some(solution: Solution, dof: int, prescribed: bool, stiffness: float) -> np.ndarray:
    """Return the force (steps,) of supports with this stiffness on a coordinate, prescribed by them or not."""
    system, _ = loading(solution)
    moved = solution.p[:, dof] - system.reference[dof] + solution.remainders[:, dof]
    if not prescribed:
        return np.asarray(-stiffness * moved)
    others = float(system.springs.stiffness[system.springs.dof == dof].sum()) - stiffness
    return np.asarray(solution.support_forces[:, dof] + others * moved)


def _supported(system: System) -> set[int]:
    """Return the coordinates on which supports other than springs act."""
    inclined = {dof + axis for dof, _ in system.inclined for axis in (0, 1)}
    return {*system.prescribed_dofs.tolist(), *inclined}


def support_forces(solution: Solution) -> np.ndarray:
    """Return the generalized forces (steps, n) that supports and springs exert on every coordinate."""
    system, times = loading(solution)
    prescribed = np.zeros(solution.model.size, dtype=bool)
    prescribed[list(_supported(system))] = True
    springs = system.springs

    def forces(p: np.ndarray) -> np.ndarray:
        result = np.zeros(p.shape)
        for row, at in enumerate(times):
            result[row] = np.where(prescribed, residual(system, p[row], solution.v[row], solution.a[row], at), 0.0)
            np.subtract.at(result[row], springs.dof, springs.stiffness * (p[row, springs.dof] - springs.rest))
        return result

    return exactly(solution, forces)
