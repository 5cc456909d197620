"""Steps along an equilibrium path: prediction, correction, acceptance or rejection, and the length of the next one."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.equations import load_change, residual_at_rest
from beamfem.errors import InputError
from beamfem.precision.roundoff import loses_digits_by_now
from beamfem.solve.continuation.bifurcations import Crossing, bifurcations
from beamfem.solve.continuation.continuation import Continuation, Corrected, PathPoint
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError

_SMALLEST = 1e-8
_LARGEST = 0.5
_LEAST_FRACTION = 0.1  # of the whole movement: the least fraction that counts as deformation when a step is bounded
_LARGEST_GROWTH = 0.5  # of a large load factor, in one step
_WANTED_TURN = 0.2  # [rad] by which the tangent of the path should turn in a step
_LARGEST_TURN = 0.5
_OVER = 1.1  # of the way to the last load factor, so that a step passes it
_LARGEST_PRESCRIBED_TURN = 1.0  # [rad] of a support in a step
_LARGEST_CORRECTION = 0.5  # of the step
# An arc deviates from its tangent by half the angle that the tangent turns, or by a third to two thirds of it if the
# curvature varies linearly. An equilibrium that is further away, as a fraction of the step, is on another path, or the
# path bends within the step.
_ARC = 0.75
_BESIDE = 0.03
_ASIDE = 0.02
_ANOTHER = 1e-4  # of the model: the least distance of another path; near limit points the tangent itself has an error
_FARTHEST = 2.0  # of the step: iterates further away are considered to diverge
_WANTED_ITERATIONS = 8
# Of the longest step: in a shorter one a change of the pivots of an unsymmetric tangent by an even number is taken for
# one that keeps the determinant away from zero, as two pivots can change their signs together.
_PAIR = 1.0 / 64.0
_MANY = 1.0 / 256.0  # of the longest step: in a shorter one, modes that soften together are all located
_LARGEST_INCREASE = 4.0
# Not a half: of a step that is refused as it ends where paths cross, two halves end there again, and so on towards it.
_CUT = 0.6
_KINK = 1e-6  # shorter steps may cross a kink of the path, such as where a stop is hit
_INTO = 2.0  # steps into a kink, and along the path behind it
_BEHIND = 8.0
_BENDS = 0.1  # of the growth of unbalanced forces along three steps: less at a kink, 0.25 on a smooth path
_STIFFENS = 0.1  # of the change of loads: the least growth at a kink

_Found = TypeVar("_Found")


@dataclass(frozen=True, eq=False)
class Step:
    """An accepted step: the segment, the fractions of its limit points, its bifurcations, length of the next step."""

    segment: Segment
    limits: list[float]
    crossings: list[Crossing]
    iterations: int
    next_size: float


@dataclass(frozen=True)
class Refused:
    """A rejected step: the reason, the number of iterations, and whether another path may cross at its end."""

    reason: str
    iterations: int
    crosses: bool = False


def longest_step(line: Continuation, point: PathPoint, end: float | None = None) -> float:
    """Return the longest step from a point; end: the load factor at which the path ends, if it has one.

    It bounds the movement, the change of the load factor and the rotation of a support, since gradients elsewhere on
    the beam cannot distinguish a full turn from none. What functions of the load factor do within a step must show at
    its end. A structure on soft springs that drifts as a whole is bounded by the load only: a translation, however
    long, does not lead to another path.
    """
    load_fraction = abs(float(point.tangent[-1])) / line.load_scale
    moving = np.sqrt(max(1.0 - load_fraction**2, 0.0)) * _deforming(line, point.tangent)
    load = max(line.load_step, _LARGEST_GROWTH * abs(point.load_factor)) / line.load_scale
    size = float(min(_LARGEST / max(moving, 1e-12), load / max(load_fraction, 1e-12)))
    before, slope = point.load_factor, float(point.tangent[-1])
    while line.system.largest_turn(before, before + size * slope) > _LARGEST_PRESCRIBED_TURN and size > _SMALLEST:
        size *= 0.5
    if line.functions_of_time and end is not None and (end - before) * slope > 0.0:
        size = min(size, _OVER * (end - before) / slope)
    with suppress(InputError):  # from a function that is not defined so far
        while (
            any(function.bulges(before, before + size * slope) for function in line.functions_of_time)
            and size > _SMALLEST
        ):
            size *= 0.5
    return size


def _deforming(line: Continuation, tangent: np.ndarray) -> float:
    """Return the fraction of the movement along a tangent that bounds a step: 1 unless nearly all is translation."""
    system = line.system
    change = tangent[:-1] / system.scale
    beside = np.max(np.abs(change[~system.positions]), initial=0.0)
    largest = max(float(np.max(np.abs(change), initial=0.0)), np.finfo(float).tiny)
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    half_range = 0.5 * float(np.ptp(change[nodes], axis=0).max())
    return float(min(max(beside, half_range) / (_LEAST_FRACTION * largest), 1.0))


def too_small(line: Continuation, point: PathPoint, size: float) -> bool:
    """Return whether a step is so small that round-off of the point hides it."""
    return size < _SMALLEST * max(1.0, abs(point.load_factor) / line.load_scale)


def longest_accepted(
    line: Continuation, point: PathPoint, longest: float, attempt: Callable[[PathPoint, float], _Found | Refused]
) -> tuple[_Found | None, list[str], float]:
    """Return what `attempt` finds with the longest step up to `longest` that it accepts, None if none is.

    Also return the reasons of all refusals, and the length of the last step. A tangent that has digits enough at the
    start of a path may have too few for the softest mode beside a critical point; steps there are then tried once more.
    """
    reasons: list[str] = []
    size = longest
    while True:
        found = attempt(point, size)
        if not isinstance(found, Refused):
            return found, reasons, size
        reasons.append(found.reason)
        size *= _CUT if found.crosses else 0.5
        if len(reasons) == 1 and loses_digits_by_now(line.system, point.y[:-1], point.load_factor):
            pivots, size = point.negative_pivots, longest
            with suppress(LinAlgError):
                point = line.linearised(point.y, point.tangent)
            if point.negative_pivots != pivots:
                reasons.append("a critical point was passed unseen, as the tangent had lost its digits")
                return None, reasons, size
        if too_small(line, point, size):
            return None, reasons, size


def take_step(
    line: Continuation,
    point: PathPoint,
    size: float,
    to: float | None = None,
    strict: bool = True,
    sought: float = np.inf,
) -> Step | Refused:
    """Return the step of a given length from a point with its critical points, or the reason of its rejection.

    to: load factor at the end of the step, if it is given; strict: whether to refuse a step whose iteration passed
    states with other counts of negative pivots than its ends; sought: number of critical points, of which a long step
    is to pass no more.
    """
    smooth = point
    if size < _KINK:
        point = _behind_kink(line, point, size)
    change = size * point.tangent
    if point is not smooth:  # far enough for the new stiffness to act
        change = size * (_INTO * smooth.tangent + _BEHIND * point.tangent)
        size *= _BEHIND
    farthest = _FARTHEST * size
    start, stresses, plane = point.y + change, line.stresses(point.y, change), line.plane(point.tangent)
    if to is not None:
        start[-1], plane = to, line.load_axis
    corrected = line.correct(start, stresses, plane, farthest, counted=True)
    if not corrected.ended.good:
        return Refused(corrected.ended.value, corrected.iterations)
    correction = line.length(corrected.y - point.y - change) / size
    if correction > _LARGEST_CORRECTION:
        return Refused("the equilibrium beside the end of the step is too far away", corrected.iterations)
    try:
        new = line.linearised(corrected.y, point.tangent)
    except LinAlgError:
        return Refused("the tangent is singular", corrected.iterations)
    # the sign of the determinant of an unsymmetric tangent does not show an even number of pivots
    change_of_pivots = new.negative_pivots - point.negative_pivots
    hidden = not line.system.symmetric and change_of_pivots != 0 and change_of_pivots % 2 == 0
    if hidden and size > _PAIR * longest_step(line, point):
        return Refused("the tangent may be singular at an even number of points within the step", corrected.iterations)
    if abs(change_of_pivots) > sought and size > _MANY * longest_step(line, point):
        return Refused("the step passes more critical points than are sought", corrected.iterations)
    if strict and _crosses_over(line, (point, new), corrected):
        return Refused("another path lies between the start and the end of the step", corrected.iterations, True)
    turn = float(np.arccos(min(line.dot(new.tangent, point.tangent), 1.0)))
    if turn > _LARGEST_TURN:
        return Refused("the path turns too sharply", corrected.iterations)
    if leaves_arc(correction, turn) and correction * size > _ANOTHER:
        return Refused("the equilibrium beside the end of the step is on another path", corrected.iterations)
    if point is smooth and _beside_tangents(line, point, new) > _ASIDE:
        return Refused("the step leaves the plane of the tangents at its ends", corrected.iterations)
    segment = Segment(line, point, new)
    try:
        limits = segment.limit_points()
        crossings = bifurcations(segment, limits)
    except SegmentLostError as error:
        return Refused(f"a critical point was not found: {error}", corrected.iterations + segment.iterations, True)
    if point.tangent[-1] * smooth.tangent[-1] < 0.0:
        limits = [0.0, *limits]
    increase = min(_WANTED_TURN / max(turn, 1e-12), _WANTED_ITERATIONS / corrected.iterations, _LARGEST_INCREASE)
    iterations = corrected.iterations + segment.iterations
    return Step(segment, limits, crossings, iterations, size * max(increase, 0.25))


def _behind_kink(line: Continuation, point: PathPoint, size: float) -> PathPoint:
    """Return a point with the tangent behind a kink of the path that lies within a step ahead, if there is one.

    There the stiffness jumps, as where a part hits a stop, so that forces which a step along the tangent leaves
    unbalanced grow linearly. The sign of the determinant times the slope of the load factor stays the same.
    """
    system, at = line.system, point.load_factor
    scale = line.scale[system.free_dofs]

    def unbalanced(steps: float) -> np.ndarray:
        y = point.y + steps * size * point.tangent
        return np.asarray(residual_at_rest(system, y[:-1], float(y[-1]))[system.free_dofs] * scale)

    try:
        one, two, three = map(unbalanced, (1.0, 2.0, 3.0))
        loads = load_change(system, point.y[:-1], at, at + size * point.tangent[-1])[system.free_dofs] * scale
        growth = float(np.linalg.norm(three - one))
        bend = float(np.linalg.norm(three - 2.0 * two + one))
        if bend > _BENDS * growth or growth < _STIFFENS * float(np.linalg.norm(loads)):
            return point
        new = line.linearised(point.y + _INTO * size * point.tangent, point.tangent)
    except LinAlgError:
        return point
    odd = (new.negative_pivots - point.negative_pivots) % 2 == 1
    forward = (new.tangent[-1] * point.tangent[-1] < 0.0) == odd
    return PathPoint(point.y, new.tangent if forward else -new.tangent, new.factors)


def leaves_arc(deviation: float, turn: float) -> bool:
    """Return whether a step deviates from a tangent [rad] by more than a path whose tangent turns by `turn` [rad]."""
    return deviation > _ARC * turn + _BESIDE


def _beside_tangents(line: Continuation, before: PathPoint, after: PathPoint) -> float:
    """Return which fraction of a step lies outside the plane of the tangents at its ends, where all of an arc is."""
    chord = after.y - before.y
    size = line.length(chord)
    aside = after.tangent - line.dot(after.tangent, before.tangent) * before.tangent
    for direction in (before.tangent, aside):
        squared = line.dot(direction, direction)
        if squared > 0.0:
            chord = chord - line.dot(chord, direction) / squared * direction
    return line.length(chord) / size


def _crosses_over(line: Continuation, ends: tuple[PathPoint, PathPoint], corrected: Corrected) -> bool:
    """Return whether the correction passed states with a count of negative pivots outside that of both ends.

    This happens on the way from one side of an imperfect bifurcation to the branch on the other side. With follower
    loads only the sign of the determinant counts, which is negative for an odd number of negative pivots.
    """
    counts = [end.negative_pivots for end in ends]
    fewest, most = corrected.negative_pivots
    if line.system.symmetric:
        return fewest < min(counts) or most > max(counts)
    return fewest == most and counts[0] % 2 == counts[1] % 2 != most % 2
