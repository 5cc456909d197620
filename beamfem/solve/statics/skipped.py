"""Detection of load steps that may have passed limit points to another stable state."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, linearise, predicted_stresses
from beamfem.assembly.system import System
from beamfem.solve.newton.iteration import Newton, NewtonResult
from beamfem.solve.statics.path_direction import leaves_path
from beamfem.solve.statics.static_record import StaticRecord

_OVERSHOOT = 3.0  # first correction of a step beside the whole of it: more is what a limit point near the start makes
_SLOW, _SLOW_FROM_REST = 7, 12  # iterations; most models are at rest first and go all the way in one long step


def skips_limit_points(system: System, done: StaticRecord, target: float, result: NewtonResult, newton: Newton) -> bool:
    """Return whether a load step to `target` may have gone over limit points.

    Either linearised stability expects a critical point before its end. Or the tangent at its start goes far beyond its
    end, as beside a limit point; from the reference a straight beam does so where its own tension stiffens it. Or,
    looked at where the iteration was slow, the state half-way has another count of negative pivots, or the step goes
    another way than the tangents at its ends, if nothing remembers: there the path has kinks.
    """
    if result.linear is not None:
        done.iterations += 1
        if result.linear != done.negative_pivots:
            return True
    if done.reached > 0.0:
        moved = float(np.max(np.abs(result.state - done.state) / system.scale))
        if result.first > _OVERSHOOT * moved + newton.tolerance:
            return True
    if result.iterations < (_SLOW if done.reached > 0.0 else _SLOW_FROM_REST):
        return False
    if _differs_half_way(system, done, target, result.state):
        return True
    if len(system.history.numbers):
        return False  # the tangent of a committed state is that of unloading, not of the path
    done.iterations += 2
    return leaves_path(system, (done.state, done.reached), (result.state, target))


def _differs_half_way(system: System, done: StaticRecord, target: float, end: np.ndarray) -> bool:
    """Return whether the state half-way has another count with the mean stress resultants of both ends.

    Its own would be those of a chord.
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
