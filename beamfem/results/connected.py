"""Energies and momenta of the connectors of a model."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.assembly.connector import Motion
from beamfem.results.loading import loading

if TYPE_CHECKING:
    from beamfem.results.solution import Solution


def kinetic_of_connectors(solution: "Solution") -> np.ndarray:
    """Return their kinetic energy (steps,) [J]."""
    return _energies(solution)[:, 0]


def potential_of_connectors(solution: "Solution") -> np.ndarray:
    """Return their potential (steps,) [J]."""
    return _energies(solution)[:, 1]


def momenta_of_connectors(solution: "Solution") -> np.ndarray:
    """Return their linear momentum [kg m/s] and moment of momentum about the origin [kg m^2/s] (steps, 3)."""
    system, times = loading(solution)
    found = [system.connectors.momenta(state, at) for state, at in _states(solution, times)]
    return np.array(found).reshape(-1, 3)


def _energies(solution: "Solution") -> np.ndarray:
    system, times = loading(solution)
    found = [system.connectors.energies(state, at) for state, at in _states(solution, times)]
    return np.array(found).reshape(-1, 2)


def _states(solution: "Solution", times: np.ndarray) -> list[tuple[Motion, float]]:
    rows = zip(solution.p, solution.v, solution.a, strict=True)
    return list(zip(rows, np.asarray(times, dtype=float).tolist(), strict=True))
