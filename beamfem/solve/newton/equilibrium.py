"""The iteration for an equilibrium: of a load step, or of a point of a path."""

from typing import Protocol

import numpy as np

from beamfem.assembly.system import System
from beamfem.solve.newton.convergence import Balance, Correction, check_convergence
from beamfem.solve.newton.iteration import Newton, NewtonResult, Termination
from beamfem.solve.newton.iteration_loop import iterate


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
