"""Friction between two sections, such as those of a hinge."""

from dataclasses import dataclass, field
from typing import ClassVar

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Spiral
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import HINGE_FRICTION
from beamfem.validation import convert, positive, squared


@dataclass(frozen=True, slots=True)
class HingeFriction(BetweenPlaces):
    """Dry friction between two sections, such as those of a `Hinge`: a torsion spring that slips.

    Its moment is k times the change of t_b - t_a since it slipped last, and at most the friction torque (Prandtl 1928),
    in statics from step to step. Its losses are in `solution.energy().dissipated`. Raises InputError for an invalid
    value.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    torque : float, [N m]
        Friction torque > 0, at which it slips.
    stiffness : float, [N m/rad]
        Stiffness k > 0 with which it sticks; the larger, the smaller the steps that it needs.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> rough = bf.HingeFriction(beam.end, post.start, torque=20.0, stiffness=1e5)
    >>> supports, hinge = [bf.Clamp(beam.start), bf.Pin(post.end)], bf.Hinge(beam.end, post.start)
    >>> corner = bf.Model([beam, post], supports, joints=[hinge], connectors=[rough])
    """

    connection = HINGE_FRICTION
    conservative: ClassVar[bool] = False

    a: Point
    b: Point
    torque: float = field(metadata={UNIT: "N m"})
    stiffness: float = field(metadata={UNIT: "N m/rad"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, squared(positive), "torque", "stiffness")

    def shapes(self) -> tuple[Spiral, ...]:
        """Return the shape to draw."""
        return (Spiral(self.a),)
