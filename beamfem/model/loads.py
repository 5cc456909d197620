"""What acts on a beam."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from beamfem.model.beam import Beam, Point
from beamfem.validation import finite, function_of_one, function_value, vector

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
        return function_value("amplitude", load.amplitude, time)
    return time if static and load.scale else 1.0


def _check_amplitude(amplitude: Amplitude) -> None:
    if amplitude is not None:
        function_of_one("amplitude", amplitude, "time")


@dataclass(frozen=True)
class Gravity:
    """Acceleration (gx, gy) [m/s^2] on the mass of every beam."""

    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "vector", vector("vector of Gravity", self.vector))
        _check_amplitude(self.amplitude)


@dataclass(frozen=True)
class DistributedLoad:
    """Force per reference length (qx, qy) [N/m] along the axis of a beam.

    follower: (qx, qy) acts in the reference and turns with the section, as a pressure does.
    """

    beam: Beam
    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "vector", vector("vector of DistributedLoad", self.vector))
        _check_amplitude(self.amplitude)


@dataclass(frozen=True)
class PointForce:
    """Force (fx, fy) [N] on the axis at a point; follower: it turns with the section."""

    point: Point
    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "vector", vector("vector of PointForce", self.vector))
        _check_amplitude(self.amplitude)

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
        finite("moment", self.moment)
        _check_amplitude(self.amplitude)

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (0.0, 0.0, self.moment)


PointLoad = PointForce | PointMoment
Load = Gravity | DistributedLoad | PointForce | PointMoment
