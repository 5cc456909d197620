"""The base class of joints at coincident points; those that slide or keep a distance are in `physics.connections`."""

from typing import ClassVar

from beamfem.model.beam import Point, require_point_of
from beamfem.model.load_shapes import JointShape, Ring
from beamfem.validation import flag


class Joint:
    """Two coincident points a and b of beams with a common position and, if it keeps the angle, a common rotation."""

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
        Joint.__post_init__(self)
        flag(f"keeps_angle of {type(self).__name__}", self.keeps_angle)
