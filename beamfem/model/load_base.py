"""Base classes of loads: on all mass, at points and along beams."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, ClassVar, get_args

import numpy as np

from beamfem.errors import InputError
from beamfem.model.along_beam import AlongBeam, check_along, ends_and_middle, values_along
from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.joint_base import Joint
from beamfem.model.load_shapes import Acceleration, Force, ForcesAlong, LoadShape, Moment
from beamfem.model.state_protocols import Axes, Placed, in_plane
from beamfem.model.supports import Value
from beamfem.validation import (
    called,
    finite,
    flag,
    function_of_one,
    function_value,
    items,
    one_of,
    shown,
    squared,
    vector,
)

Amplitude = Callable[[float], float] | None


class Load(ABC):
    """A load with a factor: amplitude(time), or else, in statics, the load factor if `scale` is True, or else 1.

    Loads are frozen dataclasses that derive from `PointLoad`, `LineLoad`, `BodyLoad` or `ImposedStrain`.
    """

    along: ClassVar[tuple[str, ...]] = ()
    moves: ClassVar[bool] = False

    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        kind = type(self).__name__
        if self.amplitude is not None:
            function_of_one(f"amplitude of {kind}", self.amplitude, "time")
        flag(f"scale of {kind}", self.scale)

    @property
    @abstractmethod
    def place(self) -> Beam | Point | None:
        """The beam or point that the load acts on, None for all beams."""

    @property
    def even(self) -> bool:
        """Whether what acts is one vector of x and y on whole beams."""
        return False

    @property
    def axes(self) -> Axes:
        """Axes of what the load returns as `acting`: "plane", "section" or "axis", see `LineLoad`."""
        return "plane"

    @property
    def layout(self) -> Any:
        """All of the load but its size; the load itself if tables of solvers depend on its size."""
        return self

    @property
    def parts(self) -> tuple[Any, ...]:
        """What the load consists of: itself, unless it is a `CompositeLoad`."""
        return (self,)

    @property
    @abstractmethod
    def conservative(self) -> bool:
        """Whether the load has a potential while its factor is constant, whatever the supports."""

    @abstractmethod
    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the shapes to draw for the load in a state, see `beamfem.model.load_shapes`.

        weight [-]: factor of the size of the load; placed: the state, with rotations and directions of the axis.
        """

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        """Return the external forces on beams at arc lengths (n,) [m], along `axes`, without the load's factor.

        "force" [N], "line_force" [N/m] or "acceleration" [m/s^2] (n, 2), and "moment" [N m] (n, 1), by name; nothing
        for imposed strains.
        """
        return {}

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined load."""
        if isinstance(getattr(type(self), "amplitude", None), property):
            kind = type(self).__name__
            raise InputError(f"amplitude of {kind} must be a field or a method of the time, not a property")
        Load.__post_init__(self)


def factor(load: Load, time: float, static: bool, name: str | None = None) -> float:
    """Return the factor of a load at a time, in statics at a load factor; name: see `Model.name_of`.

    It is amplitude(time) if there is one, or else, in statics, the load factor for loads with `scale`, or else 1.
    """
    if load.amplitude is not None:
        return function_value(f"amplitude of {name or type(load).__name__}", load.amplitude, time)
    return time if static and load.scale else 1.0


class BodyLoad(Load):
    """An acceleration `vector` [m/s^2] that acts on all mass."""

    even = True
    vector: tuple[float, float]

    @property
    def place(self) -> None:
        """None: the load acts on all beams."""
        return

    @property
    def layout(self) -> None:
        """None, as no table depends on an acceleration; see `Load.layout`."""
        return

    @property
    def conservative(self) -> bool:
        return True

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        return (Acceleration(weight * np.array(self.vector)),)

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        return {"acceleration": np.array([self.vector])}

    def require_valid(self) -> None:
        super().require_valid()
        squared(vector)(f"vector of {type(self).__name__}", getattr(self, "vector", None))


class PointLoad(Load):
    """Force [N] and moment [N m] at a point; follower: whether the force rotates with the section there."""

    point: Point
    follower: bool = False

    def __post_init__(self) -> None:
        require_point_of(self)
        super().__post_init__()
        flag(f"follower of {type(self).__name__}", self.follower)

    @property
    @abstractmethod
    def value(self) -> tuple[float, float, float]:
        """Force fx, fy [N] and moment [N m]."""

    @property
    def place(self) -> Point:
        return self.point

    @property
    def axes(self) -> Axes:
        return "section" if self.follower else "plane"

    @property
    def layout(self) -> tuple[Point, bool]:
        """Point of the load, and whether it follows the section; see `Load.layout`."""
        return self.point, self.follower

    @property
    def conservative(self) -> bool:
        return not (self.follower and any(self.value[:2]))

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        force, moment = weight * np.array([[self.value[:2]]]), weight * self.value[2]
        shapes: tuple[LoadShape, ...] = ()
        if any(self.value[:2]):
            shapes = (Force(self.point, in_plane(force, self.axes, placed.at(self.point))[0, 0]),)
        return (*shapes, Moment(self.point, moment)) if self.value[2] else shapes

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        value = np.array([self.value])
        return {"force": value[:, :2], "moment": value[:, 2:]}

    def require_valid(self) -> None:
        super().require_valid()
        PointLoad.__post_init__(self)
        what = f"value of {type(self).__name__}"
        value = called(what, lambda: self.value)
        if callable(value):
            raise InputError(f"{what} must be a field or a property, not a method")
        numbers = [squared(finite)(what, number) for number in items(what, value)]
        if len(numbers) != 3:
            raise InputError(f"{what} must be three numbers, fx, fy and moment, got {shown(value)}")


class MovingLoad(Load):
    """A force [N] that moves along a beam.

    Attributes
    ----------
    beam : Beam
        The beam.
    vector : (float, float), [N]
        The force (fx, fy).
    """

    moves = True
    beam: Beam
    vector: tuple[float, float]

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        super().__post_init__()

    @abstractmethod
    def place_at(self, time: float) -> float:
        """Return the arc length [m] at a time [s] or load factor; off the beam there is no force."""

    def presence(self, time: float) -> float:
        """Return 1 at times [s] or load factors at which it is on the beam, 0 at others."""
        return float(0.0 <= self.place_at(time) / self.beam.curve.length <= 1.0)

    @abstractmethod
    def moved(self, position: Callable[[float], float]) -> "MovingLoad":
        """Return the load at the arc lengths of another function of time."""

    @property
    def place(self) -> Beam:
        """The beam."""
        return self.beam

    @property
    def conservative(self) -> bool:
        """False: the force has no potential that is constant in time."""
        return False

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the force to draw, see `Load.shapes`."""
        if not self.presence(placed.time):
            return ()
        point = self.beam.at(self.place_at(placed.time) / self.beam.curve.length)
        return (Force(point, weight * np.array(self.vector)),)


class CompositeLoad(Load):
    """A load that consists of supports at points, loads at points and conditions.

    Attributes
    ----------
    points : tuple of Point
        The points that it acts on.
    joint : Joint, optional
        The joint of the model that it acts in.
    """

    @property
    @abstractmethod
    def points(self) -> tuple[Point, ...]:
        """The points that it acts on."""

    @property
    def joint(self) -> Joint | None:
        """The joint of the model that it acts in, none unless overridden."""
        return None

    @property
    @abstractmethod
    def parts(self) -> tuple[Any, ...]:
        """What it consists of, the same objects at each access."""

    @property
    def conservative(self) -> bool:
        """Whether all of its loads have a potential."""
        return all(part.conservative for part in self.parts if isinstance(part, Load))

    @abstractmethod
    def changed(self, change: Callable[[Value], Value]) -> "CompositeLoad":
        """Return the load with what `change` returns for its values, numbers or functions, in place of these."""


_ARROWS = 11  # along a beam


class LineLoad(AlongBeam, Load):
    """Forces per length along a beam; uniform: whether they are the same at every arc length.

    The axes of the forces are "plane": x and y, per reference length; "section": x and y, rotated with the section from
    the reference, per reference length; or "axis": along r0' and normal to it, to the left, per deformed length.
    """

    uniform: bool = False

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        check_along(self)
        super().__post_init__()

    @property
    @abstractmethod
    def axes(self) -> Axes:
        """Axes of the forces: "plane", "section" or "axis"."""

    @abstractmethod
    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces per length (n, 2) [N/m] at arc lengths (n,) [m] of the reference, along `axes`."""

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values (n, ...) of a function named in `along` at arc lengths (n,) [m].

        Raises InputError if it does not return finite numbers, as many at every arc length.
        """
        function, what = getattr(self, name), f"{name} of {type(self).__name__}"
        results = [called(what, function, s) for s in arc_length.tolist()]
        with suppress(ValueError):  # of different shapes
            if (values := np.array(results)).dtype.kind in "iuf" and np.isfinite(values).all():
                return values
        raise InputError(f"{what} must give finite numbers, as many at every arc length, got {shown(results)}")

    @property
    def even(self) -> bool:
        """Whether the forces are one vector of x and y on the whole beam."""
        return self.uniform and self.axes == "plane"

    @property
    def layout(self) -> Any:
        """None for forces that are one vector, or else the load; see `Load.layout`."""
        return None if self.even else self

    @property
    def conservative(self) -> bool:
        return self.axes == "plane"

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        at = _arrows(self, placed)
        vectors = in_plane(weight * forces_of(self, at)[None], self.axes, placed.along(self.beam, at))
        return (ForcesAlong(self.beam, at, vectors[0], self.even),)

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        return {"line_force": forces_of(self, arc_length)}

    def require_valid(self) -> None:
        super().require_valid()
        LineLoad.__post_init__(self)
        kind = type(self).__name__
        one_of(f"axes of {kind}", self.axes, get_args(Axes))
        forces = forces_of(self, ends_and_middle(self.beam))
        if flag(f"uniform of {kind}", self.uniform) and np.any(forces != forces[:1]):
            raise InputError(f"uniform of {kind} is True, but its forces change on the beam: {shown(forces.tolist())}")


def _arrows(load: LineLoad, placed: Placed) -> np.ndarray:
    """Return the arc lengths [m] at which a load along a beam is drawn: equally spaced, and at its largest value."""
    even = np.linspace(0.0, load.beam.curve.length, _ARROWS)
    if load.uniform:
        return even
    at = placed.stations(load.beam)
    sizes = [np.abs(forces_of(load, arc_length)).max(axis=1) for arc_length in (at, even)]
    return np.union1d(even, at[sizes[0].argmax()]) if sizes[0].max() > sizes[1].max() else even


def forces_of(load: LineLoad, arc_length: np.ndarray) -> np.ndarray:
    """Return the forces (n, 2) [N/m] of a load at arc lengths (n,) [m]. Raises InputError for any other result."""
    return values_along(load, "forces", load.forces, arc_length, 2)
