"""Functions of time or load factor that act on a model: their kinks, and whether rows or steps resolve them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from beamfem.equations.system import System
from beamfem.errors import warn
from beamfem.model.beam import Beam, beam_in_words
from beamfem.model.load_base import Load, MovingLoad
from beamfem.model.model import Model
from beamfem.model.time_functions import Integral, Piecewise, kinks_of
from beamfem.validation import function_value

# of a step, at which a function is evaluated; unequal, so that few oscillations are missed
_SHARES = np.array([0.21, 0.48, 0.77])
# of a step in statics, which may be far too long at first
_MANY_SHARES = np.append(0.5 * (np.sqrt(5.0) - 1.0) * np.arange(1, 16) % 1.0, 0.5 ** np.arange(2, 24))
_LOOKS = 1024  # samples of a motion
_ABRUPT = 2.0  # times the changes between the samples before and after: those between which a function may jump
_OFTEN = 4  # turns
_WIDTHS = np.arange(-3.0, 4.0)  # of a pulse: where steps end, which are short enough there to see it
_BULGE = 0.1  # of the scale of a function; an oscillation with seven steps per period stays below


@dataclass(frozen=True)
class FunctionOfTime:
    """A function of time that acts on a model, its description, and whether it is an amplitude or a motion.

    found, turns [s]: see `sampled`.
    """

    name: str
    function: Callable[[float], float]
    amplitude: bool
    found: tuple[float, ...] = ()
    turns: tuple[float, ...] = ()

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times [s] of the kinks that it declares, or of those that were found."""
        return kinks_of(self.function) or self.found

    def at(self, time: float) -> float:
        """Return its value at a time [s], in statics a load factor. Raises InputError if it has none."""
        return function_value(self.name, self.function, time)

    def look(self, times: np.ndarray, side: float) -> tuple[np.ndarray, float]:
        """Return for each step (m,) between times (m + 1,) [s] whether it varies more within it than between its ends.

        Also return its scale, the largest value of an amplitude or the range of a motion. side [s]: distance from the
        ends of a step at which it is evaluated if it declares kinks, at which it may jump.
        """
        low = high = self.values(times)
        if side and self.kinks:
            low = np.append(self.values(times[:-1] + side), high[-1])
            high = np.append(high[0], self.values(times[1:] - side))
        inner = self.values((times[:-1, None] + np.diff(times)[:, None] * _SHARES).ravel()).reshape(-1, len(_SHARES))
        above = inner.max(axis=1) - np.maximum(low[:-1], high[1:])
        below = np.minimum(low[:-1], high[1:]) - inner.min(axis=1)
        size = self._size(np.concatenate([low, high, inner.ravel()]))
        return np.maximum(above, below) > _BULGE * size, size

    def bend(self, begin: float, end: float) -> float:
        """Return its largest deviation from the straight line between two times [s]."""
        low, high = self.at(begin), self.at(end)
        return max(abs(self.at(begin + s * (end - begin)) - (1.0 - s) * low - s * high) for s in _SHARES.tolist())

    def bulges(self, begin: float, end: float) -> bool:
        """Return whether it varies more between two times or load factors than its values there tell."""
        low, high = sorted((begin, end))
        kinks = [time for time in self.kinks if low < time < high]
        inner = self.values(np.append(begin + (end - begin) * _MANY_SHARES, kinks))
        ends = self.values(np.array([begin, end]))
        beyond = max(inner.max() - ends.max(), ends.min() - inner.min())
        return bool(beyond > _BULGE * self._size(np.append(inner, ends)))

    def _size(self, values: np.ndarray) -> float:
        return float(np.abs(values).max() if self.amplitude else np.ptp(values))

    def values(self, times: np.ndarray) -> np.ndarray:
        """Return its values at times (n,) [s], without the checks of `at` unless one fails."""
        try:
            if isinstance(self.function, Integral):
                values = self.function.course(times)
            else:
                values = np.array([self.function(time) for time in times.tolist()], dtype=float)
        except Exception:  # `at` reports which value it was
            values = np.full(len(times), np.nan)
        if values.shape == times.shape and np.isfinite(values).all():
            return values
        return np.array([self.at(time) for time in times.tolist()])


def functions_of_time(system: System) -> list[FunctionOfTime]:
    """Return every function of time that acts on the model of a system, each once."""
    if system.steady:
        return []
    model = system.model
    by_id: dict[int, FunctionOfTime] = {}
    for load in model.loads:
        amplitude = load.amplitude  # a method is a new object at each access
        if amplitude is not None:
            by_id.setdefault(id(amplitude), FunctionOfTime(f"amplitude of {_name(load, model)}", amplitude, True))
        if isinstance(load, MovingLoad):
            by_id[id(load)] = FunctionOfTime(f"presence of {_name(load, model)}", load.presence, True)
    for item in system.prescribed:
        if callable(item.value):
            by_id.setdefault(id(item.value), FunctionOfTime(f"motion prescribed by {item.source}", item.value, False))
    for item in () if system.static else system.connectors.items:  # the number of kinks so far jumps at each of them
        if kinks := getattr(item.item, "kinks", ()):
            by_id[id(item.item)] = FunctionOfTime(f"function of {item.name}", Piecewise(_count_of(kinks), kinks), True)
    return list(by_id.values())


def _count_of(kinks: Sequence[float]) -> Callable[[float], float]:
    """Return the function of time [s] that counts kinks so far."""
    return lambda time: float(np.searchsorted(kinks, time, "right"))


def sampled(function: FunctionOfTime, end: float) -> FunctionOfTime:
    """Return an amplitude that declares no kinks with the jumps and the turns that samples until a time [s] show.

    Steps that follow a tolerance would go over a pulse, and a jump between two of their stages, without seeing it. A
    function that turns often is seen by all steps.
    """
    if not function.amplitude or function.kinks:
        return function
    at = np.linspace(0.0, end, _LOOKS + 1)
    values = function.values(at)
    change, size = np.diff(values), float(np.ptp(values))
    padded = np.abs(np.concatenate([change[1:2], change, change[-2:-1]]))
    abrupt = np.abs(change) > _ABRUPT * np.minimum(padded[:-2], padded[2:]) + _LEAST * size
    near = [(float(at[i]), float(at[i + 1])) for i in np.flatnonzero(abrupt).tolist()]
    jumps = [_jump(function, low, high, _LEAST * size) for low, high in near]
    found = tuple(jump.after for jump in jumps if jump is not None)
    turning = np.flatnonzero(change[1:] * change[:-1] < 0.0) + 1
    if found or len(turning) > _OFTEN:
        return replace(function, found=found)
    width = (at[1] - at[0]) * np.sqrt(2.0 * size / np.abs(change[turning] - change[turning - 1]))
    return replace(function, turns=tuple(np.sort((at[turning] + width * _WIDTHS[:, None]).ravel()).tolist()))


def _name(load: Load, model: Model) -> str:
    kind, place = type(load).__name__, load.place
    if isinstance(place, Beam):
        return f"{kind} on {beam_in_words(model.beams, model.number_of(place))}"
    return kind if place is None else f"{kind} at {place}"


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
    """A jump of a function: neighbouring load factors, in ascending order, and its values there."""

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
        values = function.values(np.array([*np.linspace(low, high, 9), *places, *chain(*around)]))
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


def _extremes(function: FunctionOfTime, begin: float, end: float) -> list[float]:
    """Return where a function that is smooth between two load factors turns, to the accuracy that its values allow."""
    from scipy.optimize import minimize_scalar  # slow to import and rarely needed

    at = np.linspace(begin, end, _SAMPLES)[1:-1]  # at its ends the function may jump
    values = function.values(at)
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
    values = function.values(at)
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
    change = np.diff(np.diff(function.values(inner)) / np.diff(inner))
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
    a, b, c, d = function.values(np.array([left - width, left, right, right + width])).tolist()
    before, after = (b - a) / width, (d - c) / width
    middle = 0.5 * (left + right)
    if before == after:
        return middle
    meeting = left + (c - b - after * width) / (before - after)
    return float(meeting) if left <= meeting <= right else middle


def name_unresolved(functions: list[FunctionOfTime], ends: np.ndarray, side: float, second: str) -> list[str]:
    """Warn of every function that varies more within a step than between its ends (m + 1,) [s]; return their names.

    second: the unit of time.
    """
    names = []
    for function, first, count in _unresolved(functions, ends, side):
        names.append(function.name)
        warn(
            f"the {function.name} varies more within the step from {ends[first]:.6g} {second} to "
            f"{ends[first + 1]:.6g} {second} than between its ends, where steps take it ({count} such steps): what "
            "happens in between is not resolved. Take smaller steps, or let an amplitude declare its kinks, as "
            "Piecewise does",
        )
    return names


def warn_between_rows(functions: list[FunctionOfTime], rows: np.ndarray, side: float) -> tuple[str, ...]:
    """Warn of functions that vary more between load factors of rows (m,) than at them; return the sentences."""
    sentences = tuple(
        f"the {function.name} varies more between load factors {rows[first]:.6g} and {rows[first + 1]:.6g} than at "
        "them, where the solve takes it. Take more steps, or let it declare its kinks, as Piecewise does"
        for function, first, _ in _unresolved(functions, rows, side)
    )
    for sentence in sentences:
        warn(sentence)
    return sentences


def _unresolved(
    functions: list[FunctionOfTime], ends: np.ndarray, side: float
) -> list[tuple[FunctionOfTime, int, int]]:
    """Return the functions that vary more between `ends` than at them, with the first interval and their number."""
    steps = [function.look(ends, side)[0] for function in functions]
    found = zip(functions, steps, strict=True)
    return [(function, int(np.argmax(own)), int(own.sum())) for function, own in found if own.any()]
