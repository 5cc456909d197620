"""Newton's method: the iteration, the same for every problem, and an equilibrium at a load factor as one of them."""

import math
from abc import ABC, abstractmethod
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple, Protocol

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.equations.band_workspace import band_workspace
from beamfem.equations.equations import (
    STATICS,
    inactive_after,
    inactive_conditions,
    linearise,
    linearise_after,
    predicted_stresses,
    released,
    residual_at_rest,
    residual_change,
    without,
)
from beamfem.equations.system import Proven, System
from beamfem.errors import InputError
from beamfem.kernels import newton_loop
from beamfem.kernels.newton_loop import STALLED
from beamfem.linalg.tangent import SMALLEST_PIVOT, Factorised, Stresses, Tangent
from beamfem.precision.roundoff import ENOUGH, MOST_DIGITS, digits_of, load_size, loses_digits, remainder, row_floors
from beamfem.validation import convert, count, flag, positive, shown


class Termination(Enum):
    """Why an iteration ended; the values are the sentences that users read."""

    CONVERGED = "the correction and the residual are within the tolerance"
    ROUND_OFF = "the residual is as small as round-off allows"
    DIVERGED = "the corrections grew beyond the size of the model"
    EXHAUSTED = "the iterations ran out before the corrections became small"
    SINGULAR = "the tangent is singular"
    NO_DIGITS = "round-off leaves no digit of the forces: stiffnesses and loads of this model are too far apart"
    LOST = "the count of negative pivots changed on the way, so the equilibrium may be one of another path"
    LIMIT = "as they grow from zero, they reach a limit point, beyond which there is no equilibrium nearby"
    INVERTED = "the beam was turned inside out: r_x and r_y no longer form a right-handed pair"

    @property
    def good(self) -> bool:
        return self is Termination.CONVERGED or self is Termination.ROUND_OFF


class NewtonResult(NamedTuple):
    """The last state (n,) of an iteration, the number of iterations and why it ended.

    negative_pivots: of the last tangent; for a symmetric one, the number of unstable directions; digits: least number
    of reliable digits of the forces; first: size of the first correction [-]; linear: if the count of the second
    tangent differed from the one asked for, the negative pivots of the tangent at the start with the stresses of a
    linear step, -1 if it is singular.
    """

    state: np.ndarray
    iterations: int
    ended: Termination
    negative_pivots: int = 0
    digits: float = np.nan
    first: float = np.nan
    linear: int | None = None


@dataclass(frozen=True)
class Newton:
    """Tolerances and options of the Newton iteration.

    Raises InputError for an invalid value. Source: Magisano, Leonetti and Garcea 2017 (independent stresses).

    Parameters
    ----------
    tolerance : float, [-], default 1e-10
        Largest correction relative to the model's length or one radian.
    residual_tolerance : float, [-], default 1e-9
        Largest residual relative to the reactions and loads.
    iterations : int, default 15
        Largest number of iterations.
    independent_stresses : bool, default True
        Whether the geometric tangent takes the section forces that the last correction predicted.

    Examples
    --------
    >>> solution = bf.solve_static(model, newton=bf.Newton(tolerance=1e-8, iterations=30))
    >>> solution.status.name
    'COMPLETED'
    """

    tolerance: float = 1e-10
    residual_tolerance: float = 1e-9
    iterations: int = 15
    independent_stresses: bool = True

    def __post_init__(self) -> None:
        convert(self, positive, "tolerance", "residual_tolerance")
        convert(self, count, "iterations")
        convert(self, flag, "independent_stresses")
        if max(self.tolerance, self.residual_tolerance) >= 1.0:
            raise InputError(
                "tolerance and residual_tolerance of Newton are fractions of the model and of its loads, below 1, got "
                f"{self.tolerance:g} and {self.residual_tolerance:g}"
            )


def largest_change(system: System, change: np.ndarray) -> float:
    """Return the largest scaled component of a change (n,) of the coordinates: lengths of the model, radians."""
    return float(np.max(np.abs(change) / system.scale, initial=0.0))


def require_newton(newton: Newton | None, default: Newton) -> Newton:
    """Return the given Newton, or the default for None. Raises InputError for anything else."""
    if newton is None:
        return default
    if not isinstance(newton, Newton):
        raise InputError(f"newton must be a Newton(tolerance=..., iterations=...), got {shown(newton)}")
    return newton


_MOST_SETS = 50  # of active conditions that are tried at a tangent
STAGNANT = 1e-6  # corrections below this that no longer decrease are round-off, if the residual agrees
_SURE = 1e-9  # of the movement: smaller corrections do not change the results
_EPS = float(np.finfo(float).eps)
LARGEST = 1e3  # of the model; larger corrections mean divergence


class Correction(NamedTuple):
    """A correction: its number, its size and that of the previous one, and the negative pivots of its tangent.

    Sizes are relative to the model for positions, and absolute otherwise.
    """

    number: int
    size: float
    before: float
    negative_pivots: int

    @property
    def diverges(self) -> bool:
        return not self.size <= LARGEST

    @property
    def stagnates(self) -> bool:
        return self.number > 2 and self.size > STALLED * self.before and self.size < STAGNANT


class Balance(NamedTuple):
    """Balance of forces in a state p (n,): residual (n,), its largest unconstrained component, and the largest force.

    Forces are multiplied by the scale of their coordinate, so that they can be compared with moments [N m]. inverted:
    whether an element is inverted somewhere, which polynomial elastic forces do not prevent; gap: the largest movement,
    relative to the scale of the coordinates, that a condition of a connector is away from being met.
    """

    p: np.ndarray
    residual: np.ndarray
    largest: float
    force: float
    inverted: bool
    gap: float = 0.0

    @property
    def digits(self) -> float:
        """Number of digits of the largest force above the round-off of every row."""
        return min(math.log10(self.force / self.largest), MOST_DIGITS) if self.largest > 0.0 else MOST_DIGITS


def balance_of(system: System, p: np.ndarray, load_factor: float) -> Balance:
    """Return the balance of a state (n,) at a load factor."""
    unbalanced = residual_at_rest(system, p, load_factor)
    forces = np.abs(unbalanced) * system.scale
    free = np.abs(system.along_free(unbalanced)) * system.scale[system.free_dofs]
    multipliers = system.connectors.multipliers
    if len(multipliers):
        forces[system.connectors.every_multiplier] = free[system.unknowns.free[multipliers]] = 0.0
    largest, force = float(np.max(free, initial=0.0)), float(np.max(forces, initial=0.0))
    gap = _largest_gap(system, p, load_factor, unbalanced) if len(multipliers) else 0.0
    force = max(force, load_size(system, load_factor))  # without reactions the largest load counts
    return Balance(p, unbalanced, largest, force, system.assembler().smallest_jacobian(p) <= 0.0, gap)


def _largest_gap(system: System, p: np.ndarray, load_factor: float, unbalanced: np.ndarray) -> float:
    """Return the largest gap of a condition, see `Balance`; its gradient makes it a movement, whatever its unit is."""
    zeros, connectors = np.zeros(len(p)), system.connectors
    tangents, largest = connectors.tangents((p, zeros, zeros), load_factor, STATICS), 0.0
    for item, tangent in zip(connectors.items, tangents, strict=True):
        first = len(item.dofs)
        gradients = np.abs(tangent[first : first + len(item.multipliers), :first])
        gaps = np.abs(unbalanced[item.multipliers]) / (gradients @ system.scale[item.dofs])
        largest = max(largest, float(np.max(gaps, initial=0.0)))
    return largest


def check_convergence(system: System, balance: Balance, newton: Newton, correction: Correction) -> Termination | None:
    """Return how an iteration ended whose corrections are small or no longer decrease; None if it is to continue.

    If the residual is above the tolerance, each row must have reached its round-off floor, and the next correction must
    be below the round-off of the movement.
    """
    met = balance.gap <= newton.tolerance and balance.largest <= newton.residual_tolerance * balance.force
    if correction.size <= newton.tolerance and met:
        ended = Termination.CONVERGED
    elif _settled(system, balance.p, correction) and bool(
        (np.abs(system.along_free(balance.residual)) <= row_floors(system, balance.p)[system.unknowns.chosen]).all()
    ):
        ended = Termination.ROUND_OFF
    else:
        return None
    return Termination.INVERTED if balance.inverted else ended


def _settled(system: System, p: np.ndarray, correction: Correction) -> bool:
    """Return whether the next correction, at the present rate, is small relative to the movement or below round-off."""
    size, before = correction.size, correction.before
    following = size * min(size / before, 1.0) if correction.number > 1 and before > 0.0 else size
    moved = largest_change(system, p - system.reference)
    lasting = max(_SURE * moved, _EPS * float((np.abs(p) / system.scale).max(initial=1.0)))
    return correction.stagnates or following <= lasting


class Problem(Protocol):
    """Equations in a state: an equilibrium, a point of a path, the end of a time step."""

    def correct(self) -> Correction:
        """Linearise and take the next correction, or several until one is small. Raises LinAlgError."""

    def check(self, correction: Correction) -> Termination | None:
        """Return why the iteration ends after a correction, None if it goes on."""


class SingleCorrections(ABC):
    """Base class of problems that take one correction at a time.

    first: size of the first correction; second: negative pivots of the second tangent.
    """

    taken, size, first, second = 0, np.inf, np.nan, 0

    @abstractmethod
    def take(self) -> tuple[float, int]:
        """Take the next correction; return its size and the negative pivots of its tangent. Raises LinAlgError."""

    def correct(self) -> Correction:
        before = self.size
        self.size, negative = self.take()
        self.taken += 1
        if self.taken == 1:
            self.first = self.size
        elif self.taken == 2:
            self.second = negative
        return Correction(self.taken, self.size, before, negative)


class Iterated(NamedTuple):
    """Why an iteration ended, after how many corrections, and the negative pivots of the last tangent."""

    ended: Termination
    iterations: int
    negative_pivots: int


def iterate(problem: Problem, most: int) -> Iterated:
    """Correct the state of a problem until it says why to end, or `most` times."""
    number = negative = 0
    while number < most:
        try:
            correction = problem.correct()
        except LinAlgError:
            return Iterated(Termination.SINGULAR, number + 1, negative)
        number, negative = correction.number, correction.negative_pivots
        ended = problem.check(correction)
        if ended is not None:
            return Iterated(ended, number, negative)
    return Iterated(Termination.EXHAUSTED, number, negative)


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
        return residual_change(self.system, self.start, self.step, self.load_factor)


class Equilibrium(ABC):
    """An equilibrium of a system that is sought from the state `start` (n,); state: the one reached.

    keep: see `solve_equilibrium`; digits: number of reliable digits of the forces, nan if they are not counted; first,
    second: see `SingleCorrections`.
    """

    system: System
    newton: Newton
    start: np.ndarray
    state: np.ndarray
    keep: int | None = None
    digits: float = np.nan
    first: float
    second: int

    @abstractmethod
    def correct(self) -> Correction:
        """See `Problem`."""

    @abstractmethod
    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""

    def count_after_linear(self) -> int:
        """Return the negative pivots of the tangent at the start with the stress resultants of a linear step.

        The shape after the step may be far off, so that the count there says nothing. -1 if the tangent is singular. It
        is called at most once, if there is a count to keep and the second tangent has another.
        """
        return self.second

    def check(self, correction: Correction) -> Termination | None:
        """See `Problem`."""
        lost = self.keep not in (None, correction.negative_pivots)
        if correction.number > 2 and lost:
            return Termination.LOST
        if correction.diverges:
            return Termination.DIVERGED
        if correction.size > self.newton.tolerance and not correction.stagnates:
            return None
        ended = check_convergence(self.system, self.balance(), self.newton, correction)
        return Termination.LOST if ended is not None and lost else ended

    def find(self) -> NewtonResult:
        """Iterate and return the result."""
        ended, number, negative = iterate(self, self.newton.iterations)
        state = self.state.copy()
        if ended is Termination.EXHAUSTED:
            return NewtonResult(state, number, ended)
        if not ended.good and ended is not Termination.INVERTED:
            return NewtonResult(self.start, number, ended, negative)
        linear = self.count_after_linear() if number > 1 and self.keep not in (None, self.second) else None
        state = state if ended.good else self.start
        return NewtonResult(state, number, ended, negative, self.digits, self.first, linear)


class BandProblem(Equilibrium):
    """The equilibrium at a load factor by the compiled iteration."""

    def __init__(
        self,
        system: System,
        start: np.ndarray,
        load_factor: float,
        newton: Newton,
        step: PrescribedStep,
        keep: int | None,
    ) -> None:
        self.system, self.start, self.newton, self.keep = system, start, newton, keep
        self.space = space = band_workspace(system)
        loads, self.state = system.loads.at(load_factor), space.p
        self.load = load_size(system, load_factor)
        space.assembler.take(loads, load_factor)
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
        self.first, self.second = found.first_correction, found.negative_pivots_after_first
        return Correction(found.iterations, found.correction, found.correction_before, found.negative_pivots)

    def balance(self) -> Balance:
        space, found = self.space, self.space.solver
        force = max(found.force, self.load)
        balance = Balance(space.p, space.residual, found.unbalanced, force, found.jacobian <= 0.0, found.gap)
        self.digits = balance.digits
        return balance

    def count_after_linear(self) -> int:
        space = self.space
        space.solver.step[:] = space.solver.linear - self.start
        space.p[:] = self.start
        return int(space.call(newton_loop.count_after_step.compiled))


class _Solved(NamedTuple):
    """A correction (n,), the stresses after it, if they are separate unknowns, and the factors of its tangent."""

    step: np.ndarray
    after: Stresses | None
    factors: Factorised


class PivotedProblem(SingleCorrections, Equilibrium):
    """The equilibrium at a load factor, one correction after another, with pivoting.

    stresses: resultants of each block for the geometric part of the first tangent, by default those of the state.
    """

    def __init__(
        self,
        system: System,
        start: np.ndarray,
        load_factor: float,
        newton: Newton,
        step: PrescribedStep,
        keep: int | None = None,
        stresses: Stresses | None = None,
    ) -> None:
        self.system, self.start, self.load_factor, self.newton, self.step = system, start, load_factor, newton, step
        self.state = self.linear = start
        self.keep, self.stresses = keep, stresses

    def take(self) -> tuple[float, int]:
        system, p, zeros = self.system, self.state, np.zeros(len(self.state))
        unbalanced, tangent = linearise(
            system, p, zeros, zeros, self.load_factor, STATICS, self.stresses, all_active=True
        )
        solved = self._with_active_set if len(system.connectors.one_sided) else self._solved
        step, after, factors = solved(unbalanced, tangent)
        if self.newton.independent_stresses:
            self.stresses = after or predicted_stresses(system, p, step, self.load_factor)
        self.state = p + step
        if self.taken == 0:
            self.linear = self.state
        return largest_change(system, step), factors.negative_pivots

    def _with_active_set(self, unbalanced: np.ndarray, tangent: Tangent) -> _Solved:
        """Return what `_solved` does with the set of one-sided conditions that the solution itself shows.

        The search begins with the set of the state or, if that leaves a part free to move, with all conditions.
        unbalanced, tangent: with all conditions active. Raises LinAlgError if no set holds the model.
        """
        system, p = self.system, self.state
        gradients, shown = system.connectors.gradients(p, self.load_factor), inactive_conditions(system, p, unbalanced)
        for inactive in (shown, shown[:0]):
            with suppress(LinAlgError):
                for _ in range(_MOST_SETS):
                    left = released(system, p, unbalanced, gradients, inactive)
                    solved = self._solved(left, without(system, tangent, inactive))
                    held = largest_change(system, solved.step) <= LARGEST
                    before, inactive = inactive, inactive_after(system, p, solved.step, unbalanced, gradients, inactive)
                    if not held or np.array_equal(before, inactive):
                        break
                if held:
                    return solved
        raise LinAlgError("no set of one-sided conditions holds the model")

    def _solved(self, unbalanced: np.ndarray, tangent: Tangent) -> _Solved:
        """Return the correction for a residual (n,). Raises LinAlgError."""
        free, factors = self.system.free_dofs, tangent.factorised(self.system.rotated)
        step = self.step.step.copy() if self.taken == 0 else np.zeros(len(unbalanced))
        step[free], after = factors.correction(unbalanced[free])
        if self.taken == 0 and self.step.moves:
            step[free] -= factors.solve(self.step.force[free])
            after = None
        return _Solved(step, after, factors)

    def balance(self) -> Balance:
        return balance_of(self.system, self.state, self.load_factor)

    def count_after_linear(self) -> int:
        system, step = self.system, self.linear - self.start
        try:
            tangent = linearise_after(system, self.start, step, self.load_factor)
            return tangent.factorised(system.rotated).negative_pivots
        except LinAlgError:
            return -1


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
    again = Proven.LOSES_DIGITS in system.proven and not mixed
    return solve_equilibrium(system, start, load_factor, newton, keep) if again else result


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
    result = solve_banded(system, start, load_factor, newton, step, keep)
    if result is None or result.ended is Termination.SINGULAR:
        result = PivotedProblem(system, start, load_factor, newton, step, keep).find()
    return result


def solve_banded(
    system: System,
    start: np.ndarray,
    load_factor: float,
    newton: Newton,
    step: PrescribedStep,
    keep: int | None = None,
) -> NewtonResult | None:
    """Return the result of the compiled iteration without pivoting; None for a model that it is not for."""
    banded = system.unknowns.pattern is None and system.model.frame is None and not len(system.connectors.one_sided)
    if not banded or Proven.LOSES_DIGITS in system.proven:
        return None
    problem = BandProblem(system, start, load_factor, newton, step, keep)
    result = problem.find()
    problem.space.return_scratch(system)
    return result
