"""End stops of the angle between two sections, such as those of a hinge."""

from dataclasses import dataclass, field

from beamfem.model.beam import Point
from beamfem.model.load_shapes import Spiral
from beamfem.model.part_units import UNIT
from beamfem.parts.end_stop import EndStop
from beamfem.physics.connections import BOUNCING_HINGE_STOP, HINGE_STOP, Connection


@dataclass(frozen=True, slots=True)
class HingeStop(EndStop):
    """End stops of a hinge: stiff one-sided torsion springs that keep the angle t_b - t_a between two limits.

    At the excess d beyond a limit the moment is k d (1 + c dd/dt) towards it (Hunt and Crossley 1975). With a
    coefficient of restitution e it is k d, and k / e^2 (d - (1 - e^2) d_max) on the way back from the largest excess
    d_max, so that bodies of any mass and speed bounce with e times their relative speed (Walton and Braun 1986). A body
    that is too slow to leave the stop rests in it, by up to (1 - e^2) d_max. Raises InputError for an invalid value,
    without a limit, and if low is above high.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    low, high : float, [rad], optional
        Limits of the angle, from the reference; None for no limit on that side.
    stiffness : float, [N m/rad]
        Stiffness k > 0.
    damping : float, [s/rad], default 0
        Damping c; a body that hits at the angular velocity w bounces with about 1 - 2 c w / 3 of it.
    restitution : float, [-], optional
        Coefficient of restitution e, above 0 and up to 1, in place of a damping.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> stop = bf.HingeStop(beam.end, post.start, low=-0.1, high=0.5, stiffness=1e6)
    >>> supports, hinge = [bf.Clamp(beam.start), bf.Pin(post.end)], bf.Hinge(beam.end, post.start)
    >>> corner = bf.Model([beam, post], supports, joints=[hinge], connectors=[stop])
    """

    a: Point
    b: Point
    low: float | None = field(default=None, metadata={UNIT: "rad"})
    high: float | None = field(default=None, metadata={UNIT: "rad"})
    stiffness: float = field(kw_only=True, metadata={UNIT: "N m/rad"})
    damping: float = field(default=0.0, kw_only=True, metadata={UNIT: "s/rad"})
    restitution: float | None = field(default=None, kw_only=True)

    @property
    def connection(self) -> Connection:
        """End stops, with history only where there is a coefficient of restitution."""
        return HINGE_STOP if self.restitution is None else BOUNCING_HINGE_STOP

    def shapes(self) -> tuple[Spiral, ...]:
        """Return the shape to draw."""
        return (Spiral(self.a),)
