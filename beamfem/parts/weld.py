"""A rigid connection of two sections that are apart."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Bar
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import WELD


@dataclass(frozen=True, slots=True)
class Weld(BetweenPlaces):
    """A rigid, massless connection of two sections that may be apart, such as over a rigid body between two beams.

    Its conditions are r_b - r_a = R(t_a) d, with the vector d between them in the reference, and t_b - t_a = 0; its
    multipliers are the force [N] in the axes of a and the moment [N m], both on a. `Rigid` joins coincident points.
    Raises InputError for anything but points, and if they coincide in the reference.

    Parameters
    ----------
    a, b : Point
        Points of beams.

    Examples
    --------
    >>> shelf = bf.Beam(bf.Line((2.2, 0.1), (3, 0.1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> block, weld = bf.RigidBody(beam.end, mass=5.0, inertia=0.02, offset=(0.1, 0.05)), bf.Weld(beam.end, shelf.start)
    >>> welded = bf.Model([beam, shelf], [bf.Clamp(beam.start)], connectors=[weld], masses=[block])
    """

    connection = WELD
    apart: ClassVar[bool] = True

    a: Point
    b: Point

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return the vector from a to b in the reference."""
        x, y = (reference[1, :2] - reference[0, :2]).tolist()
        return x, y

    def shapes(self) -> tuple[Bar, ...]:
        """Return the shape to draw."""
        return (Bar(self.a, self.b),)
