"""A torsion spring with a damper between two sections."""

from dataclasses import dataclass, field

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Spiral
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import TORSION_SPRING
from beamfem.validation import convert, not_negative, squared


@dataclass(frozen=True, slots=True)
class TorsionSpring(BetweenPlaces):
    """A torsion spring and damper between two sections, such as those of a `Hinge`.

    Its moment is k (tb - ta) + c d(tb - ta)/dt, with the rotations ta and tb from the reference. Raises InputError for
    an invalid value.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    stiffness : float, [N m/rad]
        Stiffness k >= 0.
    damping : float, [N m s/rad], default 0
        Damping c >= 0.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> stiff = bf.TorsionSpring(beam.end, post.start, stiffness=1e4)
    >>> supports, hinge = [bf.Clamp(beam.start), bf.Pin(post.end)], bf.Hinge(beam.end, post.start)
    >>> corner = bf.Model([beam, post], supports, joints=[hinge], connectors=[stiff])
    """

    connection = TORSION_SPRING

    a: Point
    b: Point
    stiffness: float = field(metadata={UNIT: "N m/rad"})
    damping: float = field(default=0.0, metadata={UNIT: "N m s/rad"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, squared(not_negative), "stiffness", "damping")

    def shapes(self) -> tuple[Spiral, ...]:
        """Return the shape to draw."""
        return (Spiral(self.a),)
