"""Drag of a fluid along a beam."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from beamfem.model.beam import Beam, Point, require_beam
from beamfem.model.load_shapes import Bar
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import AtPoint, PartAlongBeam, PartAtPoints
from beamfem.physics.connections import DRAG
from beamfem.validation import convert, not_negative, squared


@dataclass(frozen=True, slots=True)
class DragAtNode(AtPoint):
    """The drag - coefficient |v| v of a node; coefficient [kg/m], with the length that belongs to the node."""

    connection = DRAG

    point: Point
    coefficient: float


@dataclass(frozen=True, slots=True)
class Drag(PartAlongBeam):
    """Drag of a fluid at rest along a beam, -c |v| v per unit length [N/m] at the velocity v.

    It is lumped at the nodes by Gauss-Lobatto quadrature, exact to degree 2 k - 1 on elements of order k. Raises
    InputError for an invalid value.

    Parameters
    ----------
    beam : Beam
        The beam.
    coefficient : float, [kg/m^2]
        Coefficient c >= 0: for a fluid of density rho and drag coefficient C_D of a section of height h, rho C_D h / 2.

    Examples
    --------
    >>> water = bf.Drag(beam, coefficient=0.5 * 1000.0 * 1.2 * 0.1)
    >>> falling = bf.Model([beam], loads=[bf.Gravity((0.0, -9.81))], connectors=[water])
    """

    beam: Beam
    coefficient: float = field(metadata={UNIT: "kg/m^2"})

    def __post_init__(self) -> None:
        require_beam("Drag", self.beam)
        convert(self, squared(not_negative), "coefficient")

    def at_nodes(self, points: Sequence[Point], lengths: np.ndarray) -> tuple[PartAtPoints, ...]:
        """Return the parts at the nodes of the beam, with their tributary lengths (n,) [m]."""
        return tuple(map(DragAtNode, points, (self.coefficient * lengths).tolist()))

    def shapes(self) -> tuple[Bar, ...]:
        """Return the shapes to draw: dots."""
        return tuple(Bar(point, point) for point in map(self.beam.at, (0.25, 0.5, 0.75)))
