"""Friction between two sections, such as those of a hinge."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from beamfem.model.beam import Point, require_point_of
from beamfem.model.contribution import At
from beamfem.model.load_shapes import Spiral
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import PartAtPoints
from beamfem.physics.connections import HINGE_FRICTION, Connection
from beamfem.validation import convert, positive


@dataclass(frozen=True, slots=True)
class HingeFriction(PartAtPoints):
    """Dry friction between two sections, such as those of a `Hinge`: a torsion spring that slips.

    Its moment is k times the change of t_b - t_a since it slipped last, and at most the friction torque (Prandtl 1928),
    in statics from step to step. Its losses are in `solution.energy().dissipated`.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    torque : float, [N m]
        Friction torque > 0, at which it slips.
    stiffness : float, [N m/rad]
        Stiffness k > 0 with which it sticks; the larger, the smaller the steps that it needs.

    Raises
    ------
    InputError
        For an invalid value.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> rough = bf.HingeFriction(beam.end, post.start, torque=20.0, stiffness=1e5)
    >>> supports, hinge = [bf.Clamp(beam.start), bf.Pin(post.end)], bf.Hinge(beam.end, post.start)
    >>> corner = bf.Model([beam, post], supports, joints=[hinge], connectors=[rough])
    """

    conservative: ClassVar[bool] = False

    a: Point
    b: Point
    torque: float = field(metadata={UNIT: "N m"})
    stiffness: float = field(metadata={UNIT: "N m/rad"})

    def __post_init__(self) -> None:
        require_point_of(self, "a")
        require_point_of(self, "b")
        convert(self, positive, "torque", "stiffness")

    @property
    def points(self) -> tuple[Point, ...]:
        """Both points."""
        return self.a, self.b

    @property
    def connection(self) -> Connection:
        """Friction between two sections."""
        return HINGE_FRICTION

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness and torque."""
        return self.stiffness, self.torque

    def energy(self, at: At) -> tuple[float, float]:
        """Return no kinetic energy, and the potential energy [J] of the spring."""
        turn = at.q[1, 2] - at.q[0, 2] - at.memory[0]
        return 0.0, 0.5 * self.stiffness * turn**2

    def shapes(self) -> tuple[Spiral, ...]:
        """Return the shape to draw."""
        return (Spiral(self.a),)
