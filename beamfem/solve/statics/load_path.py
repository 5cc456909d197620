"""Follow the equilibrium path to the next row of a static solve if a load step alone would leave it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.equations.system import System
from beamfem.errors import BeamfemError
from beamfem.solve.continuation.bifurcations import Crossing
from beamfem.solve.continuation.continuation import Continuation, PathPoint, begin
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError
from beamfem.solve.continuation.steps import Refused, Step, longest_accepted, longest_step, take_step
from beamfem.solve.newton.newton import Newton
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
            if _SLOWER * before <= gained <= _FASTER * before and half * (1.0 - load_factor) > _MOST_STEPS * gained:
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

        def attempt(size: float) -> Step | Refused:
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
