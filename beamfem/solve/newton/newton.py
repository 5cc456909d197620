"""Newton's method for an equilibrium at a fixed load factor."""

import math

import numpy as np

from beamfem.assembly.system import Proven, System
from beamfem.precision.roundoff import ENOUGH, digits_of, loses_digits, remainder
from beamfem.solve.newton.banded import BandProblem
from beamfem.solve.newton.equilibrium import find_equilibrium
from beamfem.solve.newton.iteration import Newton, NewtonResult, Termination
from beamfem.solve.newton.pivoted import PivotedProblem
from beamfem.solve.newton.prescribed_step import PrescribedStep


def solve_equilibrium(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, keep: int | None = None
) -> NewtonResult:
    """Return the equilibrium at `load_factor` that is found from the state `start` (n,).

    keep: the count of negative pivots to keep; the iteration stops if the tangent has another one from the third
    iteration on. The second tangent uses the stresses of a linear step, and the result only reports its count.
    """
    mixed = Proven.LOSES_DIGITS in system.proven
    result = _with_digits(system, load_factor, newton, _solve(system, start, load_factor, newton, keep))
    if not result.ended.good:
        loses_digits(system, start, load_factor)
    if Proven.LOSES_DIGITS in system.proven and not mixed:
        return _with_digits(system, load_factor, newton, _solve(system, start, load_factor, newton, keep))
    return result


def _with_digits(system: System, load_factor: float, newton: Newton, result: NewtonResult) -> NewtonResult:
    """Return a result with the number of reliable digits of its forces and, if these are few, a corrected state."""
    if result.ended is Termination.CONVERGED and math.isnan(result.digits):
        return result._replace(digits=-float(np.log10(newton.residual_tolerance)))
    if result.ended is Termination.ROUND_OFF:
        digits = digits_of(system, result.state, load_factor) if math.isnan(result.digits) else result.digits
        if digits >= ENOUGH:
            return result._replace(digits=digits)
        missing = remainder(system, result.state, load_factor)
        ended = Termination.ROUND_OFF if missing.digits >= 1.0 else Termination.NO_DIGITS
        return result._replace(state=result.state + missing.step, ended=ended, digits=missing.digits)
    return result


def _solve(system: System, start: np.ndarray, load_factor: float, newton: Newton, keep: int | None) -> NewtonResult:
    """Iterate with the fastest method that the model allows, and with pivoting if that fails."""
    step = PrescribedStep(system, start, load_factor)
    result = None
    if system.unknowns.pattern is None and Proven.LOSES_DIGITS not in system.proven:
        problem = BandProblem(system, start, load_factor, newton, step, keep)
        result = find_equilibrium(problem, newton, keep)
        problem.give_back()
    if result is None or result.ended is Termination.SINGULAR:
        result = find_equilibrium(PivotedProblem(system, start, load_factor, newton, step), newton, keep)
    return result
