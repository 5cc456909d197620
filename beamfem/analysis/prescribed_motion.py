"""Prescribed coordinates at the ends of time steps: values, velocities, and accelerations that keep the momentum."""

import numpy as np

from beamfem.errors import InputError
from beamfem.model.sampled import Sampled
from beamfem.model.system import System

_WIDTH = 0.02  # of a step, of the differences that give velocities
# weights of the first derivative inside, and of the first and third at an end, where nothing is asked outside
_INSIDE = np.array([-2, -1, 1, 2]), np.array([1, -8, 8, -1]) / 12.0
_AT_END = np.arange(5), np.array([-25, 48, -36, 16, -3]) / 12.0, np.array([-5, 18, -24, 14, -3]) / 2.0


def prescribed_motion(system: System, ends: np.ndarray) -> np.ndarray:
    """Return values, velocities and accelerations (m + 1, 3, nh) of the held coordinates at times (m + 1,) [s].

    An acceleration is the mean of u'' under the hat that is 1 at the end of a step and 0 at those beside it: the change
    of the mean velocity from the step before to the step after, over the mean of both steps. So its sum over the steps
    is the change of the velocity, whatever u is between, and where u is smooth, the mean differs from u'' in second
    order. At the first and last time it is the half of the hat that lies inside, corrected for u''' where u is smooth.
    Raises InputError for motions that are known by values only.
    """
    if any(isinstance(item.value, Sampled) for item in system.held):
        raise InputError(
            "a prescribed motion of this model was saved as values, which have no accelerations between them; "
            "give the function again to run it on"
        )
    values = np.zeros((len(ends), 3, len(system.held)))
    if not any(callable(item.value) for item in system.held):
        values[:, 0] = system.held_values(0.0)
        return values
    steps = np.diff(ends)
    reference = system.reference[system.held_dofs]  # differences of displacements, not of positions far away
    values[:, 0] = [system.held_values(time) for time in ends]
    moved = values[:, 0] - reference
    mean = np.diff(moved, axis=0) / steps[:, None]
    width = _WIDTH * np.minimum(steps[:-1], steps[1:])
    for i, time in enumerate(ends[1:-1]):
        around = np.array([system.held_values(time + k * width[i]) - reference for k in _INSIDE[0]])
        values[i + 1, 1] = _INSIDE[1] @ around / width[i]
    values[1:-1, 2] = np.diff(mean, axis=0) / (0.5 * (steps[:-1] + steps[1:]))[:, None]
    for end, inward, step in ((0, 1, steps[0]), (-1, -1, -steps[-1])):
        width = _WIDTH * step
        near = np.array([system.held_values(ends[end] + k * width) - reference for k in _AT_END[0]])
        velocity, third = _AT_END[1] @ near / width, _AT_END[2] @ near / width**3
        half = 2.0 * (mean[end] - velocity) / step
        beside = values[end + inward, 2] if len(steps) > 1 else half
        values[end, 1] = velocity
        values[end, 2] = half - _smaller(step * third / 3.0, 0.5 * (beside - half))
    return values


def _smaller(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the smaller of two estimates (nh,) of the same, 0 where they differ in sign: then u has kinks."""
    return np.where(one * other > 0.0, np.sign(one) * np.minimum(np.abs(one), np.abs(other)), 0.0)
