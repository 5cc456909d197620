"""Newton's iteration, the same for every problem: linearise, correct, check."""

from typing import Protocol

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.system import System
from beamfem.solve.newton.convergence import Balance, Correction, check_convergence
from beamfem.solve.newton.iteration import Newton, NewtonResult, Termination


class Problem(Protocol):
    """Equations in a state, and the solution of their linearisation there."""

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


def iterate(problem: Problem, newton: Newton, keep: int | None = None) -> NewtonResult:
    """Iterate and return the result.

    keep: the count of negative pivots to keep; the iteration stops if the tangent has another one from the third
    iteration on. The second tangent uses the stresses of a linear step, and the result only reports its count.
    """
    number = 0
    while number < newton.iterations:
        try:
            correction = problem.correct()
        except LinAlgError:
            return NewtonResult(problem.start, number + 1, Termination.SINGULAR)
        number, negative = correction.number, correction.negative_pivots
        lost = keep not in (None, negative)
        if number > 2 and lost:
            return NewtonResult(problem.start, number, Termination.LOST, negative)
        if correction.diverges:
            return NewtonResult(problem.start, number, Termination.DIVERGED, negative)
        if correction.is_small(newton):
            balance = problem.balance()
            ended = check_convergence(problem.system, balance, newton, correction)
            if ended is not None and lost:
                return NewtonResult(problem.start, number, Termination.LOST, negative)
            if ended is not None:
                first, second = problem.after_first()
                state = problem.state if ended.good else problem.start
                linear = problem.count_after_linear() if number > 1 and keep not in (None, second) else None
                digits = balance.digits if problem.counts_digits else np.nan
                return NewtonResult(state, number, ended, negative, digits, first, linear)
    return NewtonResult(problem.state, number, Termination.EXHAUSTED)
