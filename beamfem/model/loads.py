"""What acts on a beam."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.coordinates import across
from beamfem.model.beam import Beam, Point, require_beam, require_point
from beamfem.model.imposed_strains import Actuation, Temperature
from beamfem.model.load import Amplitude, check_along, check_common
from beamfem.model.shapes import Acceleration, Force, ForcesAlong, LoadShape, Moment, Placed, arrows_along, turned
from beamfem.validation import called, convert, finite, squared, vector

Varying = Callable[[float], Sequence[float]]


@dataclass(frozen=True)
class Gravity:
    """Acceleration (gx, gy) [m/s^2] on the mass of every beam."""

    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector")
        check_common(self)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state."""
        return (Acceleration(weight * np.array(self.vector)),)


@dataclass(frozen=True)
class DistributedLoad:
    """Force per reference length (qx, qy) [N/m] along the axis of a beam.

    vector: in the axes x and y of the plane, at every point; or a function of the arc length [m] from the start that
    gives one, at whose `kinks` (declared, or jumps that are found) elements end. follower: what acts at a point in the
    reference turns with its section; on a beam that is drawn curved that is not normal to its axis: see `Pressure`.
    Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("vector",)

    beam: Beam
    vector: tuple[float, float] | Varying
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        require_beam("DistributedLoad", self.beam)
        if not callable(self.vector):
            convert(self, squared(vector), "vector")
        check_along(self)
        check_common(self)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return (qx, qy) [N/m] at arc lengths (n,) [m] as (n, 2). Raises InputError where a function gives none."""
        if not callable(self.vector):
            return np.tile(self.vector, (len(arc_length), 1))
        given, name = self.vector, "vector of DistributedLoad"
        found = [vector(f"{name} at arc length {s:g} m", called(name, given, s)) for s in arc_length.tolist()]
        return np.array(found).reshape(-1, 2)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values at arc lengths (n,) [m]."""
        return self.values(arc_length)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state."""
        at = arrows_along(self, placed)
        vectors = weight * self.values(at)
        if self.follower:
            points = [self.beam.at(share) for share in at / self.beam.curve.length]
            vectors = turned(vectors, np.array([placed.rotation(point) for point in points]))
        return (ForcesAlong(self.beam, at, vectors, even=not self.follower and not callable(self.vector)),)


@dataclass(frozen=True)
class Pressure:
    """Pressure times width [N/m], normal to the deformed axis of a beam, per deformed length: a force p (-y', x') ds.

    value: above 0 it pushes to the left of the way from the beam's start to its end, the side of +y of its sections; or
    a function of the arc length in the reference [m] that gives it, at whose `kinks` (declared, or jumps that are
    found) elements end. It acts on the axis, so that it does work on the area that the axis sweeps: a constant one is
    conservative where both ends of the beam are held in one direction at least, or close a ring. Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("value",)

    beam: Beam
    value: float | Callable[[float], float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        require_beam("Pressure", self.beam)
        if not callable(self.value):
            convert(self, squared(finite), "value")
        check_along(self)
        check_common(self)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the pressure [N/m] at arc lengths (n,) [m]. Raises InputError where a function gives none."""
        if not callable(self.value):
            return np.full(len(arc_length), self.value)
        given = self.value
        name = "value of Pressure"
        return np.array([finite(f"{name} at arc length {s:g} m", called(name, given, s)) for s in arc_length.tolist()])

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values at arc lengths (n,) [m]."""
        return self.values(arc_length)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state: p (-y', x')."""
        at = arrows_along(self, placed)
        slope = np.array([placed.slope(self.beam.at(share)) for share in at / self.beam.curve.length])
        return (ForcesAlong(self.beam, at, weight * self.values(at)[:, None] * across(slope), even=False),)


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
        check_common(self)

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (*self.vector, 0.0)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state."""
        vector = weight * np.array([self.vector])
        if self.follower:
            vector = turned(vector, np.array([placed.rotation(self.point)]))
        return (Force(self.point, vector[0]),)


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
        check_common(self)

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (0.0, 0.0, self.moment)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state."""
        return (Moment(self.point, weight * self.moment),)


PointLoad = PointForce | PointMoment
LineLoad = DistributedLoad | Pressure
ImposedStrain = Actuation | Temperature
Load = Gravity | DistributedLoad | Pressure | PointForce | PointMoment | ImposedStrain
