"""The base classes of loads, which enter the equations in different ways."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from typing import ClassVar, Literal

import numpy as np

from beamfem.element.coordinates import across
from beamfem.errors import InputError
from beamfem.model.along_beam import AlongBeam, check_along, require_names
from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.returned import forces_of
from beamfem.model.shapes import Acceleration, Force, ForcesAlong, LoadShape, Moment, Placed, Strains, rotated
from beamfem.validation import called, convert, finite, flag, function_of_one, function_value, shown, squared

Amplitude = Callable[[float], float] | None
_ARROWS = 11  # along a beam


class Load(ABC):
    """A load with a factor: amplitude(time), or else, in statics, the load factor if `scale` is True, or else 1.

    Loads are frozen dataclasses that derive from `PointLoad`, `LineLoad`, `BodyLoad` or `ImposedStrain`.
    """

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
    @abstractmethod
    def conservative(self) -> bool:
        """Whether the load has a potential while its factor is constant, whatever the supports."""

    @abstractmethod
    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the shapes to draw for the load in a state of the model.

        Parameters
        ----------
        weight : float, [-]
            Factor by which the size of the load is multiplied.
        placed : Placed
            The state, with the rotations and directions of the axis there.

        Returns
        -------
        tuple of Force, Moment, ForcesAlong, Acceleration or Strains
            The shapes, see `beamfem.model.shapes`.
        """


class BodyLoad(Load):
    """An acceleration that acts on all mass.

    Attributes
    ----------
    vector : (float, float), [m/s^2]
        The acceleration.
    """

    vector: tuple[float, float]

    @property
    def place(self) -> None:
        """None: the load acts on all beams."""
        return

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as every acceleration of all mass has."""
        return True

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the acceleration to draw, see `Load.shapes`."""
        return (Acceleration(weight * np.array(self.vector)),)


class PointLoad(Load):
    """Force [N] and moment [N m] at a point.

    Attributes
    ----------
    point : Point
        Point of application.
    follower : bool
        Whether the force rotates with the section there.
    """

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
        """The point of application."""
        return self.point

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as all have but follower forces."""
        return not (self.follower and any(self.value[:2]))

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the force and the moment to draw, see `Load.shapes`."""
        force, moment = weight * np.array([self.value[:2]]), weight * self.value[2]
        if self.follower:
            force = rotated(force, np.array([placed.rotation(self.point)]))
        shapes: tuple[LoadShape, ...] = (Force(self.point, force[0]),) if any(self.value[:2]) else ()
        return (*shapes, Moment(self.point, moment)) if self.value[2] else shapes


class LineLoad(AlongBeam, Load):
    """Forces per length along a beam.

    The axes of the forces are "plane": x and y, per reference length; "section": x and y, rotated with the section from
    the reference, per reference length; or "axis": along r0' and normal to it, to the left, per deformed length.

    Attributes
    ----------
    uniform : bool
        Whether the forces are the same at every arc length.
    """

    uniform: bool = False

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        check_along(self)
        super().__post_init__()

    @property
    @abstractmethod
    def axes(self) -> Literal["plane", "section", "axis"]:
        """Axes of the forces: "plane", "section" or "axis"."""

    @abstractmethod
    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces per length, along `axes`.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, [N/m], (n, 2)
            Forces per length.
        """

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values of a function named in `along`.

        Parameters
        ----------
        name : str
            Name of the field.
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, (n, ...)
            Values, in the unit of the field.

        Raises
        ------
        InputError
            If the function does not return finite numbers, as many at every arc length.
        """
        function, what = getattr(self, name), f"{name} of {type(self).__name__}"
        results = [called(what, function, s) for s in arc_length.tolist()]
        with suppress(ValueError):  # of different shapes
            if (values := np.array(results)).dtype.kind in "iuf" and np.isfinite(values).all():
                return values
        raise InputError(f"{what} must give finite numbers, as many at every arc length, got {shown(results)}")

    @property
    def place(self) -> Beam:
        """The loaded beam."""
        return self.beam

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as those with the axes "plane" have."""
        return self.axes == "plane"

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the forces along the beam to draw, see `Load.shapes`."""
        at = _arrows(self, placed)
        vectors, points = weight * forces_of(self, at), [self.beam.at(part) for part in at / self.beam.curve.length]
        if self.axes == "section":
            vectors = rotated(vectors, np.array([placed.rotation(point) for point in points]))
        elif self.axes == "axis":
            slope = np.array([placed.slope(point) for point in points])
            vectors = vectors[:, :1] * slope + vectors[:, 1:] * across(slope)
        return (ForcesAlong(self.beam, at, vectors, even=self.uniform and self.axes == "plane"),)


class ImposedStrain(AlongBeam, Load):
    """Strains of the stress-free state of a beam; each field named in `along` is a number or a function.

    Attributes
    ----------
    along : tuple of str
        Names of the fields that may be functions of the arc length [m] from the start.
    units : tuple of str
        Their units.
    """

    units: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        require_names(self)
        convert(self, squared(finite), *(name for name in self.along if not callable(getattr(self, name))))
        check_along(self)
        super().__post_init__()

    @abstractmethod
    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the strains of the unconstrained beam.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths from the start.

        Returns
        -------
        array, (n, 4)
            Stretch [-], shear [-], curvature [1/m] and thickness stretch [-].
        """

    def heat(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the change of temperature, by which layers expand with their own coefficients; zero unless overridden.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths from the start.

        Returns
        -------
        array, (n, 2)
            Change of temperature on the axis [K] and its gradient over the section [K/m].
        """
        return np.zeros((len(arc_length), 2))

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values of a field named in `along`.

        Parameters
        ----------
        name : str
            Name of the field.
        arc_length : array, [m], (n,)
            Arc lengths from the start.

        Returns
        -------
        array, (n,)
            Values, in the unit of the field.

        Raises
        ------
        InputError
            If a function does not return finite numbers.
        """
        value, what = getattr(self, name), f"{name} of {type(self).__name__}"
        if not callable(value):
            return np.full(len(arc_length), value)
        return np.array([finite(f"{what} at arc length {s:g}", called(what, value, s)) for s in arc_length.tolist()])

    @property
    def place(self) -> Beam:
        """The beam that is strained."""
        return self.beam

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as every imposed strain has."""
        return True

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the imposed strains to draw, see `Load.shapes`."""
        values: dict[str, tuple[float | None, str]] = {}
        for name, unit in zip(self.along, self.units, strict=True):
            value = getattr(self, name)
            if callable(value):
                values[name] = None, unit
            elif value:
                values[name] = weight * value, unit
        return (Strains(self.beam, type(self).__name__.lower(), values),)


def factor(load: Load, time: float, static: bool) -> float:
    """Return the factor of a load at a time, in statics at a load factor.

    It is amplitude(time) if there is one, or else, in statics, the load factor for loads with `scale`, or else 1.
    """
    if load.amplitude is not None:
        return function_value(f"amplitude of {type(load).__name__}", load.amplitude, time)
    return time if static and load.scale else 1.0


def _arrows(load: LineLoad, placed: Placed) -> np.ndarray:
    """Return the arc lengths [m] at which a load along a beam is drawn: equally spaced, and at its largest value."""
    even = np.linspace(0.0, load.beam.curve.length, _ARROWS)
    if load.uniform:
        return even
    at = placed.stations(load.beam)
    sizes = [np.abs(forces_of(load, arc_length)).max(axis=1) for arc_length in (at, even)]
    return np.union1d(even, at[sizes[0].argmax()]) if sizes[0].max() > sizes[1].max() else even
