"""Jumps of a function of the arc length: declared by the function, or found by bisection."""

from collections.abc import Callable
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.time_functions import kinks_of

_STANDS_OUT = 1.25  # ratio of the change in an interval to the smaller one beside it, above which it is bisected
_SMALLEST = 1e-9  # smallest change that counts as a jump, relative to the largest value
_CLOSE = 1e-12  # of the length: accuracy of a jump
_MOST = 1000  # jumps between two samples: a function with more is noise


def find_jumps(
    name: str, function: Any, values: Callable[[float], np.ndarray], length: float, samples: int
) -> tuple[float, ...]:
    """Return the arc lengths (nj,) [m] within (0, length) that a function declares as `kinks`, or at which it jumps.

    values: the relevant numbers (k,) of the function's result at an arc length. Declared kinks are not checked.
    Otherwise each of `samples` equal intervals whose end values differ by more than those of its neighbours is
    bisected: a change that does not decrease with the interval is a jump. A change that reverses within an interval is
    not detected. Raises InputError, with the name of the function, if it returns other values when it is called again,
    or jumps everywhere.
    """
    if hasattr(function, "kinks"):
        near = _CLOSE * length
        return tuple(kink for kink in kinks_of(function) if near < kink < length - near)
    at = np.linspace(0.0, length, samples + 1)
    sampled = np.array([values(s) for s in at.tolist()])
    for i in (0, samples // 2, samples):
        if not np.array_equal(values(float(at[i])), sampled[i], equal_nan=True):
            raise InputError(f"{name} returns other values each time it is called for the arc length {at[i]:g}")
    largest = np.abs(sampled).max(axis=0)
    unit = np.where(largest > 0.0, largest, 1.0)
    sampled = sampled / unit
    change = np.abs(np.diff(sampled, axis=0)).max(axis=1)
    beside = np.minimum(np.append(change[1:], np.inf), np.append(np.inf, change[:-1]))
    if samples == 1:
        beside = np.zeros(1)
    part = _Part(name, lambda s: values(s) / unit, _CLOSE * length)
    jumps: list[float] = []
    for i in np.flatnonzero((change > _SMALLEST) & (change > _STANDS_OUT * beside)).tolist():
        jumps += part.jumps(float(at[i]), sampled[i], float(at[i + 1]), sampled[i + 1])
    return tuple(jumps)


class _Part:
    """Bisection of a function between two arc lengths [m] down to a distance `close` [m]."""

    def __init__(self, name: str, values: Callable[[float], np.ndarray], close: float) -> None:
        self.name, self.values, self.close, self.count = name, values, close, 0

    def jumps(self, low: float, at_low: np.ndarray, high: float, at_high: np.ndarray) -> list[float]:
        """Return all jumps between two arc lengths with known values, in ascending order."""
        begin, end = (low, at_low), (high, at_high)
        last_change = change = _size(at_low, at_high)
        halvings = 0
        while high - low > self.close:
            middle = 0.5 * (low + high)
            between = self.values(middle)
            if _size(at_low, between) > _size(between, at_high):
                high, at_high = middle, between
            else:
                low, at_low = middle, between
            change, halvings = _size(at_low, at_high), halvings + 1
            if change <= _SMALLEST:
                return []
            if halvings % 4 == 0:
                # the change of a smooth function has decreased to about 1/16 since the last check
                if change < last_change / 8.0:
                    return []
                last_change = change
        self.count += 1
        if self.count > _MOST:
            raise InputError(
                f"{self.name} has jumps everywhere near the arc length {low:g}; a function of the arc length has "
                "pieces in which it is continuous"
            )
        before = self.jumps(*begin, low, at_low) if _size(begin[1], at_low) > _SMALLEST else []
        after = self.jumps(high, at_high, *end) if _size(at_high, end[1]) > _SMALLEST else []
        return [*before, 0.5 * (low + high), *after]


def _size(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(one - other).max())
