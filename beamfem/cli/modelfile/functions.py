"""Functions of time, load factor or arc length that a model file can describe."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.cli.modelfile.table import Kinds
from beamfem.model.time_functions import Interpolated, Piecewise, kinks_of
from beamfem.validation import finite, positive


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

    def __call__(self, time: float) -> float:
        s = min(max((time - self.start) / self.duration, 0.0), 1.0)
        return self.size * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


@dataclass(frozen=True)
class Components:
    """Components (x, y) of a load along a beam, each a number or a function of the arc length [m]."""

    parts: tuple[float | Callable[[float], float], ...]

    def __post_init__(self) -> None:
        for part in self.parts:
            if not callable(part):
                finite("vector", part)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Arc lengths [m] of the kinks of both."""
        return tuple(sorted({kink for part in self.parts for kink in kinks_of(part)}))

    def __call__(self, arc_length: float) -> tuple[float, ...]:
        return tuple(part(arc_length) if callable(part) else float(part) for part in self.parts)


FUNCTIONS: Kinds = {"table": Interpolated, "piecewise": Piecewise, "sine": Sine, "smooth-ramp": SmoothRamp}
