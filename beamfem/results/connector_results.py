"""Energies and momenta of the connectors of a model."""

from collections.abc import Sequence

import numpy as np

from beamfem.assembly.connectors import Connector, Connectors, Motion
from beamfem.assembly.rotating_frame import seen_from_rest
from beamfem.errors import InputError
from beamfem.model.contribution import Contribution
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.validation import shown


def kinetic_of_connectors(solution: Solution) -> np.ndarray:
    """Return their kinetic energy (steps,) [J]."""
    return _energies(solution)[:, 0]


def potential_of_connectors(solution: Solution) -> np.ndarray:
    """Return their potential (steps,) [J]."""
    return _energies(solution)[:, 1]


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
        forces.append([item.by_point(-item.force_in(motion, at, gravity)[: len(item.dofs)]) for item in items])
    return np.array(forces).reshape(len(solution), -1, 3)


def multipliers(solution: Solution, connector: Contribution) -> np.ndarray:
    """Return the additional unknowns of a connector (steps, k), such as multipliers. Raises InputError."""
    return solution.p[:, np.concatenate([item.multipliers for item in _bound(solution, connector)])]


def _bound(solution: Solution, connector: Contribution) -> list[Connector]:
    bound = [item for item in loading(solution)[0].connectors.items if item.given is connector]
    if bound:
        return bound
    raise InputError(f"{shown(connector)} is not a connector of this model; use one of model.connectors")


def _energies(solution: Solution) -> np.ndarray:
    system, times = loading(solution)
    return energies_of(system.connectors, solution, times)


def energies_of(connectors: Connectors, solution: Solution, times: np.ndarray) -> np.ndarray:
    """Return the kinetic and potential energy (steps, 2) [J] of some connectors, with the loads at given times."""
    if not connectors.items:
        return np.zeros((len(solution), 2))
    energies = [connectors.energies(state, at) for state, at in _states(solution, times)]
    return np.array(energies).reshape(-1, 2)


def _states(solution: Solution, times: np.ndarray) -> list[tuple[Motion, float]]:
    rows = zip(solution.p, solution.v, solution.a, strict=True)
    return list(zip(rows, np.asarray(times, dtype=float).tolist(), strict=True))
