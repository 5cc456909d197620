"""Where functions of the load factor bend or turn: kinks that they declare, and what samples of their values show."""

from collections.abc import Sequence
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from beamfem.solve.start.functions_of_time import FunctionOfTime

_SAMPLES = 129
_PARTS = 9  # of the two intervals beside a kink, into which they are divided again and again
_REFINED = 12  # times: to 1e-9 of the range
_DIVIDED = 3  # times, the first ones, at which several kinks are told apart
_SHARP = 0.5  # of a jump of the slope that is left at a kink when its surroundings shrink; it would vanish elsewhere
_NOTABLE = 1e-3  # of the largest slope: a smaller jump is none
_NEAR = 1e-8  # of the range: distance from a kink within which a function jumps there, if at all
_LEAST = 1e-6  # of the range of a function: a smaller jump is none
SAME = 1e-7  # of the range: kinks closer than this are one


class Jump(NamedTuple):
    """Where a function jumps: neighbouring load factors, in ascending order, with its values there."""

    before: float
    after: float
    values: tuple[float, float]
    name: str


def kinks_between(functions: Sequence[FunctionOfTime], begin: float, end: float) -> list[float]:
    """Return the load factors between two others at which functions have kinks, from `begin` on.

    They are declared, or found where the slope jumps however close one looks.
    """
    low, high = sorted((begin, end))
    return _apart([kink for function in functions for kink in _kinks(function, low, high)], begin, end)


def _kinks(function: FunctionOfTime, low: float, high: float) -> list[float]:
    return [kink for kink in function.kinks if low < kink < high] or _jumps_of_slope(function, low, high)


def jumps_between(functions: Sequence[FunctionOfTime], low: float, high: float) -> list[Jump]:
    """Return where functions jump from one number to the next between two load factors, in ascending order."""
    found: list[Jump] = []
    for function in functions:
        near, places = _NEAR * (high - low), (low, *_kinks(function, low, high), high)
        around = [(max(at - near, low), min(at + near, high)) for at in places]
        values = _values(function, np.array([*np.linspace(low, high, 9), *places, *chain(*around)]))
        jumps = [_jump(function, *ends, _LEAST * float(np.ptp(values))) for ends in around]
        # found from both sides of an end, a jump is one
        found += {jump.before: jump for jump in jumps if jump is not None}.values()
    return sorted(found)


def _jump(function: FunctionOfTime, low: float, high: float, least: float) -> Jump | None:
    """Return the jump between two load factors, None if values at neighbouring numbers differ by less than `least`."""
    first, last = function.at(low), function.at(high)
    if least == 0.0:
        return None
    while abs(last - first) > least and high - low > np.spacing(max(abs(low), abs(high), _NEAR)):
        middle = 0.5 * (low + high)
        between = function.at(middle)
        if abs(between - first) >= abs(last - between):
            high, last = middle, between
        else:
            low, first = middle, between
    return Jump(low, high, (first, last), function.name) if abs(last - first) > least else None


def kinks_and_turning_points(functions: Sequence[FunctionOfTime], begin: float, end: float) -> list[float]:
    """Return the load factors between two others at which functions have kinks or turn, from `begin` on."""
    found = kinks_between(functions, begin, end)
    for function in functions:
        pieces = [begin, *(kink for kink in function.kinks if begin < kink < end), end]
        found += [at for piece in pairwise(pieces) for at in _extremes(function, *piece)]
    return _apart(found, begin, end)


def _apart(found: list[float], begin: float, end: float) -> list[float]:
    """Return load factors from `begin` on, without those next to an earlier one or to an end."""
    result: list[float] = []
    for at in found:
        if all(abs(at - other) > SAME * abs(end - begin) for other in (*result, begin, end)):
            result.append(at)
    return sorted(result, key=lambda at: abs(at - begin))


def _values(function: FunctionOfTime, at: np.ndarray) -> np.ndarray:
    return np.array([function.at(x) for x in at.tolist()])


def _extremes(function: FunctionOfTime, begin: float, end: float) -> list[float]:
    """Return where a function that is smooth between two load factors turns, to the accuracy that its values allow."""
    from scipy.optimize import minimize_scalar  # slow to import and rarely needed

    at = np.linspace(begin, end, _SAMPLES)[1:-1]  # at its ends the function may jump
    values = _values(function, at)
    change = np.diff(values)
    rising = np.sign(np.where(np.abs(change) > 1e-12 * np.abs(values).max(), change, 0.0))
    found = []
    for i in np.flatnonzero(rising[1:] * rising[:-1] < 0.0).tolist():
        sign, bracket = float(-rising[i]), (float(at[i]), float(at[i + 2]))
        best = minimize_scalar(
            lambda x, sign=sign: sign * function.at(x), bounds=bracket, method="bounded", options={"xatol": 1e-10}
        )
        found.append(float(at[i + 1]) if sign * values[i + 1] <= best.fun else float(best.x))
    return found


def _jumps_of_slope(function: FunctionOfTime, low: float, high: float) -> list[float]:
    at = np.linspace(low, high, _SAMPLES)
    values = _values(function, at)
    slopes = np.diff(values) / np.diff(at)
    jumps = np.abs(np.diff(slopes))
    notable = _NOTABLE * float(np.abs(slopes).max(initial=0.0))
    found = []
    for i in np.flatnonzero(jumps > notable).tolist():
        found += _kinks_within(function, float(at[i]), float(at[i + 2]), float(jumps[i]), notable, _REFINED)
    return found


def _kinks_within(
    function: FunctionOfTime, left: float, right: float, first: float, notable: float, times: int
) -> list[float]:
    """Return the kinks of a narrow interval that is divided again and again, where its slope keeps its jump `first`.

    Jumps of different sign are different kinks, as those of a narrow peak.
    """
    if times == 0:
        return [_meeting(function, left, right)]
    inner = np.linspace(left, right, _PARTS)
    change = np.diff(np.diff(_values(function, inner)) / np.diff(inner))
    size = np.abs(change)
    if size.max() < _SHARP * first:
        return []
    kept = [int(np.argmax(size))]
    if times > _REFINED - _DIVIDED:  # round-off makes signs of its own where intervals are narrow
        runs = np.split(np.arange(len(change)), np.flatnonzero(np.diff(np.sign(change))) + 1)
        kept = [k for k in (int(run[np.argmax(size[run])]) for run in runs) if size[k] > notable] or kept
    found: list[float] = []
    for k in kept:
        own = first if len(kept) < 2 else float(size[k])
        found += _kinks_within(function, float(inner[k]), float(inner[k + 2]), own, notable, times - 1)
    return found


def _meeting(function: FunctionOfTime, left: float, right: float) -> float:
    """Return where the lines beside a narrow interval meet, or its middle if its values jump."""
    width = right - left
    x = np.array([left - width, left, right, right + width])
    a, b, c, d = _values(function, x).tolist()
    before, after = (b - a) / width, (d - c) / width
    middle = 0.5 * (left + right)
    if before == after:
        return middle
    meeting = left + (c - b - after * width) / (before - after)
    return float(meeting) if left <= meeting <= right else middle
