"""What the coordinates of a static solution lack below their last digit, and what that adds to its forces.

A stiff part of a model turns the last digit of a position into a force that may be larger than what acts. The state
still is the equilibrium; what it lacks is found from the balance (`assembly.round_off.remainder`) and kept apart.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from beamfem.assembly.differences import differentiated
from beamfem.assembly.round_off import digits_of, remainder
from beamfem.assembly.system import system_of

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_ENOUGH = 7.0  # digits of the forces that a state has by itself


def remainders(solution: "Solution") -> np.ndarray:
    """Return what is to be added to the coordinates of each row (steps, n); zero if they are exact enough."""
    result = np.zeros(solution.p.shape)
    if not solution.static:
        return result
    system = system_of(solution.model, True)
    for row, at in enumerate(solution.at):
        if digits_of(system, solution.p[row], float(at)) < _ENOUGH:
            result[row] = remainder(system, solution.p[row], float(at)).step
    return result


def exactly(
    solution: "Solution", values: Callable[[np.ndarray], np.ndarray], rows: slice | np.ndarray = slice(None)
) -> np.ndarray:
    """Return a function (steps, ...) of the coordinates (steps, n) of rows, digits below their last one included."""
    p, steps = solution.p[rows], solution.remainders[rows]
    found = values(p)
    if not steps.any():
        return found
    system = system_of(solution.model, solution.static)
    return found + differentiated(system, values, p, steps)
