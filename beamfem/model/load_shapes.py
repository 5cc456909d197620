"""Shapes of loads, supports and joints, which pictures and files draw in different ways."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar, get_args

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.validation import shown

_Shape = TypeVar("_Shape")


@dataclass(frozen=True, eq=False)
class Force:
    """A force (2,) [N] at a point."""

    point: Point
    vector: np.ndarray


@dataclass(frozen=True, eq=False)
class Moment:
    """A moment [N m] at a point, counter-clockwise."""

    point: Point
    moment: float


@dataclass(frozen=True, eq=False)
class ForcesAlong:
    """Forces (n, 2) [N/m] at arc lengths (n,) [m] of a beam; even: constant along the beam."""

    beam: Beam
    arc_length: np.ndarray
    vectors: np.ndarray
    even: bool


@dataclass(frozen=True, eq=False)
class Acceleration:
    """An acceleration (2,) [m/s^2] that acts on all mass."""

    vector: np.ndarray


@dataclass(frozen=True, eq=False)
class Strains:
    """Strains imposed on a beam: name of the load; values by name with their units, None if they vary."""

    beam: Beam
    name: str
    values: Mapping[str, tuple[float | None, str]]


@dataclass(frozen=True, eq=False)
class Constraint:
    """Prescribed directions at a point, named as in `supports.Prescribed`; normal (2,): that of a roller."""

    point: Point
    prescribed: Mapping[str, float | Callable[[float], float]]
    normal: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Springs:
    """Springs to the ground (kx, ky) [N/m] and against rotation [N m/rad] at a point."""

    point: Point
    stiffness: tuple[float, float]
    rotational: float


@dataclass(frozen=True, eq=False)
class SpringsAlong:
    """Springs to the ground (kx, ky) [N/m^2] along a beam."""

    beam: Beam
    stiffness: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Ring:
    """A hinge at a point."""

    point: Point


@dataclass(frozen=True, eq=False)
class Disc:
    """A concentrated mass at a point, with its centre at an offset (2,) [m] that turns with the section."""

    point: Point
    offset: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Coil:
    """A spring, or straight line, from a point to another one, or to a place (2,) [m] on the ground."""

    a: Point
    b: Point | tuple[float, float]
    straight: bool = False


@dataclass(frozen=True, eq=False)
class Bar:
    """A rigid bar between two points."""

    a: Point
    b: Point


@dataclass(frozen=True, eq=False)
class Spiral:
    """A torsion spring at a point."""

    point: Point


@dataclass(frozen=True, eq=False)
class Wall:
    """A wall through a place (2,) [m], with its normal (2,)."""

    place: tuple[float, float]
    normal: tuple[float, float]


LoadShape = Force | Moment | ForcesAlong | Acceleration | Strains
SupportShape = Constraint | Springs | SpringsAlong
JointShape = Ring
ConnectorShape = Disc | Coil | Bar | Spiral | Wall


def drawn(part: Any, shapes: Iterable[_Shape], known: Any) -> tuple[_Shape, ...]:
    """Return the shapes of a part. Raises InputError for an object that is none of the known shapes."""
    result = tuple(shapes)
    for shape in result:
        if not isinstance(shape, known):
            names = ", ".join(kind.__name__ for kind in get_args(known) or (known,))
            raise InputError(f"shapes of {type(part).__name__} must return shapes ({names}), got {shown(shape)}")
    return result
