"""Detection of load steps that may have passed limit points to another stable state."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, linearise, load_slope, predicted_stresses
from beamfem.assembly.system import Proven, System
from beamfem.solve.continuation.steps import leaves_arc
from beamfem.solve.newton.iteration import Newton, NewtonResult
from beamfem.solve.statics.static_record import StaticRecord

# of the lesser rise of the load per movement at the ends of a step: with less in between it may fall there
_FRACTION = 0.3
_SLOPE_WIDTH = 1e-3  # of the load step; loads are evaluated within it only, since functions may end with it


def leaves_path(system: System, start: tuple[np.ndarray, float], end: tuple[np.ndarray, float]) -> bool:
    """Return whether no smooth path leads from one equilibrium, p (n,) and its load factor, to another.

    Along an arc the chord deviates from the tangents at its ends by half the angle between them; between states on two
    pieces of a path, on either side of limit points, it deviates from one of them by more. Where a short snap leads on
    in the same direction, the load rises less over the step than at both its ends, see `_dips`.
    """
    (p, before), (q, after) = start, end
    width = _SLOPE_WIDTH * (after - before)
    try:
        first = _tangent(system, p, before, before + width, width)
        last = _tangent(system, q, after, after - width, width)
    except LinAlgError:
        return True
    chord = (q - p) / system.scale
    turn = _angle(first, last)
    if any(leaves_arc(_angle(chord, tangent), turn) for tangent in (first, last)):
        return True
    along = [(after - before) * float(chord @ tangent) for tangent in (first, last)]
    return min(along) > 0.0 and _dips(*(float(chord @ chord) / each for each in along))


def _dips(first: float, last: float) -> bool:
    """Return whether the load falls, or nearly does, on a cubic with these slopes at its ends and a mean slope of 1.

    Only a structure that is softer in between than at both ends is meant: where it softens or stiffens all the way,
    one slope is below the mean.
    """
    if min(first, last) <= 1.0:
        return False
    return first - (2.0 * first + last - 3.0) ** 2 / (3.0 * (first + last - 2.0)) < _FRACTION * min(first, last)


def _tangent(system: System, p: np.ndarray, load_factor: float, middle: float, width: float) -> np.ndarray:
    """Return the scaled derivative of p (n,) by the load factor, by a difference centred at `middle`."""
    zeros, prescribed = np.zeros(len(p)), system.prescribed_dofs
    _, stiffness = linearise(system, p, zeros, zeros, load_factor, STATICS)
    result = np.zeros(len(p))
    slope = load_slope(system, p, middle, width)[system.free_dofs]
    result[system.free_dofs] = stiffness.factorised(system.rotated).solve(-slope)
    change = system.prescribed_values(middle + width) - system.prescribed_values(middle - width)
    result[prescribed] = change / (2.0 * width)
    if not np.isfinite(result).all():
        raise LinAlgError("the tangent is singular")
    return result / system.scale


def _angle(a: np.ndarray, b: np.ndarray) -> float:
    """Return the angle [rad] between two changes (n,), zero if one of them vanishes."""
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(np.arccos(np.clip(float(a @ b) / size, -1.0, 1.0))) if size > 0.0 else 0.0


# Ratio of the first correction to the whole step, and of the speeds of two steps; it is larger near a limit point.
_OVERSHOOT = 3.0
_SHORT = 1e-2  # of the movement so far
# Iterations. Most models under constant forces start at rest and reach the end in one long step.
_SLOW, _SLOW_FROM_REST = 7, 12


def skips_limit_points(system: System, done: StaticRecord, target: float, result: NewtonResult, newton: Newton) -> bool:
    """Return whether a load step to `target` may have passed limit points.

    This is so if linearised stability predicts a critical point before its end, or if the tangent at its start leads
    far beyond its end, as near a limit point; this is not tested from the reference, where it also happens to a
    straight beam that is stiffened by its own tension. If the iteration was slow, it is also so if the state half-way
    has another count of negative pivots, or, in models without history, whose path has no kinks, if the step has
    another direction than the tangents at its ends.
    """
    if result.linear is not None:
        done.iterations += 1
        if result.linear != done.negative_pivots:
            return True
    if done.reached > 0.0:
        moved = _moved(system, result.state, done.state)
        if result.first > _OVERSHOOT * moved + newton.tolerance:
            return True
    if result.iterations < _SLOW:
        return False
    if result.iterations < _SLOW_FROM_REST and done.reached == 0.0 and _constant_forces(system, target):
        return False
    if _differs_half_way(system, done, target, result.state):
        return True
    if len(system.history.numbers):
        return False  # the tangent of a committed state is that of unloading, not of the path
    done.iterations += 2
    return leaves_path(system, (done.state, done.reached), (result.state, target))


def is_short(system: System, done: StaticRecord, target: float, state: np.ndarray | None = None) -> bool:
    """Return whether a step moves little and continues the last one, so that no snap lies within it.

    A snap moves a structure far in a step of any size. In contrast, the count of negative pivots may change while an
    iteration yields too far. state (n,): at the end of the step; by default, it is as fast as the last one.
    """
    if len(done.rows) < 2:
        return False
    (before, last, _), (at, now, _) = done.rows[-2:]
    expected = _moved(system, now, last) * (target - at) / (at - before) if at > before else 0.0
    moved = expected if state is None else _moved(system, state, now)
    return moved <= min(_SHORT * _moved(system, now, system.reference), _OVERSHOOT * expected)


def _moved(system: System, p: np.ndarray, before: np.ndarray) -> float:
    return float(np.max(np.abs(p - before) / system.scale))


def _constant_forces(system: System, load_factor: float) -> bool:
    """Return whether forces alone act, which neither follow the beam nor come from imposed strains and supports."""
    if any(item.change(load_factor, system.static) for item in system.prescribed):
        return False
    if Proven.CONSTANT_LOADS not in system.proven:
        follow = any(np.any(loads.follows) for loads in system.point_loads)
        if follow or any(block.imposed is not None for block in system.blocks):
            return False
        system.proven.add(Proven.CONSTANT_LOADS)
    return True


def _differs_half_way(system: System, done: StaticRecord, target: float, end: np.ndarray) -> bool:
    """Return whether the state half-way, with the mean stress resultants of both ends, has another count.

    Its own stress resultants would be those of a chord.
    """
    done.iterations += 1
    zeros = np.zeros(len(end))
    ends = (predicted_stresses(system, p, zeros, at) for p, at in ((done.state, done.reached), (end, target)))
    mean = tuple(0.5 * (one + other) for one, other in zip(*ends, strict=True))
    middle = 0.5 * (done.state + end)
    _, tangent = linearise(system, middle, zeros, zeros, 0.5 * (done.reached + target), STATICS, mean)
    try:
        return tangent.factorised(system.rotated).negative_pivots != done.negative_pivots
    except LinAlgError:
        return True
