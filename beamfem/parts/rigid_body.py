"""A rigid body fixed to a section."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.curves import Line
from beamfem.element.element import CRBF
from beamfem.model.beam import Beam, Point
from beamfem.model.load_shapes import Disc
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import AtPoint
from beamfem.parts.rigid import Rigid
from beamfem.parts.weld import Weld
from beamfem.physics.connections import BODY
from beamfem.section import StiffnessSection
from beamfem.validation import convert, not_negative, positive, squared, vector


@dataclass(frozen=True, slots=True)
class RigidBody(AtPoint):
    """A rigid body fixed to a section, with its weight under `Gravity`.

    Its centre of mass is c = R(theta) offset from the point: kinetic energy m |r' + w x c|^2 / 2 + J w^2 / 2. Raises
    InputError for an invalid value.

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

    Examples
    --------
    >>> head = bf.RigidBody(beam.end, mass=2.0, inertia=0.01, offset=(0.05, 0.0))
    >>> arm = bf.Model([beam], [bf.Clamp(beam.start)], masses=[head])
    """

    connection = BODY

    point: Point
    mass: float = field(metadata={UNIT: "kg"})
    inertia: float = field(metadata={UNIT: "kg m^2"})
    offset: tuple[float, float] = field(default=(0.0, 0.0), metadata={UNIT: "m"})

    def __post_init__(self) -> None:
        AtPoint.__post_init__(self)
        convert(self, squared(positive), "mass")
        convert(self, squared(not_negative), "inertia")
        convert(self, squared(vector), "offset")

    def at(self, x: float, y: float) -> Point:
        """Return a point of the body, at (x, y) [m] from its `point` in the reference, for any other part.

        It is the end of a rigid arm, one of `model.beams` where a part is attached to it; two calls return two arms.

        >>> lid = bf.RigidBody(beam.end, mass=2.0, inertia=0.01, offset=(0.05, 0.0))
        >>> stay = bf.SpringDamper(lid.at(0.1, 0.05), (2.5, 1.0), stiffness=1e4, length=0.5)
        >>> closed = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], connectors=[stay], masses=[lid]))
        """
        place = vector("point of a RigidBody", (x, y))
        if not any(place):
            return self.point
        start, own = self.point.reference, self.point.beam
        axis = Line(tuple(start.tolist()), tuple((start + place).tolist()))
        stiffness = own.section_at(self.point.fraction * own.curve.length).rigidity(own.material)
        mass = _NO_MASS * self.mass / axis.length
        rigidity = stiffness.axial, stiffness.shear, stiffness.bending
        section = StiffnessSection(*rigidity, mass, mass * axis.length**2)
        return Arm(axis, 1, CRBF(1), section, body=self).end

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return mass, inertia, offset and reference position."""
        x, y, _ = reference[0].tolist()
        return (self.mass, self.inertia, float(self.offset[0]), float(self.offset[1]), x, y)

    def shapes(self) -> tuple[Disc, ...]:
        """Return the shape to draw."""
        return (Disc(self.point, self.offset),)


_NO_MASS = 1e-15  # that of an arm relative to its body: beams must have mass


@dataclass(frozen=True, eq=False)
class Arm(Beam):
    """A beam from the point of a rigid body to another one, without strain and mass."""

    body: RigidBody = field(kw_only=True)

    @property
    def holding(self) -> tuple[Rigid, Weld]:
        """What makes it rigid, and joins it with the body."""
        return Rigid(self.body.point, self.start), Weld(self.start, self.end)
