"""What loads have in common: a factor in time, and values that may vary along a beam."""

from collections.abc import Callable
from typing import Any, ClassVar, Protocol, runtime_checkable

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.jumps import find_jumps
from beamfem.validation import flag, function_of_one, function_value

Amplitude = Callable[[float], float] | None


class Scaled(Protocol):
    """What every load has besides its value."""

    @property
    def amplitude(self) -> Amplitude: ...
    @property
    def scale(self) -> bool: ...


def factor(load: Scaled, time: float, static: bool) -> float:
    """Return the multiplier of a load at a time, in statics at a load factor.

    amplitude(time) where there is one; else the load factor in statics for loads with `scale`, else 1.
    """
    if load.amplitude is not None:
        return function_value(f"amplitude of {type(load).__name__}", load.amplitude, time)
    return time if static and load.scale else 1.0


def check_common(load: Scaled) -> None:
    """Check what loads have besides their place and value: amplitude, scale, and where they have it follower."""
    kind = type(load).__name__
    if load.amplitude is not None:
        function_of_one(f"amplitude of {kind}", load.amplitude, "time")
    flag(f"scale of {kind}", load.scale)
    if hasattr(load, "follower"):
        flag(f"follower of {kind}", load.follower)


@runtime_checkable
class AlongBeam(Protocol):
    """A load along a beam; `along`: names of what may be a function of the arc length [m] from the start."""

    along: ClassVar[tuple[str, ...]]

    @property
    def beam(self) -> Beam: ...

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return one of them at arc lengths (n,) [m]. Raises InputError where a function gives none."""
        ...


class Imposing(AlongBeam, Scaled, Protocol):
    """A load that gives a beam strains which it would take where nothing hindered it."""

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return stretch, shear, curvature [1/m] and thickness stretch (n, 4) at arc lengths (n,) [m]."""
        ...


def functions_along(load: AlongBeam) -> dict[str, Callable[[float], Any]]:
    """Return what of a load is a function of the arc length."""
    found = {name: getattr(load, name) for name in load.along}
    return {name: value for name, value in found.items() if callable(value)}


def kinks_along(load: AlongBeam, name: str) -> tuple[float, ...]:
    """Return the arc lengths (nj,) [m] at which such a function jumps, or has kinks that it declares."""
    beam = load.beam

    def numbers(arc_length: float) -> np.ndarray:
        return load.values_of(name, np.array([arc_length])).ravel()

    return find_jumps(getattr(load, name), numbers, beam.curve.length, beam.samples)


def jumps_along(load: AlongBeam) -> tuple[float, ...]:
    """Return the arc lengths [m] at which what a load gives a beam jumps, by itself or with the section."""
    kinks = [kinks_along(load, name) for name in functions_along(load)]
    return (*load.beam.jumps, *(kink for found in kinks for kink in found))


def check_along(load: AlongBeam) -> None:
    """Raise InputError for functions of the arc length that are none."""
    kind = type(load).__name__
    for name, function in functions_along(load).items():
        function_of_one(f"{name} of {kind}", function, "arc length")
        load.values_of(name, np.array([0.0, 0.5, 1.0]) * load.beam.curve.length)
