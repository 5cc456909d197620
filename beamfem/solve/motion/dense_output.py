"""States of a motion between the ends of its steps."""

import numpy as np

from beamfem.equations.equations import linearise
from beamfem.equations.system import System

_PART = 0.3  # of a step: what vibrates faster than in some steps hardly strains by p'' that is interpolated


def between(system: System, times: np.ndarray, states: np.ndarray, at: np.ndarray, smooth: bool = False) -> np.ndarray:
    """Return states (k, 3, n) at times (k,) [s] within steps from states (m + 1, 3, n) at their ends (m + 1,) [s].

    Cubic polynomials have p and p', or p' and p'', of both ends; p'' is linear. Their errors are h^4 / 384 times the
    fourth derivatives. Multipliers and history variables, which have no rates, are linear, and coordinates that
    supports prescribe have their values. smooth: whether p is of degree 5, with p'' of both ends too, and p'' its own.
    """
    step, share = _places(times, at)
    result, p = interpolated(times, states, at, smooth), states[:, 0]
    linear = np.concatenate([system.connectors.multipliers, system.history.numbers]).astype(np.int64)
    result[:, 0, linear] = ((1.0 - share) * p[step] + share * p[step + 1])[:, linear]
    result[:, 1:, linear] = 0.0
    if any(callable(item.value) for item in system.prescribed):
        result[:, 0, system.prescribed_dofs] = [system.prescribed_values(time) for time in at.tolist()]
    return result


def balanced(
    system: System, times: np.ndarray, states: np.ndarray, time: float, smooth: bool = False, resolved: bool = False
) -> np.ndarray:
    """Return p, p', p'' (3, n) at a time [s] within a step, as `between` does, in balance.

    The error of interpolation strains what is stiff, such as rods along their axes. (K + M / t^2) dp = -r with a time t
    that is a part of the step takes it out: p'' + dp / t^2 is in balance, and what is slow hardly changes. History is
    that of a step from the beginning to this time, between those of both ends, if steps are resolved: as those that
    follow a tolerance, and end at kinks; else, as in a contact that lasts for less than a step, it is linear.
    """
    end = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1))
    times, states = times[end - 1 : end + 1], states[end - 1 : end + 1]
    step, elapsed = float(times[1] - times[0]), time - float(times[0])
    if smooth:
        states = _with_resolved_accelerations(system, step, states)
    p, v, a = between(system, times, states, np.array([time]), smooth)[0]
    inertia, free, numbers = 1.0 / (_PART * step) ** 2, system.free_dofs, system.history.numbers
    if resolved:
        p[numbers] = states[0, 0, numbers]
    unbalanced, tangent = linearise(system, p, v, a, time, (1.0, 0.0, inertia), dt=elapsed)
    change = np.zeros(len(p))
    change[free] = tangent.solve(-unbalanced[free], system.rotated)
    p = p + change
    change[system.connectors.multipliers] = 0.0
    a = a + inertia * change
    if resolved:
        ends, committed = states[:, 0, numbers], system.history.committed((p, v, a), time, elapsed)
        p[numbers] = np.clip(committed[numbers], ends.min(axis=0), ends.max(axis=0))
    return np.array([p, v, a])


def _with_resolved_accelerations(system: System, step: float, ends: np.ndarray) -> np.ndarray:
    """Return both ends (2, 3, n) of a step [s], with p'' of the cubic polynomial if their own do not lead to p'.

    Methods that damp nothing leave p'' of stiff vibrations there, which their steps do not resolve.
    """
    (p, p_end), (v, v_end), a = ends.swapaxes(0, 1)
    mean = 6.0 * (p_end - p) / step**2
    cubic = np.array([mean - (4.0 * v + 2.0 * v_end) / step, (2.0 * v + 4.0 * v_end) / step - mean])
    missed = np.linalg.norm((v_end - v - 0.5 * step * a.sum(axis=0)) / system.scale)
    if missed <= step * np.linalg.norm(cubic / system.scale, axis=1).max():
        return ends
    result = ends.copy()
    result[:, 2] = cubic
    return result


def _places(times: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the steps (k,) in which times are, and their shares (k, 1) of these."""
    step = np.clip(np.searchsorted(times, at, side="left") - 1, 0, len(times) - 2)
    return step, ((at - times[step]) / (times[step + 1] - times[step]))[:, None]


def interpolated(times: np.ndarray, states: np.ndarray, at: np.ndarray, smooth: bool) -> np.ndarray:
    """Return p, p' and p'' (k, 3, n) of coordinates with rates that are not prescribed, see `between`."""
    step, share = _places(times, at)
    size = (times[step + 1] - times[step])[:, None]
    p, v, a = (states[:, k] for k in range(3))
    result = np.stack(
        [
            _hermite(p[step], v[step], p[step + 1], v[step + 1], size, share),
            _hermite(v[step], a[step], v[step + 1], a[step + 1], size, share),
            (1.0 - share) * a[step] + share * a[step + 1],
        ],
        axis=1,
    )
    if smooth:  # p'' of the cubic polynomial is added where it differs; both are linear between these
        change, share_left = (p[step + 1] - p[step]) / size**2, 1.0 - share
        first = a[step] - 6.0 * change + (4.0 * v[step] + 2.0 * v[step + 1]) / size
        last = a[step + 1] + 6.0 * change - (2.0 * v[step] + 4.0 * v[step + 1]) / size
        result[:, 0] += 0.5 * size**2 * (share * share_left) ** 2 * (share_left * first + share * last)
        for end, one, other in ((first, share_left, share), (last, share, share_left)):
            result[:, 2] += (one**3 - 6.0 * other * one**2 + 3.0 * other**2 * one - one) * end
    return result


def _hermite(
    x0: np.ndarray, v0: np.ndarray, x1: np.ndarray, v1: np.ndarray, size: np.ndarray, share: np.ndarray
) -> np.ndarray:
    """Return the cubic polynomial with values x and slopes v at both ends of an interval."""
    s, change = share, x1 - x0
    bend = s * (1.0 - s) * ((1.0 - s) * (size * v0 - change) - s * (size * v1 - change))
    return np.asarray((1.0 - s) * x0 + s * x1 + bend)
