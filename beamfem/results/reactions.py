"""Forces and moments that supports and connectors exert on beams; energies and momenta of connectors."""

from collections.abc import Sequence

import numpy as np

from beamfem.equations.connectors import Connector, Connectors, Motion
from beamfem.equations.equations import residual
from beamfem.equations.frame_inertia import seen_from_rest
from beamfem.equations.model_coordinates import COORDINATES, coordinate_of
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.contribution import Contribution
from beamfem.model.supports import PointSupport
from beamfem.results.roundoff_corrections import exactly
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.validation import shown


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
    others = float(system.springs.data[system.springs.numbers[:, 0] == dof, 0].sum()) - stiffness
    return np.asarray(solution.support_forces[:, dof] + others * moved)


def support_forces(solution: Solution) -> np.ndarray:
    """Return the generalized forces (steps, n) that supports and springs exert on every coordinate."""
    system, times = loading(solution)
    prescribed = np.zeros(solution.model.size, dtype=bool)
    prescribed[[*system.prescribed_dofs, *(dof + axis for dof, _ in system.inclined for axis in (0, 1))]] = True

    def forces(p: np.ndarray) -> np.ndarray:
        result = np.zeros(p.shape)
        for row, at in enumerate(times):
            result[row] = np.where(prescribed, residual(system, p[row], solution.v[row], solution.a[row], at), 0.0)
            np.subtract.at(result[row], system.springs.numbers, system.springs.forces(p[row]))
        return result

    return exactly(solution, forces)


def energies_of_connectors(solution: Solution) -> np.ndarray:
    """Return the kinetic and the potential energy (steps, 2) [J] of all connectors."""
    system, times = loading(solution)
    return energies_of(system.connectors, solution, times)


def momenta_of_connectors(solution: Solution) -> np.ndarray:
    """Return their linear momentum [kg m/s] and moment of momentum about the origin [kg m^2/s] (steps, 3)."""
    system, times = loading(solution)
    momenta = [system.connectors.momenta(state, at) for state, at in _states(solution, times)]
    return np.array(momenta).reshape(-1, 3)


def connector_force(solution: Solution, connector: Contribution) -> np.ndarray:
    """Return the forces of a connector on its points (steps, m, 3): fx, fy [N], moment [N m]. Raises InputError.

    Of a part along a beam, the points are the nodes of the beam.
    """
    return forces_at(solution, _bound(solution, connector))


def forces_at(solution: Solution, items: Sequence[Connector]) -> np.ndarray:
    """Return the forces of connectors on their points (steps, m, 3): fx, fy [N], moment [N m]."""
    system, times = loading(solution)
    forces = []
    v, a = seen_from_rest(system, solution.p, solution.v, solution.a, times)
    for *state, at in zip(solution.p, v, a, times.tolist(), strict=True):
        motion, gravity = (state[0], state[1], state[2]), system.connectors.gravity(at)
        acting = ((item, -item.force_in(motion, at, gravity)[: len(item.dofs)]) for item in items)
        forces.append([item.on_points(force, item.by_point(state[0][item.dofs])) for item, force in acting])
    return np.array(forces).reshape(len(solution), -1, 3)


def multipliers(solution: Solution, connector: Contribution) -> np.ndarray:
    """Return the additional unknowns of a connector (steps, k), such as multipliers. Raises InputError."""
    return solution.p[:, np.concatenate([item.multipliers for item in _bound(solution, connector)])]


def _bound(solution: Solution, connector: Contribution) -> list[Connector]:
    bound = [item for item in loading(solution)[0].connectors.items if item.given is connector]
    if bound:
        return bound
    raise InputError(f"{shown(connector)} is not a connector of this model; use one of model.connectors")


def energies_of(connectors: Connectors, solution: Solution, times: np.ndarray) -> np.ndarray:
    """Return the kinetic and potential energy (steps, 2) [J] of some connectors, with the loads at given times."""
    if not connectors.items:
        return np.zeros((len(solution), 2))
    energies = [connectors.energies(state, at) for state, at in _states(solution, times)]
    return np.array(energies).reshape(-1, 2)


def _states(solution: Solution, times: np.ndarray) -> list[tuple[Motion, float]]:
    rows = zip(solution.p, solution.v, solution.a, strict=True)
    return list(zip(rows, np.asarray(times, dtype=float).tolist(), strict=True))
