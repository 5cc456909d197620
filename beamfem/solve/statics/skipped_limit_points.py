"""Detection of load steps that may have passed limit points to another stable state."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, linearise, predicted_stresses
from beamfem.assembly.system import Proven, System
from beamfem.solve.newton.iteration import Newton, NewtonResult
from beamfem.solve.statics.path_direction import leaves_path
from beamfem.solve.statics.static_record import StaticRecord

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
