"""Functions of time, load factor or arc length that declare their kinks."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves.curve import numbers, points
from beamfem.errors import InputError
from beamfem.reprs import brief
from beamfem.validation import function_of_one, positive


@dataclass(frozen=True)
class Interpolated:
    """Linear interpolation between given times or arc lengths, constant outside.

    Raises InputError for fewer than two points, or times that do not increase.

    Parameters
    ----------
    points : sequence of (float, float), (n, 2)
        Increasing times [s] or arc lengths [m], each with its value.

    Examples
    --------
    >>> ramp = bf.Interpolated([(0.0, 0.0), (0.5, 1.0)])
    >>> ramp(0.25), ramp(2.0)
    (0.5, 1.0)
    """

    points: Sequence[Sequence[float]] | np.ndarray

    __repr__ = brief

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", points("points", self.points))
        if len(self.points) < 2:
            raise InputError(f"points must be at least two pairs (time, value), got {len(self.points)}")
        if np.any(np.diff(self._table[0]) <= 0.0):
            raise InputError("points must have increasing times")

    @cached_property
    def _table(self) -> np.ndarray:
        return np.array(self.points).T

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times [s] or arc lengths [m] (n,) of the points, where the slope jumps."""
        return tuple(self._table[0].tolist())

    def __call__(self, time: float) -> float:
        return float(np.interp(time, *self._table))


@dataclass(frozen=True)
class Piecewise:
    """A function that is smooth between kinks, at which its slope or value may jump.

    For a section or a load along a beam it depends on the arc length, and elements end at the kinks. Any function with
    an attribute `kinks` works in the same way. Raises InputError for kinks that do not increase.

    Parameters
    ----------
    function : callable
        Function of time [s] or arc length [m].
    kinks : sequence of float, (n,)
        Increasing times [s] or arc lengths [m] of the kinks.

    Examples
    --------
    >>> pulse = bf.Piecewise(lambda time: 1.0 if time < 0.1 else 0.0, kinks=[0.1])
    >>> pulse(0.05), pulse(0.2)
    (1.0, 0.0)
    """

    function: Callable[[float], Any]
    kinks: Sequence[float] | np.ndarray

    __repr__ = brief

    def __post_init__(self) -> None:
        function_of_one("function", self.function, "time or arc length")
        object.__setattr__(self, "kinks", kinks_of(self))

    def __call__(self, time: float) -> Any:
        return self.function(time)


@dataclass(frozen=True)
class Integral:
    """The integral of a function, or of a constant, from 0 to a time [s], accurate to round-off."""

    function: Callable[[float], float] | float

    @property
    def kinks(self) -> tuple[float, ...]:
        """The kinks of the function."""
        return kinks_of(self.function)

    def __call__(self, time: float) -> float:
        return float(self.course(np.array([time]))[0])

    def course(self, times: np.ndarray) -> np.ndarray:
        """Return the integrals (n,) to times (n,) [s], each from that to the time before it."""
        if not callable(self.function):
            return self.function * times
        kinks = self.kinks
        return np.cumsum([self._between(*ends, kinks) for ends in pairwise([0.0, *times.tolist()])])

    def _between(self, start: float, end: float, kinks: tuple[float, ...]) -> float:
        """Return the integral between two times [s]."""
        from scipy.integrate import quad  # slow to import and rarely needed

        assert callable(self.function)
        length = end - start
        inside = [kink for kink in kinks if min(start, end) < kink < max(start, end)]
        ends = [start, *sorted(inside, reverse=length < 0.0), end]
        size = max(abs(self.function(start + share * length)) for share in _SHARES)
        # full_output: no warning where the function itself has no more digits
        options = {"epsabs": _ACCURATE * abs(length) * size, "epsrel": _ACCURATE, "limit": _PARTS, "full_output": True}
        return float(sum(quad(self.function, *part, **options)[0] for part in pairwise(ends)))


_SHARES = 0.21, 0.48, 0.77, 1.0  # of a time, at which the size of a function is found
_ACCURATE, _PARTS = 1e-13, 500  # of the size of the integral, and most intervals


def kinks_of(function: Any) -> tuple[float, ...]:
    """Return the times [s] or arc lengths [m] of the kinks that a function declares, if any. Raises InputError."""
    kinks = numbers("kinks", getattr(function, "kinks", ()))
    if any(later <= earlier for earlier, later in pairwise(kinks)):
        raise InputError(f"kinks must be increasing times, got {kinks}")
    return kinks


def sine(frequency: float, size: float = 1.0, phase: float = 0.0, mean: float = 0.0) -> Callable[[float], float]:
    """Return size sin(2 pi frequency t + phase) + mean; frequency [Hz], phase [rad]."""
    positive("frequency", frequency)
    return lambda t: float(mean + size * np.sin(2.0 * np.pi * frequency * t + phase))


def smooth_ramp(duration: float, size: float = 1.0, start: float = 0.0) -> Callable[[float], float]:
    """Return size (10 s^3 - 15 s^4 + 6 s^5) with s = (t - start) / duration within [0, 1]."""
    positive("duration", duration)

    def ramp(t: float) -> float:
        s = min(max((t - start) / duration, 0.0), 1.0)
        return size * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)

    return ramp
