"""What acts on a beam."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, require_beam, require_point
from beamfem.model.jumps import find_jumps
from beamfem.validation import called, convert, finite, flag, function_of_one, function_value, squared, vector

Amplitude = Callable[[float], float] | None
Varying = Callable[[float], Sequence[float]]


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


def _check_common(load: Scaled) -> None:
    """Check what loads have besides their place and value: amplitude, scale, and where they have it follower."""
    kind = type(load).__name__
    if load.amplitude is not None:
        function_of_one(f"amplitude of {kind}", load.amplitude, "time")
    flag(f"scale of {kind}", load.scale)
    if hasattr(load, "follower"):
        flag(f"follower of {kind}", load.follower)


@dataclass(frozen=True)
class Gravity:
    """Acceleration (gx, gy) [m/s^2] on the mass of every beam."""

    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector")
        _check_common(self)


@dataclass(frozen=True)
class DistributedLoad:
    """Force per reference length (qx, qy) [N/m] along the axis of a beam.

    vector: in the axes x and y of the plane, at every point; or a function of the arc length [m] from the start that
    gives one, at whose `kinks` (declared, or jumps that are found) elements end. follower: what acts at a point in the
    reference turns with its section; on a beam that is drawn curved that is not normal to its axis: see `Pressure`.
    Raises InputError.
    """

    beam: Beam
    vector: tuple[float, float] | Varying
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        require_beam("DistributedLoad", self.beam)
        if callable(self.vector):
            function_of_one("vector of DistributedLoad", self.vector, "arc length")
            _check_along(self)
        else:
            convert(self, squared(vector), "vector")
        _check_common(self)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return (qx, qy) [N/m] at arc lengths (n,) [m] as (n, 2). Raises InputError where a function gives none."""
        if not callable(self.vector):
            return np.tile(self.vector, (len(arc_length), 1))
        given, name = self.vector, "vector of DistributedLoad"
        return np.array(
            [vector(f"{name} {s:g} m", called("vector of DistributedLoad", given, s)) for s in arc_length.tolist()]
        ).reshape(-1, 2)


@dataclass(frozen=True)
class Pressure:
    """Pressure times width [N/m], normal to the deformed axis of a beam, per deformed length: a force p (-y', x') ds.

    value: above 0 it pushes to the left of the way from the beam's start to its end, the side of +y of its sections; or
    a function of the arc length in the reference [m] that gives it, at whose `kinks` (declared, or jumps that are
    found) elements end. It acts on the axis, so that it does work on the area that the axis sweeps: a constant one is
    conservative where both ends of the beam are held in one direction at least, or close a ring. Raises InputError.
    """

    beam: Beam
    value: float | Callable[[float], float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        require_beam("Pressure", self.beam)
        if callable(self.value):
            function_of_one("value of Pressure", self.value, "arc length")
            _check_along(self)
        else:
            convert(self, squared(finite), "value")
        _check_common(self)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the pressure [N/m] at arc lengths (n,) [m]. Raises InputError where a function gives none."""
        if not callable(self.value):
            return np.full(len(arc_length), self.value)
        given = self.value
        return np.array([function_value("value of Pressure", given, s) for s in arc_length.tolist()])


@dataclass(frozen=True)
class PointForce:
    """Force (fx, fy) [N] on the axis at a point; follower: it turns with the section."""

    point: Point
    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        require_point("PointForce", self.point)
        convert(self, squared(vector), "vector")
        _check_common(self)

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (*self.vector, 0.0)


@dataclass(frozen=True)
class PointMoment:
    """Moment [N m], counter-clockwise, on the section's direction: virtual work M dtheta.

    follower: accepted for the sake of likeness; in the plane a moment that turns with the section is the same moment.
    """

    point: Point
    moment: float
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        require_point("PointMoment", self.point)
        convert(self, squared(finite), "moment")
        _check_common(self)

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (0.0, 0.0, self.moment)


PointLoad = PointForce | PointMoment
LineLoad = DistributedLoad | Pressure
Load = Gravity | DistributedLoad | Pressure | PointForce | PointMoment


def along(load: LineLoad) -> float | tuple[float, float] | Callable[[float], object]:
    """Return what a load along a beam is per length, or the function that gives it."""
    return load.value if isinstance(load, Pressure) else load.vector


def kinks_along(load: LineLoad) -> tuple[float, ...]:
    """Return the arc lengths (nj,) [m] at which a load along a beam jumps, or has kinks that it declares."""
    given, beam = along(load), load.beam
    if not callable(given):
        return ()

    def numbers(arc_length: float) -> np.ndarray:
        return load.values(np.array([arc_length])).ravel()

    return find_jumps(given, numbers, beam.curve.length, beam.samples)


def _check_along(load: LineLoad) -> None:
    if not isinstance(load.beam, Beam):
        raise InputError(f"beam of {type(load).__name__} must be a Beam, one of the model's beams, got {load.beam!r}")
    load.values(np.array([0.0, 0.5, 1.0]) * load.beam.curve.length)
