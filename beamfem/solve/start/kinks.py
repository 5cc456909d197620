"""Where functions of the load factor bend or turn: kinks that they declare, and what samples of their values show."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from beamfem.solve.start.functions_of_time import FunctionOfTime

_SAMPLES = 129
_PARTS = 9  # of the two intervals beside a kink, into which they are divided again and again
_REFINED = 12  # times: to 1e-9 of the range
_SHARP = 0.5  # of a jump of the slope that is left at a kink when its surroundings shrink; it would vanish elsewhere
_NOTABLE = 1e-3  # of the largest slope: a smaller jump is none
SAME = 1e-7  # of the range: kinks closer than this are one


def kinks_between(functions: Sequence[FunctionOfTime], begin: float, end: float, jumps: bool = True) -> list[float]:
    """Return the load factors between two others at which functions have kinks, from `begin` on.

    They are declared, or found where the slope jumps however close one looks; jumps: whether values may jump there.
    """
    low, high = sorted((begin, end))
    found: list[float] = []
    for function in functions:
        kinks = [kink for kink in function.kinks if low < kink < high] or _jumps_of_slope(function, low, high)
        found += [kink for kink in kinks if jumps or not _value_jumps(function, kink, high - low)]
    return _apart(found, begin, end)


def _value_jumps(function: FunctionOfTime, at: float, span: float) -> bool:
    """Return whether a function changes as much within 1e-6 of a span as within 1e-3 of it."""
    near, far = (abs(function.at(at + d * span) - function.at(at - d * span)) for d in (1e-6, 1e-3))
    return near > 0.1 * far > 0.0


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
        left, right, first = float(at[i]), float(at[i + 2]), float(jumps[i])
        last = first
        for _ in range(_REFINED):
            inner = np.linspace(left, right, _PARTS)
            slope = np.diff(_values(function, inner)) / np.diff(inner)
            jump = np.abs(np.diff(slope))
            k = int(np.argmax(jump))
            last = float(jump[k])
            if last < _SHARP * first:
                break
            left, right = float(inner[k]), float(inner[k + 2])
        else:
            found.append(_meeting(function, left, right))
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
