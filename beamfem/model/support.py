"""The base classes of supports: at a point or along a beam."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping

import numpy as np

from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.shapes import Constraint, Springs, SpringsAlong, SupportShape

DIRECTIONS = ("ux", "uy", "rotation")
Value = float | Callable[[float], float]


class Support(ABC):
    """A connection of beams to the ground: frozen dataclasses that derive from `PointSupport` or `LineSupport`."""

    @property
    @abstractmethod
    def place(self) -> Beam | Point:
        """The supported beam or point."""

    @abstractmethod
    def shapes(self) -> tuple[SupportShape, ...]:
        """Return the shapes to draw."""


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
