"""What acts in time, and whether the steps resolve it."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.assembly.system import System
from beamfem.model.beam import Beam
from beamfem.model.load import Load
from beamfem.model.model import Model
from beamfem.model.named import beam_in_words
from beamfem.model.time_functions import kinks_of
from beamfem.validation import function_value

_SHARES = np.array([0.21, 0.48, 0.77])  # of a step, where it is looked at; unequal, so that few oscillations hide
_BULGE = 0.1  # of what a course is measured by; what is resolved by seven steps a period stays below


@dataclass(frozen=True)
class Course:
    """A function of time that acts on a model, what it is in words, and whether it is an amplitude or a motion."""

    name: str
    function: Callable[[float], float]
    amplitude: bool

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times [s] of the kinks that it declares."""
        return kinks_of(self.function)

    def at(self, time: float) -> float:
        """Return its value at a time [s]. Raises InputError if it has none."""
        return function_value(self.name, self.function, time)

    def look(self, times: np.ndarray, side: float) -> tuple[np.ndarray, float]:
        """Tell of each step between times (m + 1,) [s] whether it varies more within than between its ends.

        Return that (m,) and what it is measured by, the largest value of an amplitude or the range of a motion.
        side [s]: how far inside a step the value at its end is taken where kinks are declared, at which it may jump.
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
        size = float(np.abs(every).max() if self.amplitude else np.ptp(every))
        return np.maximum(above, below) > _BULGE * size, size

    def _values(self, times: np.ndarray) -> np.ndarray:
        """Return its values at times (n,) [s], without the care for each that `at` takes unless one asks for it."""
        try:
            values = np.array([self.function(time) for time in times.tolist()], dtype=float)
        except Exception:  # `at` tells which value it was
            values = np.full(len(times), np.nan)
        if values.shape == times.shape and np.isfinite(values).all():
            return values
        return np.array([self.at(time) for time in times.tolist()])

    def bend(self, begin: float, end: float) -> float:
        """Return how far it leaves the straight line between two times [s]."""
        low, high = self.at(begin), self.at(end)
        return max(abs(self.at(begin + s * (end - begin)) - (1.0 - s) * low - s * high) for s in _SHARES.tolist())


def courses(system: System) -> list[Course]:
    """Return every function of time that acts on the model of a system, each once."""
    model = system.model
    found: dict[int, Course] = {}
    for load in model.loads:
        amplitude = load.amplitude  # a method is another object each time
        if amplitude is not None:
            found.setdefault(id(amplitude), Course(f"amplitude of {_name(load, model)}", amplitude, True))
    for item in system.prescribed:
        if callable(item.value):
            found.setdefault(id(item.value), Course(f"motion prescribed at {item.point}", item.value, False))
    return list(found.values())


def name_unresolved(courses: list[Course], ends: np.ndarray, side: float, second: str) -> list[str]:
    """Warn of every course that varies more within a step than between its ends (m + 1,) [s]; return their names.

    second: the unit of time.
    """
    found = []
    for course in courses:
        bulging, _ = course.look(ends, side)
        if bulging.any():
            first = int(np.argmax(bulging))
            found.append(course.name)
            warnings.warn(
                f"the {course.name} varies more within the step from {ends[first]:.6g} {second} to "
                f"{ends[first + 1]:.6g} {second} than between its ends, where steps take it ({int(bulging.sum())} "
                "such steps): what happens in between is lost. Take smaller steps, or let an "
                "amplitude declare its kinks, as Piecewise does",
                stacklevel=3,
            )
    return found


def _name(load: Load, model: Model) -> str:
    kind, place = type(load).__name__, load.place
    if isinstance(place, Beam):
        return f"{kind} on {beam_in_words(model.beams, model.number_of(place))}"
    return kind if place is None else f"{kind} at {place}"
