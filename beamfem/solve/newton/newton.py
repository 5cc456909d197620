"""Newton's method for an equilibrium, at a fixed load factor or at a point of a path."""

import math
from typing import Protocol

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.band_workspace import band_workspace
from beamfem.assembly.differences import differentiated
from beamfem.assembly.equations import STATICS, linearise, linearise_after, predicted_stresses, residual
from beamfem.assembly.system import Proven, System
from beamfem.cached_properties import cached_property
from beamfem.kernels import newton_loop
from beamfem.linalg.tangent import SMALLEST_PIVOT, Factorised, Stresses
from beamfem.precision.roundoff import ENOUGH, digits_of, load_size, loses_digits, remainder
from beamfem.solve.newton.iteration import (
    LARGEST,
    STAGNANT,
    Balance,
    Correction,
    Newton,
    NewtonResult,
    SingleCorrections,
    Termination,
    balance_of,
    check_convergence,
    iterate,
)


class PrescribedStep:
    """The step (n,) from a state (n,) that brings the prescribed coordinates to their values at a load factor."""

    def __init__(self, system: System, start: np.ndarray, load_factor: float) -> None:
        self.system, self.start, self.load_factor = system, start, load_factor
        self.step = np.zeros(len(start))
        dofs = system.prescribed_dofs
        change = system.prescribed_values(load_factor) - start[dofs]
        self.moves = np.count_nonzero(change) > 0
        if self.moves:
            self.step[dofs] = change

    @cached_property
    def force(self) -> np.ndarray:
        """Change of the residual (n,) with the step."""
        if not self.moves:
            return np.zeros(len(self.start))
        zeros = np.zeros(len(self.start))
        return differentiated(
            self.system, lambda p: residual(self.system, p, zeros, zeros, self.load_factor), self.start, self.step
        )


def count_after(system: System, start: np.ndarray, step: np.ndarray, load_factor: float) -> int:
    """Return the negative pivots of the tangent in `start` (n,) with the stress resultants of a linear step (n,).

    The shape after the step may be far off, so that the count of its tangent says nothing. -1 if it is singular.
    """
    try:
        return linearise_after(system, start, step, load_factor).factorised(system.rotated).negative_pivots
    except LinAlgError:
        return -1


class BandProblem:
    """The equilibrium at a load factor, from the state `start` (n,); keep: see `find_equilibrium`."""

    counts_digits = True

    def __init__(
        self,
        system: System,
        start: np.ndarray,
        load_factor: float,
        newton: Newton,
        step: PrescribedStep,
        keep: int | None,
    ) -> None:
        self.system, self.start, self.space = system, start, band_workspace(system)
        loads, space = system.loads_at(load_factor), self.space
        self.load = load_size(system, loads)
        space.begin(loads, load_factor)
        own = space.solver
        space.p[:], own.step[:], own.prescribed_step[:], own.prescribed_force[:] = start, 0.0, step.step, step.force
        own.tolerance, own.stagnant, own.divergent = newton.tolerance, STAGNANT, LARGEST
        own.pivot_ratio, own.most_iterations = SMALLEST_PIVOT, newton.iterations
        own.predicted_resultants = newton.independent_stresses
        own.required_negative_pivots = -1 if keep is None else keep
        own.iterations, own.correction, own.correction_before = 0, np.inf, np.inf

    def correct(self) -> Correction:
        """Take corrections until one is small or stagnant. Raises LinAlgError if pivoting is needed."""
        space, found = self.space, self.space.solver
        factorised = space.call(newton_loop.iterate.compiled)
        if not factorised:
            raise LinAlgError("a pivot is tiny")
        found.prescribed_step[:] = found.prescribed_force[:] = 0.0
        return Correction(found.iterations, found.correction, found.correction_before, found.negative_pivots)

    @property
    def state(self) -> np.ndarray:
        return self.space.p.copy()

    def balance(self) -> Balance:
        space, found = self.space, self.space.solver
        force = max(found.force, self.load)
        return Balance(space.p, space.residual, found.unbalanced, force, found.jacobian <= 0.0)

    def after_first(self) -> tuple[float, int]:
        found = self.space.solver
        return found.first_correction, found.negative_pivots_after_first

    def count_after_linear(self) -> int:
        """Return the negative pivots at the start with the stresses of a linear step; overwrites the state reached."""
        space = self.space
        space.solver.step[:] = space.solver.linear - self.start
        space.p[:] = self.start
        return int(space.call(newton_loop.count_after_step.compiled))

    def return_scratch(self) -> None:
        """Release the workspace for the next solve."""
        self.space.return_scratch(self.system)


class PivotedProblem(SingleCorrections):
    """The equilibrium at a load factor, from the state `start` (n,)."""

    counts_digits = False

    def __init__(
        self, system: System, start: np.ndarray, load_factor: float, newton: Newton, step: PrescribedStep
    ) -> None:
        super().__init__()
        self.system, self.start, self.load_factor, self.newton, self.step = system, start, load_factor, newton, step
        self.state = self.linear = start
        self.stresses: Stresses | None = None

    def take(self) -> tuple[float, int]:
        system, p, zeros, free = self.system, self.state, np.zeros(len(self.state)), self.system.free_dofs
        unbalanced, tangent = linearise(system, p, zeros, zeros, self.load_factor, STATICS, self.stresses)
        factors: Factorised = tangent.factorised(system.rotated)
        step = self.step.step.copy() if self.taken == 0 else np.zeros(len(p))
        step[free], after = factors.correction(unbalanced[free])
        if self.taken == 0 and self.step.moves:
            step[free] -= factors.solve(self.step.force[free])
            after = None
        if self.newton.independent_stresses:
            self.stresses = after or predicted_stresses(system, p, step, self.load_factor)
        self.state = p + step
        if self.taken == 0:
            self.linear = self.state
        return float(np.max(np.abs(step) / system.scale, initial=0.0)), factors.negative_pivots

    def balance(self) -> Balance:
        return balance_of(self.system, self.state, self.load_factor)

    def count_after_linear(self) -> int:
        return count_after(self.system, self.start, self.linear - self.start, self.load_factor)


class Equilibrium(Protocol):
    """An equilibrium that is sought: its equations in a state, and the solution of their linearisation there."""

    system: System
    start: np.ndarray
    counts_digits: bool  # whether the balance gives the number of reliable digits of the forces

    @property
    def state(self) -> np.ndarray:
        """The state reached."""

    def correct(self) -> Correction:
        """Take the next correction, or several until one is small. Raises LinAlgError."""

    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""

    def count_after_linear(self) -> int:
        """Return the negative pivots of the tangent at the start with the stress resultants of a linear step.

        -1 if it is singular. It is called at most once, if the second tangent has another count.
        """


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
    banded = system.unknowns.pattern is None and system.model.frame is None
    if banded and Proven.LOSES_DIGITS not in system.proven:
        problem = BandProblem(system, start, load_factor, newton, step, keep)
        result = find_equilibrium(problem, newton, keep)
        problem.return_scratch()
    if result is None or result.ended is Termination.SINGULAR:
        result = find_equilibrium(PivotedProblem(system, start, load_factor, newton, step), newton, keep)
    return result
