"""Joints between beams."""

from dataclasses import dataclass
from typing import ClassVar

from beamfem.model.beam import Point, require_point
from beamfem.model.shapes import Ring


class Joint:
    """Two coincident points `a` and `b` of beams with a common position; keeps_angle: their rotations are equal too."""

    __slots__ = ()
    keeps_angle: ClassVar[bool] = False

    a: Point
    b: Point

    def __post_init__(self) -> None:
        kind = type(self).__name__
        require_point(kind, getattr(self, "a", None), "a")
        require_point(kind, getattr(self, "b", None), "b")

    def shapes(self) -> tuple[Ring, ...]:
        """Return its shapes: a ring if the angle may change."""
        return () if self.keeps_angle else (Ring(self.a),)


@dataclass(frozen=True, slots=True)
class Rigid(Joint):
    """Join two points so that displacement and rotation are the same, at whatever angle the beams meet."""

    keeps_angle: ClassVar[bool] = True

    a: Point
    b: Point


@dataclass(frozen=True, slots=True)
class Hinge(Joint):
    """Join two points so that the displacement is the same; the rotations are independent."""

    a: Point
    b: Point
