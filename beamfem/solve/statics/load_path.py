"""The equilibrium path to the next row of a static solve, and beyond where it ends or loses its stability."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.equations.equations import INERTIA, linearise, residual_at_rest
from beamfem.equations.system import System
from beamfem.errors import BeamfemError, LimitPointError
from beamfem.linalg.tangent import UNROTATED
from beamfem.solve.continuation.bifurcations import Crossing
from beamfem.solve.continuation.continuation import Continuation, PathPoint, begin
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError
from beamfem.solve.continuation.steps import Refused, Step, longest_accepted, longest_step, take_step
from beamfem.solve.newton.newton import (
    Correction,
    Newton,
    NewtonResult,
    SingleCorrections,
    Termination,
    iterate,
    largest_change,
    solve_equilibrium,
)
from beamfem.solve.statics.static_record import StaticRecord, is_unstable

LOCATED = 1e-6  # of the load factor, within which a row is the critical point
_FIRST_STEP = 1e-2  # along the path, see Continuation
_PACE = 40  # steps, rejected ones included, from which the number of further steps is estimated
# Ratio of the load gained in the second half of these steps to that in the first half. Outside of this range the path
# slows down, as towards a limit point, or speeds up, and the number of further steps cannot be estimated.
_SLOWER = 0.8
_FASTER = 1.2
_GAIN = 1e-7  # of the load factor: a path that would gain less before it turns back has reached its limit point
_MOST_STEPS = 10_000  # each moves the structure by up to half its size or half a radian


class PathLostError(BeamfemError):
    """The path could not be followed; the message gives the reason."""


class OutOfReachError(PathLostError):
    """The path can be followed, but not to load factor 1 in a reasonable number of steps."""


class BifurcatesError(BeamfemError):
    """The path loses its stability at the bifurcation y (n + 1,); modes (k, n + 1): those that lose their stiffness."""

    def __init__(self, y: np.ndarray, modes: np.ndarray) -> None:
        super().__init__(f"the path loses its stability at a bifurcation at load factor {y[-1]:.6g}")
        self.y = y
        self.modes = modes


class TurnsBackError(BeamfemError):
    """The path turns back at the limit point y (n + 1,); beyond (n + 1,): a point of the path after it."""

    def __init__(self, limit: np.ndarray, beyond: np.ndarray) -> None:
        super().__init__(f"the path turns back at load factor {limit[-1]:.6g}")
        self.limit = limit
        self.beyond = beyond


@dataclass(eq=False)
class PathFollower:
    """The path of a system from the state p (n,) at a load factor, followed by arc length; step lengths carry over.

    done: counts the iterations and the rejected steps; leaves: whether the path ends at the bifurcation at which it
    loses its stability; left (n + 1,): limit point of the last jump.
    """

    system: System
    newton: Newton
    done: StaticRecord
    start: tuple[np.ndarray, float]
    leaves: bool
    size: float = _FIRST_STEP
    left: np.ndarray | None = None
    passed: list[float] = field(default_factory=list)

    @cached_property
    def line(self) -> Continuation:
        """The continuation of the path; its unit of length is the effect of the loads at its start."""
        return begin(self.system, *self.start, self.newton)[0]

    def follow(self, p: np.ndarray, load_factor: float, beyond: float, end: float) -> Iterator[PathPoint]:
        """Yield the points from the equilibrium p (n,) to the first one at or above the load factor `beyond`.

        end: the largest load factor allowed. Raises TurnsBackError at a limit point; BifurcatesError where an unstable
        path is to be left; PathLostError if no step along the path is accepted elsewhere, OutOfReachError if load
        factor 1 is too far at the present step length.
        """
        try:
            line = replace(self.line, piece=(load_factor, end)) if self.line.functions_of_time else self.line
            point = line.linearised(np.append(p, load_factor), line.load_axis)
        except LinAlgError:
            raise PathLostError("the tangent is singular there") from None
        before: PathPoint | None = None
        while point.load_factor < beyond:
            self._require_pace(point.load_factor)
            cuts = self.done.cuts
            try:
                step = self._step(line, point, end)
            except PathLostError as lost:
                if before is None or not _at_maximum(line, before, point):
                    raise
                raise TurnsBackError(point.y, 2.0 * point.y - before.y) from lost
            before = point
            self.passed.extend((self.done.cuts - cuts + 1) * [point.load_factor])
            self.size = step.next_size
            point = step.segment.after
            extrema = sorted([*step.limits, *step.segment.turned])
            turn = min(extrema, default=1.0)
            if self.leaves and not is_unstable(self.system.symmetric, before.negative_pivots):
                _require_stable(step, turn, end)
            above = [x for x, at in step.segment.found.items() if x <= turn and at.load_factor > end]
            if above:
                rising = Segment(line, before, step.segment.at(max(above)))
                point = _at_load(rising, end, step.crossings)
            elif extrema:
                limit = step.segment.critical(extrema[0])
                if np.array_equal(limit, point.y):
                    point = self._step(line, point, np.inf).segment.after
                raise TurnsBackError(limit, point.y)
            yield point

    def _require_pace(self, load_factor: float) -> None:
        """Raise PathLostError if far too many further steps would be needed, intermediate load steps included."""
        if len(self.passed) >= _PACE:
            half = _PACE // 2
            start, middle = self.passed[-_PACE], self.passed[-half]
            before, gained = middle - start, load_factor - middle
            pace = max(gained / half, load_factor - self.passed[-1])  # steps may have begun to grow
            if _SLOWER * before <= gained <= _FASTER * before and 1.0 - load_factor > _MOST_STEPS * pace:
                raise OutOfReachError(
                    f"its last steps gained {gained / half:.1e} of the load factor each; at that pace load factor 1 is "
                    "out of reach: the loads are far too large for the structure, or not in its units"
                )

    def _step(self, line: Continuation, point: PathPoint, end: float) -> Step:
        """Return the longest accepted step from a point.

        Functions of the load factor may turn at `end`, so a step that would pass it ends there.
        """
        slope = float(point.tangent[-1])
        to_end = (end - point.load_factor) / slope if line.functions_of_time and slope > 0.0 else np.inf

        def attempt(point: PathPoint, size: float) -> Step | Refused:
            outcome = take_step(line, point, size, end if size >= to_end else None)
            self.done.iterations += outcome.iterations
            return outcome

        step, reasons, _ = longest_accepted(line, point, min(self.size, longest_step(line, point), to_end), attempt)
        self.done.cuts += len(reasons)
        if step is None:
            raise PathLostError(f"{reasons[-1]}, with steps along it cut to round-off")
        return step


def _require_stable(step: Step, limit: float, end: float) -> None:
    """Raise BifurcatesError if a step from a stable point loses its stability at a bifurcation below `end`.

    limit: fraction up to which the load factor grows.
    """
    first = next((crossing for crossing in step.crossings if crossing.fraction not in step.segment.turned), None)
    if first is None or first.fraction > limit or first.y[-1] > (1.0 - LOCATED) * end:
        return
    modes = [crossing.mode for crossing in step.crossings if crossing.fraction == first.fraction]
    raise BifurcatesError(first.y, np.array(modes))


def _at_maximum(line: Continuation, before: PathPoint, point: PathPoint) -> bool:
    """Return whether the load factor would stop growing if the path continued as from the previous point.

    If several paths cross at a limit point, no step leads over it, as in a bar that softens everywhere at once.
    """
    first, now = float(before.tangent[-1]), float(point.tangent[-1])
    if not 0.0 <= now < first:
        return False
    gain = 0.5 * now**2 * line.length(point.y - before.y) / (first - now)
    return gain <= _GAIN * abs(point.load_factor)


def _at_load(segment: Segment, target: float, crossings: Sequence[Crossing]) -> PathPoint:
    """Return the point with a load factor, which may be one of the bifurcations. Raises PathLostError."""
    modes = [crossing.mode for crossing in crossings if abs(crossing.y[-1] - target) <= LOCATED * abs(target)]
    try:
        return segment.critical_at_load(target, modes) if modes else segment.at_load(target)
    except SegmentLostError as error:
        raise PathLostError(str(error)) from error


_STEPS = 2000
_ITERATIONS = 8  # of Newton's method in a step
_SHORTEST = 1e-9  # of the first step, which moves far: shorter ones are given up
_LARGEST_MOVE = 0.1  # in a step: lengths of the model, radians
_NEAR = 1e-3  # a step that moves less than this, however long, is close to rest
_CLOSE = 1e-9  # of the movement: size of the last correction of a step
_SAME_LOAD = 1e-6  # limit points are located to about 1e-8
# of the model, or of a gradient: states at load factors 1e-6 apart differ by the square root near a limit point
_SAME_PLACE = 1e-3


def rest_state(
    system: System, limit: np.ndarray, beyond: np.ndarray, newton: Newton, farthest: float = np.inf
) -> NewtonResult:
    """Return the equilibrium to which the structure snaps at the load of a limit point (n + 1,).

    beyond (n + 1,): a point of the path after the limit point, on the side of departure; farthest: search distance from
    the limit point, in sizes of the model.
    """
    load_factor, free = float(limit[-1]), system.free_dofs
    aside = np.zeros(len(limit) - 1)
    aside[free] = (beyond - limit)[:-1][free]
    aside *= min(1.0, min(_LARGEST_MOVE, 0.5 * farthest) / largest_change(system, aside))
    p = limit[:-1] + aside
    p[system.prescribed_dofs] = system.prescribed_values(load_factor)
    mass = _mass(system, p, load_factor)
    pull = abs(float(aside[free] @ residual_at_rest(system, p, load_factor)[free]))
    time = float(aside[free] @ (mass @ aside[free])) / max(pull, np.finfo(float).tiny)
    iterations = waits = wait = 0
    shortest = _SHORTEST * time
    for _ in range(_STEPS):
        if time < shortest:
            break
        moved, used = _step(system, p, load_factor, time)
        iterations += used
        size = np.inf if moved is None else largest_change(system, moved - p)
        if moved is None or size > _LARGEST_MOVE:
            time *= 0.5
            continue
        p = moved
        if largest_change(system, p - limit[:-1]) > farthest:
            break
        time *= 2.0
        waits += 1
        if size < _NEAR and waits > wait:
            waits, wait = 0, 2 * wait + 1  # Newton's method costs several steps: if it fails, the next attempt waits
            result = solve_equilibrium(system, p, load_factor, newton, keep=0)
            iterations += result.iterations
            near = largest_change(system, result.state - p) < _LARGEST_MOVE
            near &= largest_change(system, result.state - limit[:-1]) <= farthest
            if result.ended.good and result.negative_pivots == 0 and near:
                return NewtonResult(result.state, iterations, result.ended)
    return NewtonResult(p, iterations, Termination.EXHAUSTED)


def same_point(system: System, one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two limit points (n + 1,) are equal except for full turns, which follower loads may add.

    Slow loading never lowers the load factor, so a limit point met again at the same load factor closes a cycle.
    """
    if abs(one[-1] - other[-1]) > _SAME_LOAD * abs(one[-1]):
        return False
    nodes = [system.assembler().nodal_vectors(np.ascontiguousarray(y[:-1])) for y in (one, other)]
    changes = [np.abs(a - b) for a, b in zip(*nodes, strict=True)]
    positions = max(float(change[:, :2].max()) for change in changes) / system.extent
    return max(positions, *(float(change[:, 2:].max()) for change in changes)) < _SAME_PLACE


def _step(system: System, p: np.ndarray, load_factor: float, time: float) -> tuple[np.ndarray | None, int]:
    """Return the state after an implicit Euler step, None if Newton's method fails; and the iterations."""
    step = _EulerStep(system, p, load_factor, time)
    stepped = iterate(step, _ITERATIONS)
    return step.state if stepped.ended.good else None, stepped.iterations


class _EulerStep(SingleCorrections):
    """An implicit Euler step from a state p (n,).

    It fails if it is so long that several states are possible at its end, some in other potential wells.
    """

    def __init__(self, system: System, p: np.ndarray, load_factor: float, time: float) -> None:
        self.system, self.before, self.state, self.load_factor, self.time = system, p, p.copy(), load_factor, time
        self.mass = _mass(system, p, load_factor)

    def take(self) -> tuple[float, int]:
        system, p, free, zeros = self.system, self.state, self.system.free_dofs, np.zeros(len(self.state))
        unbalanced, tangent = linearise(system, p, zeros, zeros, self.load_factor, (1.0, 0.0, 1.0 / self.time))
        factors = tangent.factorised(system.rotated)
        change = factors.solve(-unbalanced[free] - self.mass @ (p - self.before)[free] / self.time)
        p[free] += change
        return float(np.max(np.abs(change) / system.scale[free])), factors.negative_pivots

    def check(self, correction: Correction) -> Termination | None:
        if correction.diverges:
            return Termination.DIVERGED
        unstable = self.system.symmetric and correction.negative_pivots > 0
        moved = largest_change(self.system, self.state - self.before)
        small = correction.size <= _CLOSE + (1e-3 * moved if correction.number > 1 else 0.0)
        if unstable and (small or correction.number == 1):
            return Termination.LOST
        return Termination.CONVERGED if small else None


def _mass(system: System, p: np.ndarray, load_factor: float) -> np.ndarray:
    zeros = np.zeros(len(p))
    return linearise(system, p, zeros, zeros, load_factor, INERTIA)[1].sparse(UNROTATED)


BESIDE = 1e-4  # of the load factor of a critical point, which is located to about 1e-8
_ASIDE = 1e-3  # lengths of the model, radians: push along the modes
_RATIO = 0.6  # of the pushes along modes that become soft at once, so that none of their symmetries remains


def leave(system: System, done: StaticRecord, at: BifurcatesError, end: float, newton: Newton) -> None:
    """Add a row at a bifurcation, and the stable equilibrium just beyond it to which its modes lead.

    The record describes that state by the node that moves farthest.

    end: the largest load factor allowed. Raises LimitPointError.
    """
    load_factor = float(at.y[-1])
    end = min([end, *(row[0] for row in done.rows if row[0] > (1.0 + LOCATED) * load_factor)])  # computed again
    done.rows[:] = [row for row in done.rows if row[0] <= (1.0 + LOCATED) * load_factor]
    if done.reached < (1.0 - LOCATED) * load_factor:
        done.add(load_factor, at.y[:-1], 0, Termination.CONVERGED)
    else:  # the last row is the bifurcation, whose pivots have any sign
        load_factor = done.reached
        done.rows[-1] = load_factor, done.state, 0
    start = np.append(at.y[:-1], min((1.0 + BESIDE) * load_factor, end))
    way = _RATIO ** np.arange(len(at.modes)) @ at.modes
    way *= _ASIDE / largest_change(system, way[:-1])
    result = rest_state(system, start, start + way, newton)
    done.iterations += result.iterations
    if not result.ended.good:
        raise LimitPointError(f"{at}, and no state of rest was found beyond it", load_factor, done.solution())
    done.add(float(start[-1]), result.state, 0, result.ended, result.digits)
    change = result.state - start[:-1]
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    x, y = nodes[np.argmax(np.hypot(*change[nodes].T))]
    place, moved = (f"({a[x]:.4g}, {a[y]:.4g})" for a in (system.reference, change))
    unit = system.model.unit("m")
    done.left.append(
        f"{at}, which it leaves for the stable state in which the node at {place} {unit} is displaced by a further "
        f"{moved} {unit}"
    )
