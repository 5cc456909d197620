"""The equations that the rows of a solution satisfy, and the load factors or times of their loads."""

import numpy as np

from beamfem.assembly.system import System, system_of
from beamfem.results.solution import Solution


def loading(solution: Solution) -> tuple[System, np.ndarray]:
    """Return the system of a solution and the load factor or time [s] (steps,) of its loads in each row."""
    if solution.loaded is not None:
        return system_of(solution.model, static=True), solution.loaded
    return system_of(solution.model, solution.static), solution.at


def imposing(solution: Solution) -> np.ndarray:
    """Return the factors (steps, k) of the loads that impose strains."""
    system, at = loading(solution)
    return np.array([system.imposing(time) for time in at.tolist()]).reshape(len(at), -1)
