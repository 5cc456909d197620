"""Functions of time, or of the load factor, that a model file can describe."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.curves.curve import points
from beamfem.errors import InputError
from beamfem.validation import finite, positive


@dataclass(frozen=True)
class Interpolated:
    """Values at increasing times, points (n, 2): linear between them, constant before and after. Raises InputError."""

    points: Sequence[Sequence[float]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", points("points", self.points))
        if len(self.points) < 2:
            raise InputError(f"points must be at least two pairs (time, value), got {len(self.points)}")
        if np.any(np.diff(self._table[:, 0]) <= 0.0):
            raise InputError("points must have increasing times")

    @property
    def _table(self) -> np.ndarray:
        return np.array(self.points)

    @property
    def smooth(self) -> bool:
        """Whether the second derivative exists everywhere."""
        return False

    def __call__(self, time: float) -> float:
        return float(np.interp(time, *self._table.T))


@dataclass(frozen=True)
class Sine:
    """size sin(2 pi frequency t + phase) + mean; frequency [Hz], phase [rad]. Raises InputError."""

    frequency: float
    size: float = 1.0
    phase: float = 0.0
    mean: float = 0.0

    def __post_init__(self) -> None:
        positive("frequency", self.frequency)
        for name in ("size", "phase", "mean"):
            finite(name, getattr(self, name))

    @property
    def smooth(self) -> bool:
        return True

    def __call__(self, time: float) -> float:
        return float(self.mean + self.size * np.sin(2.0 * np.pi * self.frequency * time + self.phase))


@dataclass(frozen=True)
class SmoothRamp:
    """From 0 at the time `start` to `size` after a `duration`, with no jump in rate or acceleration at either end.

    size (10 s^3 - 15 s^4 + 6 s^5), s = (t - start) / duration within [0, 1]. Raises InputError.
    """

    duration: float
    size: float = 1.0
    start: float = 0.0

    def __post_init__(self) -> None:
        positive("duration", self.duration)
        for name in ("size", "start"):
            finite(name, getattr(self, name))

    @property
    def smooth(self) -> bool:
        return True

    def __call__(self, time: float) -> float:
        s = min(max((time - self.start) / self.duration, 0.0), 1.0)
        return self.size * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


FUNCTIONS = {"table": Interpolated, "sine": Sine, "smooth-ramp": SmoothRamp}
