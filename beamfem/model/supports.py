"""Supports: the base classes, at a point or along a beam, and the supports of the package."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.load_shapes import Constraint, Springs, SpringsAlong, SupportShape
from beamfem.model.state_protocols import Displaced
from beamfem.validation import called, convert, finite, function_of_one, positive, require_known, shown, squared, vector

DIRECTIONS = ("ux", "uy", "rotation")
Value = float | Callable[[float], float]
_UNIT = 1e-9  # largest deviation of the length of a unit vector from 1


class Support(ABC):
    """A connection of beams to the ground: frozen dataclasses that derive from `PointSupport` or `LineSupport`."""

    @property
    @abstractmethod
    def place(self) -> Beam | Point:
        """The supported beam or point."""

    @abstractmethod
    def shapes(self) -> tuple[SupportShape, ...]:
        """Return the shapes to draw."""

    def energy(self, displaced: Displaced) -> np.ndarray:
        """Return the energy of springs along a beam; that of springs at points is summed over all nodal coordinates.

        Parameters
        ----------
        displaced : Displaced
            States of the model, with the displacements of the beams.

        Returns
        -------
        array, [J], (steps,)
            Energy, zero in the reference.
        """
        return np.zeros(len(displaced))

    @abstractmethod
    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined support."""


class PointSupport(Support):
    """A support at a point: its prescribed directions and its springs.

    Directions are "ux" and "uy" [m] and "rotation" [rad], from the reference.

    Attributes
    ----------
    point : Point
        The supported point.
    """

    point: Point

    def __post_init__(self) -> None:
        require_point_of(self)

    def prescribed(self) -> Mapping[str, Value]:
        """Return the prescribed values by direction; no direction unless overridden.

        Returns
        -------
        mapping
            "ux", "uy" [m] and "rotation" [rad]: numbers, which grow with the load factor in statics, or functions of
            time [s]. "normal": 0.0 constrains the displacement along `direction`; no other value is possible.
        """
        return {}

    def springs(self) -> Mapping[str, float]:
        """Return the stiffness of the springs to the ground by direction; no spring unless overridden.

        Returns
        -------
        mapping
            Stiffness, none of them zero: "ux", "uy" [N/m] and "rotation" [N m/rad].
        """
        return {}

    @property
    def direction(self) -> np.ndarray | None:
        """Unit vector (2,) [-] along which "normal" is prescribed, None if it is not."""
        return None

    @property
    def place(self) -> Point:
        """The supported point."""
        return self.point

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return the shapes to draw."""
        prescribed, springs = self.prescribed(), self.springs()
        shapes: tuple[SupportShape, ...] = ()
        if prescribed:
            shapes = (Constraint(self.point, prescribed, self.direction),)
        if springs:
            kx, ky, rotational = (springs.get(name, 0.0) for name in DIRECTIONS)
            shapes = (*shapes, Springs(self.point, (kx, ky), rotational))
        return shapes

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined support."""
        kind = type(self).__name__
        require_point_of(self)
        prescribed = _by_direction(f"prescribed of {kind}", self.prescribed, (*DIRECTIONS, "normal"))
        springs = _by_direction(f"springs of {kind}", self.springs, DIRECTIONS)
        if not prescribed and not springs:
            raise InputError(f"{kind} does nothing: let prescribed() or springs() of it return something by direction")
        for direction, value in prescribed.items():
            what = f"{direction} prescribed by {kind}"
            if direction == "normal" and (callable(value) or finite(what, value) != 0.0):
                raise InputError(f"{what} must be 0.0, got {shown(value)}: only ux, uy and rotation can be moved")
            if callable(value):
                function_of_one(what, value, "time")
            else:
                squared(finite)(what, value)
        for direction, stiffness in springs.items():
            squared(positive)(f"stiffness of {kind} in {direction}", stiffness)
        _require_direction(self, "normal" in prescribed)


class LineSupport(Support):
    """Springs along a beam to the ground.

    Attributes
    ----------
    beam : Beam
        The supported beam.
    stiffness : (float, float), [N/m^2]
        Stiffness (kx, ky) per reference length.
    """

    beam: Beam
    stiffness: tuple[float, float]

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))

    @property
    def place(self) -> Beam:
        """The supported beam."""
        return self.beam

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return the shapes to draw."""
        return (SpringsAlong(self.beam, self.stiffness),)

    def energy(self, displaced: Displaced) -> np.ndarray:
        """Return the energy of the springs along the beam, see `Support.energy`."""
        moved, weight, _ = displaced.along(self.beam)
        return np.asarray(0.5 * np.einsum("sqc,c,q->s", moved**2, np.array(self.stiffness), weight))

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined support."""
        kind = type(self).__name__
        require_beam(kind, getattr(self, "beam", None))
        stiffness = squared(vector)(f"stiffness of {kind}", getattr(self, "stiffness", None))
        if min(stiffness) < 0.0 or max(stiffness) == 0.0:
            raise InputError(f"the stiffness of a {kind} must not be negative, and somewhere positive, got {stiffness}")


def _require_direction(support: PointSupport, needed: bool) -> None:
    what = f"direction of {type(support).__name__}"
    direction = called(what, lambda: support.direction)
    if direction is None and needed:
        raise InputError(f'{what} must be a unit vector, since "normal" is prescribed along it, got None')
    if direction is not None:
        if not needed:
            raise InputError(f'{what} is given, but prescribed() returns no "normal" along it')
        size = np.hypot(*vector(what, direction))
        if abs(size - 1.0) > _UNIT:
            raise InputError(f"{what} must be a unit vector, got {shown(direction)} of length {size:g}")


def _by_direction(what: str, function: Callable[[], Any], known: tuple[str, ...]) -> Mapping[str, Any]:
    values = called(what, function)
    if not isinstance(values, Mapping):
        raise InputError(f'{what} must return a dict by direction, such as {{"ux": 0.0}}, got {shown(values)}')
    for direction in values:
        require_known(f"{what} has the unknown direction {shown(direction)}", direction, known)
    return values


@dataclass(frozen=True)
class Clamp(PointSupport):
    """Constrain position and rotation of the section.

    r_x may still stretch and, except for the elastic line, shear.

    Parameters
    ----------
    point : Point
        The clamped point.

    Examples
    --------
    >>> clamped = bf.Model([beam], supports=[bf.Clamp(beam.start), bf.Clamp(beam.end)])
    >>> len(clamped.supports)
    2
    """

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"ux": 0.0, "uy": 0.0, "rotation": 0.0}


@dataclass(frozen=True)
class Pin(PointSupport):
    """Constrain the position; the rotation is free.

    Parameters
    ----------
    point : Point
        The pinned point.

    Examples
    --------
    >>> simply_supported = bf.Model([beam], supports=[bf.Pin(beam.start), bf.Roller(beam.end)])
    >>> len(simply_supported.supports)
    2
    """

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"ux": 0.0, "uy": 0.0}


@dataclass(frozen=True)
class Roller(PointSupport):
    """Constrain the displacement along a normal only.

    Parameters
    ----------
    point : Point
        The supported point.
    normal : (float, float), [-], default (0, 1)
        Direction of the constraint; its length does not matter.

    Raises
    ------
    InputError
        For a zero normal.

    Examples
    --------
    >>> inclined = bf.Roller(beam.end, normal=(-1.0, 1.0))
    >>> inclined.direction.round(3)
    array([-0.707,  0.707])
    """

    point: Point
    normal: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "normal")
        if not any(self.normal):
            raise InputError("the normal of a Roller must not be zero")

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"normal": 0.0}

    @property
    def direction(self) -> np.ndarray:
        """Unit normal (2,) [-]."""
        return np.array(self.normal) / np.hypot(*self.normal)


@dataclass(frozen=True)
class Prescribed(PointSupport):
    """Prescribe displacement and rotation at a point, from the reference.

    A number is multiplied by the load factor in statics and constant in dynamics; a function depends on time [s], or on
    the load factor in statics. None leaves a direction free.

    Parameters
    ----------
    point : Point
        The moved point.
    ux, uy : float or callable, [m], optional
        Displacement.
    rotation : float or callable, [rad], optional
        Rotation of the section.

    Raises
    ------
    InputError
        If nothing is prescribed, or a value is invalid.

    Examples
    --------
    >>> pushed = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=-0.1)])
    >>> round(float(bf.solve_static(pushed).reaction(beam.end)[-1, 1]), -2)
    -32800.0
    """

    point: Point
    ux: Value | None = field(default=None, metadata={"unit": "m"})
    uy: Value | None = field(default=None, metadata={"unit": "m"})
    rotation: Value | None = field(default=None, metadata={"unit": "rad"})

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.prescribed():
            raise InputError("Prescribed needs at least one of ux, uy and rotation")
        for name, value in self.prescribed().items():
            if callable(value):
                function_of_one(f"{name} of Prescribed", value, "time")
            else:
                convert(self, squared(finite), name)

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        values = {"ux": self.ux, "uy": self.uy, "rotation": self.rotation}
        return {name: value for name, value in values.items() if value is not None}


@dataclass(frozen=True)
class Spring(PointSupport):
    """Spring to the ground, unstressed in the reference.

    Parameters
    ----------
    point : Point
        The supported point.
    stiffness : (float, float), [N/m], default (0, 0)
        Stiffness (kx, ky) against displacement.
    rotational : float, [N m/rad], default 0
        Stiffness against rotation.

    Raises
    ------
    InputError
        For a negative stiffness, or if all are zero.

    Examples
    --------
    >>> spring = bf.Spring(beam.end, stiffness=(0.0, 1e5), rotational=200.0)
    """

    point: Point
    stiffness: tuple[float, float] = field(default=(0.0, 0.0), metadata={"unit": "N/m"})
    rotational: float = field(default=0.0, metadata={"unit": "N m/rad"})

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        convert(self, squared(finite), "rotational")
        values = (*self.stiffness, self.rotational)
        if min(values) < 0.0 or max(values) == 0.0:
            raise InputError(f"the stiffness of a Spring must not be negative, and somewhere positive, got {values}")

    def springs(self) -> dict[str, float]:
        """Return the stiffness by direction, [N/m] and [N m/rad], without zeros."""
        pairs = zip(("ux", "uy", "rotation"), (*self.stiffness, self.rotational), strict=True)
        return {name: value for name, value in pairs if value > 0.0}


@dataclass(frozen=True)
class Foundation(LineSupport):
    """Winkler foundation along a beam, unstressed in the reference.

    Parameters
    ----------
    beam : Beam
        The supported beam.
    stiffness : (float, float), [N/m^2]
        Stiffness (kx, ky) per reference length.

    Raises
    ------
    InputError
        For a negative stiffness, or if both are zero.

    Examples
    --------
    >>> soil = bf.Foundation(beam, stiffness=(0.0, 1e6))
    """

    beam: Beam
    stiffness: tuple[float, float] = field(metadata={"unit": "N/m^2"})

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        if min(self.stiffness) < 0.0 or max(self.stiffness) == 0.0:
            raise InputError(f"the stiffness of a Foundation must not be negative, and somewhere positive: {self}")
