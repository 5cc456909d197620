"""A rigid link between two points."""

from dataclasses import dataclass
from typing import ClassVar

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Bar
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import LINK


@dataclass(frozen=True, slots=True)
class Link(BetweenPlaces):
    """A rigid, massless link hinged at two points, which keep the distance l0 that they have in the reference.

    Its condition is (l^2 - l0^2) / (2 l0) = 0, its multiplier the tension [N]. Raises InputError for anything but
    points, and if they coincide in the reference.

    Parameters
    ----------
    a, b : Point
        Points of beams.

    Examples
    --------
    >>> other = bf.Beam(bf.Line((0, 1), (2, 1)), 4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> link, clamps = bf.Link(beam.end, other.end), [bf.Clamp(beam.start), bf.Clamp(other.start)]
    >>> pair = bf.Model([beam, other], clamps, [bf.PointForce(beam.end, (0, -1e4))], connectors=[link])
    >>> tension = bf.solve_static(pair).multipliers(link)[-1, 0]
    """

    connection = LINK
    apart: ClassVar[bool] = True

    a: Point
    b: Point

    def shapes(self) -> tuple[Bar, ...]:
        """Return the shape to draw."""
        return (Bar(self.a, self.b),)
