"""A rigid link between two points."""

from dataclasses import dataclass

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Bar
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import LINK, Connection


@dataclass(frozen=True, slots=True)
class Link(BetweenPlaces):
    """A rigid, massless link hinged at two points, which keep the distance l0 that they have in the reference.

    Its condition is (l^2 - l0^2) / (2 l0) = 0, its multiplier the tension [N].

    Parameters
    ----------
    a, b : Point
        Points of beams.

    Raises
    ------
    InputError
        For anything but points, and if they coincide in the reference.

    Examples
    --------
    >>> other = bf.Beam(bf.Line((0, 1), (2, 1)), 4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> link, clamps = bf.Link(beam.end, other.end), [bf.Clamp(beam.start), bf.Clamp(other.start)]
    >>> pair = bf.Model([beam, other], clamps, [bf.PointForce(beam.end, (0, -1e4))], connectors=[link])
    >>> tension = bf.solve_static(pair).multipliers(link)[-1, 0]
    """

    a: Point
    b: Point

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        self.require_apart()

    @property
    def connection(self) -> Connection:
        """A link."""
        return LINK

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return the length."""
        return (self.distance,)

    def shapes(self) -> tuple[Bar, ...]:
        """Return the shape to draw."""
        return (Bar(self.a, self.b),)
