"""Functions of time, or of the load factor, that act on a model."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.assembly.system import System
from beamfem.model.beam import Beam
from beamfem.model.beam_names import beam_in_words
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.model.time_functions import kinks_of
from beamfem.validation import function_value

# of a step, at which a function is evaluated; unequal, so that few oscillations are missed
_SHARES = np.array([0.21, 0.48, 0.77])
# of a step in statics, which may be far too long at first
_MANY_SHARES = np.append(0.5 * (np.sqrt(5.0) - 1.0) * np.arange(1, 16) % 1.0, 0.5 ** np.arange(2, 24))
_BULGE = 0.1  # of the scale of a function; an oscillation with seven steps per period stays below


@dataclass(frozen=True)
class FunctionOfTime:
    """A function of time that acts on a model, its description, and whether it is an amplitude or a motion."""

    name: str
    function: Callable[[float], float]
    amplitude: bool

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times [s] of the kinks that it declares."""
        return kinks_of(self.function)

    def at(self, time: float) -> float:
        """Return its value at a time [s], in statics a load factor. Raises InputError if it has none."""
        return function_value(self.name, self.function, time)

    def look(self, times: np.ndarray, side: float) -> tuple[np.ndarray, float]:
        """Return for each step (m,) between times (m + 1,) [s] whether it varies more within it than between its ends.

        Also return its scale, the largest value of an amplitude or the range of a motion. side [s]: distance from the
        ends of a step at which it is evaluated if it declares kinks, at which it may jump.
        """
        inset = side if self.kinks else 0.0
        low = high = self._values(times)
        if inset:
            low = np.append(self._values(times[:-1] + inset), high[-1])
            high = np.append(high[0], self._values(times[1:] - inset))
        inner = self._values((times[:-1, None] + np.diff(times)[:, None] * _SHARES).ravel()).reshape(-1, len(_SHARES))
        above = inner.max(axis=1) - np.maximum(low[:-1], high[1:])
        below = np.minimum(low[:-1], high[1:]) - inner.min(axis=1)
        every = np.concatenate([low, high, inner.ravel()])
        size = self._size(every)
        return np.maximum(above, below) > _BULGE * size, size

    def bulges(self, begin: float, end: float) -> bool:
        """Return whether it varies more between two times or load factors than its values there tell."""
        low, high = sorted((begin, end))
        kinks = [time for time in self.kinks if low < time < high]
        inner = self._values(np.append(begin + (end - begin) * _MANY_SHARES, kinks))
        ends = self._values(np.array([begin, end]))
        beyond = max(inner.max() - ends.max(), ends.min() - inner.min())
        return bool(beyond > _BULGE * self._size(np.append(inner, ends)))

    def _size(self, values: np.ndarray) -> float:
        return float(np.abs(values).max() if self.amplitude else np.ptp(values))

    def _values(self, times: np.ndarray) -> np.ndarray:
        """Return its values at times (n,) [s], without the checks of `at` unless one fails."""
        try:
            values = np.array([self.function(time) for time in times.tolist()], dtype=float)
        except Exception:  # `at` reports which value it was
            values = np.full(len(times), np.nan)
        if values.shape == times.shape and np.isfinite(values).all():
            return values
        return np.array([self.at(time) for time in times.tolist()])

    def bend(self, begin: float, end: float) -> float:
        """Return its largest deviation from the straight line between two times [s]."""
        low, high = self.at(begin), self.at(end)
        return max(abs(self.at(begin + s * (end - begin)) - (1.0 - s) * low - s * high) for s in _SHARES.tolist())


def functions_of_time(system: System) -> list[FunctionOfTime]:
    """Return every function of time that acts on the model of a system, each once."""
    if system.proportional and not system.moved:
        return []
    model = system.model
    by_id: dict[int, FunctionOfTime] = {}
    for load in model.loads:
        amplitude = load.amplitude  # a method is a new object at each access
        if amplitude is not None:
            by_id.setdefault(id(amplitude), FunctionOfTime(f"amplitude of {_name(load, model)}", amplitude, True))
    for item in system.prescribed:
        if callable(item.value):
            by_id.setdefault(id(item.value), FunctionOfTime(f"motion prescribed at {item.point}", item.value, False))
    return list(by_id.values())


def _name(load: Load, model: Model) -> str:
    kind, place = type(load).__name__, load.place
    if isinstance(place, Beam):
        return f"{kind} on {beam_in_words(model.beams, model.number_of(place))}"
    return kind if place is None else f"{kind} at {place}"
