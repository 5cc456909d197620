"""Prescribed coordinates at the ends of time steps: values, velocities, and momentum-consistent accelerations."""

from itertools import pairwise

import numpy as np

from beamfem.equations.model_coordinates import PrescribedCoordinate
from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.model.sampled_functions import Sampled
from beamfem.model.time_functions import Integral
from beamfem.validation import function_value

_ORDER = 4  # of the filter
_WIDTH = 0.02  # of a step: width of the differences that give velocities
# weights of the first derivative inside, and of the first and third at an end, from values inside only
_INSIDE = np.array([-2, -1, 1, 2]), np.array([1, -8, 8, -1]) / 12.0
_MEAN = np.array([-1, 4, 4, -1]) / 6.0  # of rates there, in the middle
_AT_END = np.arange(5), np.array([-25, 48, -36, 16, -3]) / 12.0, np.array([-5, 18, -24, 14, -3]) / 2.0


def prescribed_motion(system: System, ends: np.ndarray) -> np.ndarray:
    """Return values, velocities and accelerations (m + 1, 3, nh) of the prescribed coordinates at times (m + 1,) [s].

    An acceleration is the mean of u'' weighted by the hat function that is 1 at the end of a step and 0 at the adjacent
    ends: the change of the mean velocity from the step before to the step after, over the mean of both steps. Its sum
    over the steps is therefore the change of the velocity, whatever u is in between, and for smooth u it differs from
    u'' in second order. At the first and last time the half of the hat inside is taken, corrected for u''' if u is
    smooth. Values are u without the part that alternates from step to step, which would make stiff parts of a model
    oscillate. Raises InputError for motions that are known by values only.
    """
    if any(isinstance(item.value, Sampled) for item in system.prescribed):
        raise InputError(
            "a prescribed motion of this model was saved as values, which have no accelerations between them; "
            "give the function again to continue it"
        )
    values = np.zeros((len(ends), 3, len(system.prescribed)))
    if not any(callable(item.value) for item in system.prescribed):
        values[:, 0] = system.prescribed_values(0.0)
        return values
    steps = np.diff(ends)
    # more accurate than positions far from the origin
    moved = system.prescribed_course(ends)
    values[:, 0] = system.reference[system.prescribed_dofs] + moved - _unresolved(moved, steps)
    mean = np.diff(moved, axis=0) / steps[:, None]
    width = _WIDTH * np.minimum(steps[:-1], steps[1:])
    for column, item in enumerate(system.prescribed):
        if callable(item.value):
            values[1:-1, 1, column] = _rates(item, ends[1:-1, None] + width[:, None] * _INSIDE[0], width)
    values[1:-1, 2] = np.diff(mean, axis=0) / (0.5 * (steps[:-1] + steps[1:]))[:, None]
    for end, inward, step in ((0, 1, steps[0]), (-1, -1, -steps[-1])):
        width = _WIDTH * step
        near = system.prescribed_course(ends[end] + width * _AT_END[0])
        velocity, third = _AT_END[1] @ near / width, _AT_END[2] @ near / width**3
        half = 2.0 * (mean[end] - velocity) / step
        beside = values[end + inward, 2] if len(steps) > 1 else half
        values[end, 1] = velocity
        values[end, 2] = half - _smaller(step * third / 3.0, 0.5 * (beside - half))
    return values


def _rates(item: PrescribedCoordinate, around: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return the velocities (m,) of a prescribed coordinate by differences of its values at times (m, 4) around."""
    if isinstance(item.value, Integral) and callable(item.value.function):
        function = item.value.function
        rates = [[function_value(item.name, function, time) for time in times] for times in around.tolist()]
        return np.array(rates).reshape(-1, len(_MEAN)) @ _MEAN
    return item.course(around.ravel()).reshape(around.shape) @ _INSIDE[1] / width


def _unresolved(moved: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Return the part of motions (m + 1, nh) that changes its sign from step to step, for equal steps (m,).

    It is (-D / 4)^4 u with second differences D (Shapiro 1970): the whole of an alternating motion, and (w h / 2)^8 of
    an oscillation of angular frequency w. A corner with a velocity jump dv is rounded by at most 0.08 h dv.
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
    """Return the smaller of two estimates (nh,), or 0 if they differ in sign, since u then has kinks."""
    return np.where(one * other > 0.0, np.sign(one) * np.minimum(np.abs(one), np.abs(other)), 0.0)
