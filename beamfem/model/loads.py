"""Loads."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from beamfem.model.beam import Beam, Point
from beamfem.model.load import Amplitude, BodyLoad, LineLoad, PointLoad
from beamfem.validation import called, convert, finite, flag, squared, vector

Varying = Callable[[float], Sequence[float]]


@dataclass(frozen=True)
class Gravity(BodyLoad):
    """Gravity: an acceleration (gx, gy) [m/s^2] of the mass of every beam."""

    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector")
        super().__post_init__()


@dataclass(frozen=True)
class DistributedLoad(LineLoad):
    """Force per reference length (qx, qy) [N/m] along the axis of a beam.

    vector: in the global axes x and y; or a function of the arc length [m] from the start that returns it; elements end
    at its `kinks` (declared, or jumps that are found). follower: the force at each point rotates with its section; on a
    curved beam that is not normal to the axis: see `Pressure`.
    Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("vector",)

    beam: Beam
    vector: tuple[float, float] | Varying
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        if not callable(self.vector):
            convert(self, squared(vector), "vector")
        super().__post_init__()
        flag("follower of DistributedLoad", self.follower)

    @property
    def axes(self) -> Literal["plane", "section"]:
        """The axes of the forces."""
        return "section" if self.follower else "plane"

    @property
    def uniform(self) -> bool:  # type: ignore[override]
        """Whether it is the same at every arc length."""
        return not callable(self.vector)

    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return (qx, qy) [N/m] at arc lengths (n,) [m] as (n, 2)."""
        return self.values(arc_length)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return (qx, qy) [N/m] at arc lengths (n,) [m] as (n, 2)."""
        return self.values(arc_length)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return (qx, qy) [N/m] at arc lengths (n,) [m] as (n, 2). Raises InputError if a function gives none."""
        if not callable(self.vector):
            return np.tile(self.vector, (len(arc_length), 1))
        given, name = self.vector, "vector of DistributedLoad"
        found = [vector(f"{name} at arc length {s:g}", called(name, given, s)) for s in arc_length.tolist()]
        return np.array(found).reshape(-1, 2)


@dataclass(frozen=True)
class Pressure(LineLoad):
    """Pressure times width [N/m], normal to the deformed axis of a beam, per deformed length: a force p (-y', x') ds.

    value: positive towards the left of the direction from start to end, the +y side of its sections; or a function of
    the reference arc length [m] that returns it; elements end at its `kinks` (declared, or jumps that are found). It
    acts on the axis and does work on the area swept by the axis: a constant pressure is conservative if both ends of
    the beam are constrained in at least one direction, or close a ring. Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("value",)
    axes: ClassVar[Literal["axis"]] = "axis"

    beam: Beam
    value: float | Callable[[float], float]
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        if not callable(self.value):
            convert(self, squared(finite), "value")
        super().__post_init__()

    @property
    def uniform(self) -> bool:  # type: ignore[override]
        """Whether it is the same at every arc length."""
        return not callable(self.value)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the pressure [N/m] at arc lengths (n,) [m]."""
        return self.values(arc_length)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the pressure [N/m] at arc lengths (n,) [m]. Raises InputError if a function gives none."""
        if not callable(self.value):
            return np.full(len(arc_length), self.value)
        given, name = self.value, "value of Pressure"
        return np.array([finite(f"{name} at arc length {s:g}", called(name, given, s)) for s in arc_length.tolist()])

    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return (0, p) [N/m] at arc lengths (n,) [m] as (n, 2)."""
        return np.column_stack([np.zeros(len(arc_length)), self.values(arc_length)])


@dataclass(frozen=True)
class PointForce(PointLoad):
    """Force (fx, fy) [N] on the axis at a point; follower: the force rotates with the section."""

    point: Point
    vector: tuple[float, float]
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "vector")

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (*self.vector, 0.0)


@dataclass(frozen=True)
class PointMoment(PointLoad):
    """Moment [N m], counter-clockwise, conjugate to the rotation of the section: virtual work M dtheta.

    follower: accepted for uniformity; in the plane a moment that rotates with the section is the same moment.
    """

    point: Point
    moment: float
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(finite), "moment")

    @property
    def value(self) -> tuple[float, float, float]:
        """fx, fy [N] and moment [N m]."""
        return (0.0, 0.0, self.moment)
