"""A rigid body fixed to a section."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.model.beam import Point, require_point_of
from beamfem.model.load_shapes import Disc
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import PartAtPoints
from beamfem.physics.connections import BODY, Connection
from beamfem.validation import convert, not_negative, positive, vector


@dataclass(frozen=True, slots=True)
class RigidBody(PartAtPoints):
    """A rigid body fixed to a section, with its weight under `Gravity`.

    Its centre of mass is c = R(theta) offset from the point: kinetic energy m |r' + w x c|^2 / 2 + J w^2 / 2.

    Parameters
    ----------
    point : Point
        Point of a beam.
    mass : float, [kg]
        Mass m > 0.
    inertia : float, [kg m^2]
        Moment of inertia J about the centre of mass.
    offset : (float, float), [m], default (0, 0)
        Vector from the point to the centre of mass in the reference, along x and y.

    Raises
    ------
    InputError
        For an invalid value.

    Examples
    --------
    >>> head = bf.RigidBody(beam.end, mass=2.0, inertia=0.01, offset=(0.05, 0.0))
    >>> arm = bf.Model([beam], [bf.Clamp(beam.start)], masses=[head])
    """

    point: Point
    mass: float = field(metadata={UNIT: "kg"})
    inertia: float = field(metadata={UNIT: "kg m^2"})
    offset: tuple[float, float] = field(default=(0.0, 0.0), metadata={UNIT: "m"})

    def __post_init__(self) -> None:
        require_point_of(self, "point")
        convert(self, positive, "mass")
        convert(self, not_negative, "inertia")
        convert(self, vector, "offset")

    @property
    def points(self) -> tuple[Point, ...]:
        """The point."""
        return (self.point,)

    @property
    def connection(self) -> Connection:
        """A body."""
        return BODY

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return mass, inertia, offset and reference position."""
        x, y, _ = reference[0].tolist()
        return (self.mass, self.inertia, float(self.offset[0]), float(self.offset[1]), x, y)

    def shapes(self) -> tuple[Disc, ...]:
        """Return the shape to draw."""
        return (Disc(self.point, self.offset),)
