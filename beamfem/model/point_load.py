"""The base class of forces and moments at points."""

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point, require_point_of
from beamfem.model.load_base import Load
from beamfem.model.load_shapes import Force, LoadShape, Moment
from beamfem.model.state_protocols import Axes, Displaced, Placed, in_plane
from beamfem.validation import called, finite, flag, items, shown, squared


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
    def axes(self) -> Axes:
        """Axes of the force: "section" for a follower load, otherwise "plane"."""
        return "section" if self.follower else "plane"

    @property
    def layout(self) -> tuple[Point, bool]:
        """Where the load acts, and whether it follows the section; see `Load.layout`."""
        return self.point, self.follower

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as all have but follower forces."""
        return not (self.follower and any(self.value[:2]))

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the force and the moment to draw, see `Load.shapes`."""
        force, moment = weight * np.array([[self.value[:2]]]), weight * self.value[2]
        shapes: tuple[LoadShape, ...] = ()
        if any(self.value[:2]):
            shapes = (Force(self.point, in_plane(force, self.axes, placed.at(self.point))[0, 0]),)
        return (*shapes, Moment(self.point, moment)) if self.value[2] else shapes

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        """Return the force and the moment, see `Load.acting`."""
        value = np.array([self.value])
        return {"force": value[:, :2], "moment": value[:, 2:]}

    def work(self, displaced: Displaced) -> np.ndarray:
        """Return the work of the force and of the moment, see `Load.work`."""
        *force, moment = self.value
        work = super().work(displaced)
        if any(force):
            work = displaced.displacement(self.point) @ np.array(force)
        return work + moment * displaced.rotation(self.point) if moment else work

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined load."""
        super().require_valid()
        require_point_of(self)
        flag(f"follower of {type(self).__name__}", self.follower)
        what = f"value of {type(self).__name__}"
        value = called(what, lambda: self.value)
        if callable(value):
            raise InputError(f"{what} must be a field or a property, not a method")
        numbers = [squared(finite)(what, number) for number in items(what, value)]
        if len(numbers) != 3:
            raise InputError(f"{what} must be three numbers, fx, fy and moment, got {shown(value)}")
