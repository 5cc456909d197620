"""A spring with a damper, straight between two points or from a point to the ground."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Coil
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import GROUNDED_SPRING, SPRING, Connection
from beamfem.validation import convert, not_negative, optional


@dataclass(frozen=True, slots=True)
class SpringDamper(BetweenPlaces):
    """A straight spring and damper between two points: its force is k (l - l0) + c dl/dt along the line between them.

    Parameters
    ----------
    a : Point
        Point of a beam.
    b : Point or (float, float), [m]
        Point of a beam, or a place on the ground.
    stiffness : float, [N/m]
        Stiffness k >= 0.
    damping : float, [N s/m], default 0
        Damping c >= 0.
    length : float, [m], optional
        Length l0 free of force, by default the distance in the reference.

    Raises
    ------
    InputError
        For an invalid value, and if the points coincide in the reference.

    Examples
    --------
    >>> stay = bf.SpringDamper(beam.end, (2.0, 1.0), stiffness=1e5, damping=10.0)
    >>> stayed = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e4))], connectors=[stay])
    """

    may_end_on_ground: ClassVar[bool] = True

    a: Point
    b: Point | tuple[float, float]
    stiffness: float = field(metadata={UNIT: "N/m"})
    damping: float = field(default=0.0, metadata={UNIT: "N s/m"})
    length: float | None = field(default=None, metadata={UNIT: "m"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, not_negative, "stiffness", "damping")
        convert(self, optional(not_negative), "length")
        self.require_apart()

    @property
    def connection(self) -> Connection:
        """A spring between points, or to the ground."""
        return SPRING if isinstance(self.b, Point) else GROUNDED_SPRING

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness, damping and free length, and the place on the ground if it ends there."""
        length = self.distance if self.length is None else self.length
        own = self.stiffness, self.damping, length
        return (*own, *self.ground)

    def shapes(self) -> tuple[Coil, ...]:
        """Return the shape to draw."""
        return (Coil(self.a, self.b),)
