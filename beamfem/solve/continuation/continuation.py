"""Points of an equilibrium path, corrected and linearised with the load factor among the unknowns."""

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.equations.equations import (
    imposed_forces,
    linearise_at_rest,
    load_change,
    predicted_stresses,
    residual_at_rest,
)
from beamfem.equations.system import System
from beamfem.errors import ConvergenceError, InputError
from beamfem.linalg.tangent import Factorised, Stresses
from beamfem.precision.roundoff import loses_digits
from beamfem.solve.newton.newton import Balance, Equilibrium, Newton, SingleCorrections, Termination, balance_of
from beamfem.solve.start.functions_of_time import FunctionOfTime, functions_of_time

_SLOPE_WIDTH = 1e-4  # of the load scale: differences of loads keep digits, and prescribed motions are smooth over it
_LARGEST_RATIO = 30.0  # of the load scale to the soft load
_LOAD_STEP = 2.0
_WIDTHS = np.linspace(1.0, 0.1, 10).tolist()  # of the load factor, over which effects of loads are compared
_STEEPER = 2.0  # ratio of the effect of loads per load factor further on to that at the start of a path
_GROWS_WELL = 0.3  # fraction of the load factor in the unit tangent
_INVERSE_ITERATIONS = 30
_STILL = 1e-7  # of a mode: change per iteration below which it has converged


@dataclass(frozen=True, eq=False)
class PathPoint:
    """A converged point of a path: y (n + 1,) = coordinates and load factor, and the unit tangent of the path there."""

    y: np.ndarray
    tangent: np.ndarray
    factors: Factorised

    @property
    def load_factor(self) -> float:
        return float(self.y[-1])

    @cached_property
    def negative_pivots(self) -> int:
        return self.factors.negative_pivots


class Corrected(NamedTuple):
    """The last y (n + 1,) of an iteration, how many iterations it took and why it ended.

    negative_pivots: fewest and most of the tangents during the iteration, if they were counted.
    """

    y: np.ndarray
    iterations: int
    ended: Termination
    negative_pivots: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Continuation:
    """A system whose load factor is unknown, measured in lengths of the model and in `load_scale`.

    load_step: largest change of a small load factor in one step; piece: load factors between which functions that act
    have no kink, so that slopes are taken inside of it.

    The squared length of a change of y is the mean of the squared scaled changes of the unknown coordinates, plus that
    of the load factor; it depends neither on units nor on the mesh.
    """

    system: System
    newton: Newton
    load_scale: float
    load_step: float
    piece: tuple[float, float] = (-np.inf, np.inf)

    @cached_property
    def functions_of_time(self) -> list[FunctionOfTime]:
        """Functions of the load factor that act on the model."""
        return functions_of_time(self.system)

    @cached_property
    def scale(self) -> np.ndarray:
        """Units (n + 1,) in which changes of y are measured."""
        return np.append(self.system.scale, self.load_scale)

    @cached_property
    def weights(self) -> np.ndarray:
        """Weights (n + 1,) of the squared changes of y; prescribed coordinates follow the load factor and have none."""
        free = self.system.free_dofs
        result = np.zeros(len(self.scale))
        result[free] = 1.0 / (len(free) * self.scale[free] ** 2)
        result[-1] = 1.0 / self.load_scale**2
        return result

    def dot(self, a: np.ndarray, b: np.ndarray) -> float:
        # without BLAS, whose threads wait for each other on a busy computer: they took most of the time of long chains
        return float(np.einsum("i,i,i->", self.weights, a, b))

    def length(self, a: np.ndarray) -> float:
        return float(np.sqrt(self.dot(a, a)))

    def rescaled(self, point: PathPoint) -> tuple["Continuation", PathPoint]:
        """Return the continuation with a larger load scale, and the point, if the load has outgrown the movement.

        A structure that stiffens as it is loaded moves ever less with the load, so that changes of direction vanish
        beside changes of the load. The new scale gives both equal parts in the tangent, but is at most the load factor.
        """
        load = abs(float(point.tangent[-1])) / self.load_scale
        movement = float(np.sqrt(max(self.dot(point.tangent, point.tangent) - load**2, 0.0)))
        balanced = self.load_scale * load / max(movement, np.finfo(float).eps)
        scale = min(balanced, abs(point.load_factor))
        if scale <= self.load_scale:
            return self, point
        line = replace(self, load_scale=scale)
        return line, PathPoint(point.y, point.tangent / line.length(point.tangent), point.factors)

    def hold(self, y: np.ndarray) -> np.ndarray:
        """Return y with the prescribed coordinates of its load factor."""
        result = y.copy()
        result[self.system.prescribed_dofs] = self.system.prescribed_values(float(y[-1]))
        return result

    def plane(self, tangent: np.ndarray) -> np.ndarray:
        """Return the normal (n + 1,) of the plane in which a step along a unit tangent is corrected.

        It is the tangent, except if the load factor moves supports and changes enough along the path: then it is the
        axis of the load factor, so that prescribed coordinates stay fixed during the correction, since independent
        stresses give the tangent no information on them.
        """
        moved = bool(np.any(tangent[self.system.prescribed_dofs]))
        return self.load_axis if moved and abs(tangent[-1]) >= _GROWS_WELL * self.load_scale else tangent

    @property
    def load_axis(self) -> np.ndarray:
        """The change of y (n + 1,) by 1 of the load factor alone."""
        result = np.zeros(len(self.scale))
        result[-1] = 1.0
        return result

    def stresses(self, y: np.ndarray, step: np.ndarray) -> Stresses | None:
        """Return the stress resultants predicted for a step from y, None if the iteration uses those of the state."""
        if not self.newton.independent_stresses:
            return None
        return predicted_stresses(self.system, y[:-1], step[:-1], float(y[-1] + step[-1]))

    def correct(
        self,
        start: np.ndarray,
        stresses: Stresses | None,
        normal: np.ndarray,
        farthest: float = np.inf,
        counted: bool = False,
    ) -> Corrected:
        """Return the equilibrium in the plane through `start` (n + 1,) normal to `normal` (n + 1,).

        stresses: for the first geometric tangent, as predicted for `start`; farthest: length of the correction beyond
        which the iteration is given up; counted: whether to count the negative pivots of all iterations.
        """
        problem = _InPlane(self, start, stresses, normal, farthest, counted)
        result = problem.find()
        return Corrected(problem.state, result.iterations, result.ended, problem.counts)

    def linearised(self, y: np.ndarray, like: np.ndarray) -> PathPoint:
        """Return the point y with its tangent in the sense of `like` (n + 1,). Raises LinAlgError."""
        _, along, factors = self.solve(y, None)
        tangent = along / self.length(along)
        return PathPoint(y, tangent if self.dot(tangent, like) >= 0.0 else -tangent, factors)

    def softest_modes(self, factors: Factorised, count: int) -> np.ndarray:
        """Return orthonormal changes of y (count, n + 1) that span the modes with the smallest stiffness."""
        free = self.system.free_dofs
        roots = np.sqrt(self.weights[free])
        basis = np.random.default_rng(0).standard_normal((len(free), min(count, len(free))))
        for _ in range(_INVERSE_ITERATIONS):
            basis = np.linalg.qr(basis)[0]
            improved = np.column_stack([factors.solve(roots * column) * roots for column in basis.T])
            outside = improved - basis @ (basis.T @ improved)
            converged = np.all(np.linalg.norm(outside, axis=0) < _STILL * np.linalg.norm(improved, axis=0))
            basis = improved
            if converged:
                break
        result = np.zeros((basis.shape[1], len(self.scale)))
        result[:, free] = (np.linalg.qr(basis)[0] / roots[:, None]).T
        return result

    def softness(self, factors: Factorised, mode: np.ndarray) -> float:
        """Return mode . K^-1 mode, which has a pole with change of sign where K is singular along the mode."""
        right = (self.weights * mode)[self.system.free_dofs]
        return float(right @ factors.solve(right))

    def solve(self, y: np.ndarray, stresses: Stresses | None) -> tuple[np.ndarray, np.ndarray, Factorised]:
        """Return the Newton correction of y at its load factor, dy/d(load factor), and the factors of the tangent.

        stresses: for the geometric tangent, None for those of the state. Raises LinAlgError.
        """
        system, p, at = self.system, y[:-1], float(y[-1])
        free, prescribed = system.free_dofs, system.prescribed_dofs
        before, after, width = self._around(at)
        unbalanced, tangent = linearise_at_rest(system, p, at, stresses)
        factors = tangent.factorised(system.rotated)
        balance, along = np.zeros(len(y)), np.zeros(len(y))
        balance[free], _ = factors.correction(unbalanced[free])
        along[free] = factors.solve(-load_change(system, p, before, after)[free] / width)
        change = system.prescribed_values(after) - system.prescribed_values(before)
        along[prescribed] = change / width
        along[-1] = 1.0
        if not (np.isfinite(balance).all() and np.isfinite(along).all()):
            raise LinAlgError("the tangent is singular")
        return balance, along, factors

    def _around(self, at: float) -> tuple[float, float, float]:
        """Return two load factors around one, inside of the piece if this one is, and their distance for slopes."""
        width, (low, high) = _SLOPE_WIDTH * self.load_scale, self.piece
        if not low <= at <= high or not self.functions_of_time:
            # not the difference of the two, which round-off of large load factors changes from point to point
            return at - width, at + width, 2.0 * width
        width = min(width, 0.5 * (high - low))
        before, after = max(at - width, low), min(at + width, high)
        return before, after, after - before


class _InPlane(SingleCorrections, Equilibrium):
    """The equilibrium in a plane, with unknown load factor, see `Continuation.correct`.

    counts: fewest and most negative pivots so far.
    """

    def __init__(
        self,
        line: "Continuation",
        start: np.ndarray,
        stresses: Stresses | None,
        normal: np.ndarray,
        farthest: float,
        counted: bool,
    ) -> None:
        self.line, self.system, self.newton, self.start = line, line.system, line.newton, start
        self.stresses, self.normal, self.farthest, self.counted = stresses, normal, farthest, counted
        self.state = line.hold(start)
        self.counts = np.iinfo(int).max, 0

    def take(self) -> tuple[float, int]:
        line, y = self.line, self.state
        balance, along, factors = line.solve(y, self.stresses)
        negative = factors.negative_pivots if self.counted else 0
        self.counts = min(self.counts[0], negative), max(self.counts[1], negative)
        reach = line.dot(self.normal, along)
        if reach == 0.0:
            raise LinAlgError("the path lies in the plane")
        change = -(line.dot(self.normal, y - self.start) + line.dot(self.normal, balance)) / reach
        self.state = line.hold(y + balance + change * along)
        self.stresses = line.stresses(y, self.state - y)
        away = line.length(self.state - self.start) > self.farthest
        return np.inf if away else float(np.max(np.abs(self.state - y) / line.scale)), negative

    def balance(self) -> Balance:
        return balance_of(self.system, self.state[:-1], float(self.state[-1]))


def begin(
    system: System,
    p: np.ndarray,
    load_factor: float,
    newton: Newton,
    piece: tuple[float, float] = (-np.inf, np.inf),
) -> tuple[Continuation, PathPoint]:
    """Return the continuation of a model and its first point, that of the equilibrium p, towards larger loads.

    The soft load is the load factor whose forces would move the softest mode by about a length of the model, or whose
    prescribed motions are that large. The load scale lies between it and a large multiple of it, if possible such that
    movement and load have equal parts in the tangent of the first point. Neither depends on the size of the loads or
    on units. Raises LinAlgError if the tangent is singular, ConvergenceError if loads are too large or too small.
    """
    plain = Continuation(system, newton, 1.0, 1.0, piece)
    loses_digits(system, p, load_factor)
    _, tangent = linearise_at_rest(system, p, load_factor)
    factors = tangent.factorised(system.rotated)
    (mode,) = plain.softest_modes(factors, 1)
    stiffness = 1.0 / abs(plain.softness(factors, mode)) / float(np.max(np.abs(mode) / plain.scale)) ** 2
    per_load, flat = _reach(plain, p, load_factor, stiffness, 1e-6), False
    if system.loads.varying or any(callable(item.value) for item in system.prescribed) or per_load == 0.0:
        # an amplitude may start with a slope near zero: then its largest effect up to load factor 1 counts
        with suppress(InputError):  # from a function that is not defined so far
            further = max(_reach(plain, p, load_factor, stiffness, width) for width in _WIDTHS)
            flat = further > _STEEPER * per_load
            per_load = further if flat else per_load
    soft = 1.0 / per_load if per_load > 0.0 else 1.0
    if not np.finfo(float).tiny <= soft * soft < np.inf:
        raise ConvergenceError(
            f"the loads would move this model by {per_load:.1g} times its size, which double precision cannot square; "
            "take loads closer to its stiffness"
        )
    y = np.append(p, load_factor)
    moving = Continuation(system, newton, soft, soft, piece).linearised(y, plain.load_axis).tangent[-1] / soft
    balanced = soft * moving / np.sqrt(max(1.0 - moving**2, _LARGEST_RATIO**-2))
    # the first tangent of a flat start says nothing about the movement further on
    line = Continuation(system, newton, soft if flat else max(balanced, soft), _LOAD_STEP * soft, piece)
    return line, line.linearised(y, line.load_axis)


def _reach(line: Continuation, p: np.ndarray, load_factor: float, stiffness: float, width: float) -> float:
    """Return the scaled displacement per load factor due to forces, against a stiffness, and prescribed motions.

    Imposed strains count by the forces that would suppress them: even if nothing moves, these may buckle a model.
    """
    system, scale = line.system, line.scale[:-1]
    ends = load_factor, load_factor + width
    forces = [residual_at_rest(system, p, at)[system.free_dofs] for at in ends]
    prescribed = [system.prescribed_values(at) / scale[system.prescribed_dofs] for at in ends]
    moved = float(np.abs(forces[1] - forces[0]) @ scale[system.free_dofs]) / stiffness
    if system.model.imposing:
        hindered = [imposed_forces(system, at) for at in ends]
        moved = max(moved, float(np.max(np.abs(hindered[1] - hindered[0]) * scale)) / stiffness)
    return max(moved, float(np.max(np.abs(prescribed[1] - prescribed[0]), initial=0.0))) / width
