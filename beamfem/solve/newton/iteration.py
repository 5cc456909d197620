"""Newton's iteration, the same for every problem: options, linearise, correct, check, and how it ended."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple, Protocol

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, residual
from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.kernels.newton_record import STALLED
from beamfem.precision.roundoff import MOST_DIGITS, load_size, row_floors
from beamfem.validation import convert, count, flag, positive, shown


class Termination(Enum):
    """Why an iteration ended; the values are the sentences that users read."""

    CONVERGED = "the correction and the residual are within the tolerance"
    ROUND_OFF = "the residual has reached the round-off floor of the model"
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


def require_newton(newton: Newton | None, default: Newton) -> Newton:
    """Return the given Newton, or the default for None. Raises InputError for anything else."""
    if newton is None:
        return default
    if not isinstance(newton, Newton):
        raise InputError(f"newton must be a Newton(tolerance=..., iterations=...), got {shown(newton)}")
    return newton


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

    def is_small(self, newton: Newton) -> bool:
        return self.size <= newton.tolerance or self.stagnates


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
    zeros = np.zeros(len(p))
    unbalanced = residual(system, p, zeros, zeros, load_factor)
    return balance_with(system, p, load_factor, unbalanced, system.assembler().smallest_jacobian(p))


def balance_with(system: System, p: np.ndarray, load_factor: float, unbalanced: np.ndarray, jacobian: float) -> Balance:
    """Return the balance of a state whose residual (n,) and smallest r0' x d are known."""
    # without reactions the largest load counts
    load = load_size(system, system.loads_at(load_factor))
    forces = np.abs(unbalanced) * system.scale
    free = np.abs(system.along_free(unbalanced)) * system.scale[system.free_dofs]
    multipliers = system.connectors.multipliers
    if len(multipliers):
        forces[multipliers] = free[system.unknowns.free[multipliers]] = 0.0
    largest, force = float(np.max(free, initial=0.0)), float(np.max(forces, initial=0.0))
    gap = _largest_gap(system, p, load_factor, unbalanced) if len(multipliers) else 0.0
    return Balance(p, unbalanced, largest, max(force, load), jacobian <= 0.0, gap)


def _largest_gap(system: System, p: np.ndarray, load_factor: float, unbalanced: np.ndarray) -> float:
    """Return the largest gap of a condition, see `Balance`; its gradient makes it a movement, whatever its unit is."""
    zeros, connectors = np.zeros(len(p)), system.connectors
    largest = 0.0
    tangents = connectors.tangents((p, zeros, zeros), load_factor, STATICS)
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
    if correction.stagnates:
        return True
    size, before = correction.size, correction.before
    following = size * min(size / before, 1.0) if correction.number > 1 else size
    moved = float((np.abs(p - system.reference) / system.scale).max(initial=0.0))
    if following <= _SURE * moved:
        return True
    return following <= _EPS * float((np.abs(p) / system.scale).max(initial=1.0))


class Problem(Protocol):
    """Equations in a state: an equilibrium, a point of a path, the end of a time step."""

    def correct(self) -> Correction:
        """Linearise and take the next correction, or several until one is small. Raises LinAlgError."""

    def check(self, correction: Correction) -> Termination | None:
        """Return why the iteration ends after a correction, None if it goes on."""


class SingleCorrections(ABC):
    """Base class of problems that take one correction at a time: it counts them and remembers the first two."""

    def __init__(self) -> None:
        self.taken, self._size = 0, np.inf
        self._first, self._second = np.nan, 0

    @abstractmethod
    def take(self) -> tuple[float, int]:
        """Take the next correction; return its size and the negative pivots of its tangent. Raises LinAlgError."""

    def correct(self) -> Correction:
        """Take the next correction. Raises LinAlgError."""
        before = self._size
        self._size, negative = self.take()
        self.taken += 1
        if self.taken == 1:
            self._first = self._size
        elif self.taken == 2:
            self._second = negative
        return Correction(self.taken, self._size, before, negative)

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        return self._first, self._second


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
