"""A cable, which only pulls."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.load_shapes import Coil
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import CABLE, GROUNDED_CABLE, Connection
from beamfem.validation import convert, not_negative, positive, squared


@dataclass(frozen=True, slots=True)
class Cable(BetweenPlaces):
    """A straight, massless cable between two points: its tension is k max(l - l0, 0).

    Raises InputError for an invalid value, if the points coincide in the reference, or if the pretension leaves no
    length.

    Parameters
    ----------
    a : Point
        Point of a beam.
    b : Point or (float, float), [m]
        Point of a beam, or a place on the ground.
    stiffness : float, [N/m]
        Stiffness k > 0, E A / l0.
    pretension : float, [N], default 0
        Tension N0 at the distance L in the reference, so that l0 = L - N0 / k.

    Examples
    --------
    >>> stay = bf.Cable(beam.end, (2.0, 1.0), stiffness=1e6, pretension=100.0)
    >>> mast = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e4))], connectors=[stay])
    """

    apart: ClassVar[bool] = True
    may_end_on_ground: ClassVar[bool] = True

    a: Point
    b: Point | tuple[float, float]
    stiffness: float = field(metadata={UNIT: "N/m"})
    pretension: float = field(default=0.0, metadata={UNIT: "N"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, squared(positive), "stiffness")
        convert(self, squared(not_negative), "pretension")
        most = self.stiffness * self.distance
        if self.pretension >= most:
            raise InputError(
                f"pretension of Cable must be below its stiffness times its length, {most:g}, got {self.pretension:g}"
            )

    @property
    def connection(self) -> Connection:
        """A cable between points, or to the ground."""
        return CABLE if isinstance(self.b, Point) else GROUNDED_CABLE

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness and free length, and the place on the ground if it ends there."""
        length = self.distance - self.pretension / self.stiffness
        own = self.stiffness, length
        return (*own, *self.ground)

    def shapes(self) -> tuple[Coil, ...]:
        """Return the shape to draw."""
        return (Coil(self.a, self.b, straight=True),)
