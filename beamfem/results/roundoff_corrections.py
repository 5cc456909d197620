"""Corrections smaller than the last digit of the coordinates of a static solution, and their effect on its forces.

In a stiff part of a model the last digit of a position may amount to a force larger than the applied loads. The state
is still the equilibrium; the correction is found from the residual (`equations.round_off.remainder`) and stored apart.
"""

from collections.abc import Callable

import numpy as np

from beamfem.equations.differences import changed, widths
from beamfem.equations.system import system_of
from beamfem.precision.roundoff import digits_of, remainder
from beamfem.results.solution import Solution

_ENOUGH = 7.0  # digits of the forces at which a state needs no correction


def remainders(solution: Solution) -> np.ndarray:
    """Return the corrections of the coordinates of each row (steps, n); zero if they are exact enough."""
    result = np.zeros(solution.p.shape)
    if not solution.static:
        return result
    system = system_of(solution.model, True)
    for row, at in enumerate(solution.at):
        if digits_of(system, solution.p[row], float(at)) < _ENOUGH:
            result[row] = remainder(system, solution.p[row], float(at)).step
    return result


def _corrected(solution: Solution) -> np.ndarray:
    """Return whether each row has remainders (steps,)."""
    return np.asarray(solution.remainders.any(axis=1))


def _widths(solution: Solution) -> np.ndarray:
    """Return the widths of the differences (steps,), those of the whole model: values of a beam do not depend on which
    others are evaluated with it.
    """
    return widths(system_of(solution.model, solution.static), solution.remainders)


def exactly(
    solution: Solution,
    values: Callable[[np.ndarray], np.ndarray],
    rows: slice | np.ndarray = slice(None),
    some: slice | np.ndarray = slice(None),
) -> np.ndarray:
    """Return a function (steps, ...) of some coordinates (steps, k) of rows; remainders are included to first order."""
    p = solution.p[rows][:, some]
    result = values(p)
    if not solution.computed(_corrected)[rows].any():
        return result
    return result + changed(values, p, solution.remainders[rows][:, some], solution.computed(_widths)[rows])
