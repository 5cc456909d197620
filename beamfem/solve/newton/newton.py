"""Newton's method for an equilibrium, at a fixed load factor or at a point of a path."""

import math
from typing import Protocol

import numpy as np

from beamfem.assembly.system import Proven, System
from beamfem.precision.roundoff import ENOUGH, digits_of, loses_digits, remainder
from beamfem.solve.newton.corrections import BandProblem, PivotedProblem, PrescribedStep
from beamfem.solve.newton.iteration import (
    Balance,
    Correction,
    Newton,
    NewtonResult,
    Termination,
    check_convergence,
    iterate,
)


class Equilibrium(Protocol):
    """An equilibrium that is sought: its equations in a state, and the solution of their linearisation there."""

    system: System
    start: np.ndarray
    counts_digits: bool  # whether the balance gives the number of reliable digits of the forces

    @property
    def state(self) -> np.ndarray:
        """The state reached."""
        ...

    def correct(self) -> Correction:
        """Take the next correction, or several until one is small. Raises LinAlgError."""
        ...

    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""
        ...

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        ...

    def count_after_linear(self) -> int:
        """Return the negative pivots of the tangent at the start with the stress resultants of a linear step.

        -1 if it is singular. It is called at most once, if the second tangent has another count.
        """
        ...


class _Search:
    """The iteration for an equilibrium; keep: see `find_equilibrium`."""

    def __init__(self, equilibrium: Equilibrium, newton: Newton, keep: int | None) -> None:
        self.equilibrium, self.newton, self.keep = equilibrium, newton, keep
        self.correct = equilibrium.correct
        self.digits = np.nan

    def check(self, correction: Correction) -> Termination | None:
        """See `loop.Problem`."""
        lost = self.keep not in (None, correction.negative_pivots)
        if correction.number > 2 and lost:
            return Termination.LOST
        if correction.diverges:
            return Termination.DIVERGED
        if not correction.is_small(self.newton):
            return None
        balance = self.equilibrium.balance()
        ended = check_convergence(self.equilibrium.system, balance, self.newton, correction)
        if ended is not None and lost:
            return Termination.LOST
        self.digits = balance.digits if self.equilibrium.counts_digits else np.nan
        return ended


def find_equilibrium(equilibrium: Equilibrium, newton: Newton, keep: int | None = None) -> NewtonResult:
    """Iterate and return the result.

    keep: the count of negative pivots to keep; the iteration stops if the tangent has another one from the third
    iteration on. The second tangent uses the stresses of a linear step, and the result only reports its count.
    """
    problem = _Search(equilibrium, newton, keep)
    ended, number, negative = iterate(problem, newton.iterations)
    if ended is Termination.EXHAUSTED:
        return NewtonResult(equilibrium.state, number, ended)
    if not ended.good and ended is not Termination.INVERTED:
        return NewtonResult(equilibrium.start, number, ended, negative)
    first, second = equilibrium.after_first()
    state = equilibrium.state if ended.good else equilibrium.start
    linear = equilibrium.count_after_linear() if number > 1 and keep not in (None, second) else None
    return NewtonResult(state, number, ended, negative, problem.digits, first, linear)


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
        problem.return_scratch()
    if result is None or result.ended is Termination.SINGULAR:
        result = find_equilibrium(PivotedProblem(system, start, load_factor, newton, step), newton, keep)
    return result
