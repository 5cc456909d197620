"""Prescribed coordinates at the ends of time steps: values, velocities, and accelerations that keep the momentum."""

from itertools import pairwise

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.model.sampled import Sampled

_ORDER = 4  # of the filter
_WIDTH = 0.02  # of a step, of the differences that give velocities
# weights of the first derivative inside, and of the first and third at an end, where nothing is asked outside
_INSIDE = np.array([-2, -1, 1, 2]), np.array([1, -8, 8, -1]) / 12.0
_AT_END = np.arange(5), np.array([-25, 48, -36, 16, -3]) / 12.0, np.array([-5, 18, -24, 14, -3]) / 2.0


def prescribed_motion(system: System, ends: np.ndarray) -> np.ndarray:
    """Return values, velocities and accelerations (m + 1, 3, nh) of the prescribed coordinates at times (m + 1,) [s].

    An acceleration is the mean of u'' under the hat that is 1 at the end of a step and 0 at those beside it: the change
    of the mean velocity from the step before to the step after, over the mean of both steps. So its sum over the steps
    is the change of the velocity, whatever u is between, and where u is smooth, the mean differs from u'' in second
    order. At the first and last time it is the half of the hat that lies inside, corrected for u''' where u is smooth.
    Values are u without what swings from step to step: stiff parts of a model would have to follow that, and ring.
    Raises InputError for motions that are known by values only.
    """
    if any(isinstance(item.value, Sampled) for item in system.prescribed):
        raise InputError(
            "a prescribed motion of this model was saved as values, which have no accelerations between them; "
            "give the function again to run it on"
        )
    values = np.zeros((len(ends), 3, len(system.prescribed)))
    if not any(callable(item.value) for item in system.prescribed):
        values[:, 0] = system.prescribed_values(0.0)
        return values
    steps = np.diff(ends)
    moved = np.array([system.prescribed_changes(time) for time in ends])  # keeps more digits than positions far away
    values[:, 0] = system.reference[system.prescribed_dofs] + moved - _unresolved(moved, steps)
    mean = np.diff(moved, axis=0) / steps[:, None]
    width = _WIDTH * np.minimum(steps[:-1], steps[1:])
    for i, time in enumerate(ends[1:-1]):
        around = np.array([system.prescribed_changes(time + k * width[i]) for k in _INSIDE[0]])
        values[i + 1, 1] = _INSIDE[1] @ around / width[i]
    values[1:-1, 2] = np.diff(mean, axis=0) / (0.5 * (steps[:-1] + steps[1:]))[:, None]
    for end, inward, step in ((0, 1, steps[0]), (-1, -1, -steps[-1])):
        width = _WIDTH * step
        near = np.array([system.prescribed_changes(ends[end] + k * width) for k in _AT_END[0]])
        velocity, third = _AT_END[1] @ near / width, _AT_END[2] @ near / width**3
        half = 2.0 * (mean[end] - velocity) / step
        beside = values[end + inward, 2] if len(steps) > 1 else half
        values[end, 1] = velocity
        values[end, 2] = half - _smaller(step * third / 3.0, 0.5 * (beside - half))
    return values


def _unresolved(moved: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Return the part of motions (m + 1, nh) that changes its sign from step to step, where steps (m,) are equal.

    That is (-D / 4)^4 u with second differences D: 1 of what does so in every step, (w h / 2)^8 of an oscillation w.
    A corner that jumps in velocity by dv is rounded by at most 0.08 h dv. Shapiro 1970.
    """
    result = np.zeros_like(moved)
    even = np.abs(np.diff(steps)) <= 1e-9 * steps[1:]
    ends = np.flatnonzero(np.concatenate([[True], ~even, [True]]))
    for first, last in pairwise(ends.tolist()):
        part = moved[first : last + 1]
        if len(part) > 2 * _ORDER:
            result[first + _ORDER : last + 1 - _ORDER] = np.diff(part, 2 * _ORDER, axis=0) / 4.0**_ORDER
    return result


def _smaller(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the smaller of two estimates (nh,) of the same, 0 if they differ in sign: then u has kinks."""
    return np.where(one * other > 0.0, np.sign(one) * np.minimum(np.abs(one), np.abs(other)), 0.0)
