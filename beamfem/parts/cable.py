"""A cable, which only pulls."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point, require_point_of
from beamfem.model.load_shapes import Coil
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import PartAtPoints
from beamfem.parts.distance import reference_distance
from beamfem.physics.connections import CABLE, GROUNDED_CABLE, Connection
from beamfem.validation import convert, not_negative, positive, vector


@dataclass(frozen=True, slots=True)
class Cable(PartAtPoints):
    """A straight, massless cable between two points: its tension is k max(l - l0, 0).

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

    Raises
    ------
    InputError
        For an invalid value, if the points coincide in the reference, or if the pretension leaves no length.

    Examples
    --------
    >>> stay = bf.Cable(beam.end, (2.0, 1.0), stiffness=1e6, pretension=100.0)
    >>> mast = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e4))], connectors=[stay])
    """

    a: Point
    b: Point | tuple[float, float]
    stiffness: float = field(metadata={UNIT: "N/m"})
    pretension: float = field(default=0.0, metadata={UNIT: "N"})

    def __post_init__(self) -> None:
        require_point_of(self, "a")
        if not isinstance(self.b, Point):
            convert(self, vector, "b")
        convert(self, positive, "stiffness")
        convert(self, not_negative, "pretension")
        distance = reference_distance(self.a, self.b)
        if distance == 0.0:
            raise InputError(f"Cable needs two places that are apart, but a and b are both at {self.a}")
        if self.pretension >= self.stiffness * distance:
            most = self.stiffness * distance
            raise InputError(
                f"pretension of Cable must be below its stiffness times its length, {most:g}, got {self.pretension:g}"
            )

    @property
    def points(self) -> tuple[Point, ...]:
        """Its points on beams."""
        return (self.a, self.b) if isinstance(self.b, Point) else (self.a,)

    @property
    def connection(self) -> Connection:
        """A cable between points, or to the ground."""
        return CABLE if isinstance(self.b, Point) else GROUNDED_CABLE

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness and free length, and the place on the ground if it ends there."""
        length = reference_distance(self.a, self.b) - self.pretension / self.stiffness
        own = self.stiffness, length
        return own if isinstance(self.b, Point) else (*own, *map(float, self.b))

    def shapes(self) -> tuple[Coil, ...]:
        """Return the shape to draw."""
        return (Coil(self.a, self.b, straight=True),)
