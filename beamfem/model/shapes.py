"""Shapes of loads, supports and joints, which pictures and files draw in different ways."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from beamfem.element.coordinates import across
from beamfem.model.beam import Beam, Point


class Placed(Protocol):
    """A state of a model, with the members that shapes need."""

    def rotation(self, point: Point) -> float:
        """Return the rotation of a section from the reference [rad]."""
        ...

    def slope(self, point: Point) -> np.ndarray:
        """Return r0' (2,) [-] at a point."""
        ...

    def stations(self, beam: Beam) -> np.ndarray:
        """Return the arc lengths (n,) [m] at which loads along a beam are integrated."""
        ...


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


LoadShape = Force | Moment | ForcesAlong | Acceleration | Strains
SupportShape = Constraint | Springs | SpringsAlong


def rotated(vectors: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Return vectors (n, 2) rotated by angles (n,) [rad]."""
    return np.asarray(np.cos(angles)[:, None] * vectors + np.sin(angles)[:, None] * across(vectors))
