"""Joints between beams."""

from dataclasses import dataclass
from typing import ClassVar

from beamfem.model.beam import Point, require_point_of
from beamfem.model.load_shapes import JointShape, Ring
from beamfem.validation import flag


class Joint:
    """Two coincident points of beams with a common position.

    Attributes
    ----------
    a, b : Point
        The points.
    keeps_angle : bool
        Whether their rotations are equal too.
    """

    __slots__ = ()
    keeps_angle: ClassVar[bool] = False

    a: Point
    b: Point

    def __post_init__(self) -> None:
        require_point_of(self, "a")
        require_point_of(self, "b")

    def shapes(self) -> tuple[JointShape, ...]:
        """Return the shapes to draw: a ring if the joint is a hinge, otherwise none."""
        return () if self.keeps_angle else (Ring(self.a),)

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined joint."""
        require_point_of(self, "a")
        require_point_of(self, "b")
        flag(f"keeps_angle of {type(self).__name__}", self.keeps_angle)


@dataclass(frozen=True, slots=True)
class Rigid(Joint):
    """Join two points rigidly: displacement and rotation are the same, at any angle between the beams.

    Parameters
    ----------
    a, b : Point
        Coincident points of beams.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> angle = bf.Model([beam, post], [bf.Clamp(beam.start)], joints=[bf.Rigid(beam.end, post.start)])
    """

    keeps_angle: ClassVar[bool] = True

    a: Point
    b: Point


@dataclass(frozen=True, slots=True)
class Hinge(Joint):
    """Join two points by a hinge: the displacement is the same, the rotations are independent.

    Parameters
    ----------
    a, b : Point
        Coincident points of beams.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> supports = [bf.Clamp(beam.start), bf.Pin(post.end)]
    >>> hinged = bf.Model([beam, post], supports, joints=[bf.Hinge(beam.end, post.start)])
    """

    a: Point
    b: Point
