"""Concentrated masses and rigid bodies that move with a section."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Disc
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import AtPoint
from beamfem.physics.connections import BODY, MASS, Connection
from beamfem.validation import convert, not_negative, positive, squared


@dataclass(frozen=True, slots=True)
class PointMass(AtPoint):
    """A mass at a point, with its weight under `Gravity`.

    Kinetic energy m |r'|^2 / 2 + J w^2 / 2. Raises InputError for an invalid value.

    Parameters
    ----------
    point : Point
        Point of a beam.
    mass : float, [kg]
        Mass m > 0.
    inertia : float, [kg m^2], default 0
        Moment of inertia J about the point.

    Examples
    --------
    >>> arm = bf.Model([beam], [bf.Clamp(beam.start)], masses=[bf.PointMass(beam.end, mass=5.0)])
    >>> lowest = bf.solve_modes(arm, count=1).frequencies
    """

    point: Point
    mass: float = field(metadata={UNIT: "kg"})
    inertia: float = field(default=0.0, metadata={UNIT: "kg m^2"})

    def __post_init__(self) -> None:
        AtPoint.__post_init__(self)
        convert(self, squared(positive), "mass")
        convert(self, squared(not_negative), "inertia")

    @property
    def connection(self) -> Connection:
        """A mass, or a body if it has a moment of inertia, and only then depends on rotations."""
        return BODY if self.inertia else MASS

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return mass and reference position, of a body also its inertia and no offset."""
        x, y, _ = reference[0].tolist()
        return (self.mass, self.inertia, 0.0, 0.0, x, y) if self.inertia else (self.mass, x, y)

    def shapes(self) -> tuple[Disc, ...]:
        """Return the shape to draw."""
        return (Disc(self.point, (0.0, 0.0)),)
