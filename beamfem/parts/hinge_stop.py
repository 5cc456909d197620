"""End stops of the angle between two sections, such as those of a hinge."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point, require_point_of
from beamfem.model.load_shapes import Spiral
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import PartAtPoints
from beamfem.physics.connections import HINGE_STOP, Connection
from beamfem.validation import convert, finite, not_negative, optional, positive

_NEVER = 1e9  # [rad]


@dataclass(frozen=True, slots=True)
class HingeStop(PartAtPoints):
    """End stops of a hinge: stiff one-sided torsion springs that keep the angle t_b - t_a between two limits.

    At the excess d beyond a limit the moment is k d (1 + c dd/dt) towards it (Hunt and Crossley 1975).

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

    Raises
    ------
    InputError
        For an invalid value, without a limit, and if low is above high.

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

    def __post_init__(self) -> None:
        require_point_of(self, "a")
        require_point_of(self, "b")
        convert(self, optional(finite), "low", "high")
        convert(self, positive, "stiffness")
        convert(self, not_negative, "damping")
        if self.low is None and self.high is None:
            raise InputError("HingeStop needs one of its limits low and high")
        low, high, _, _ = self.data(np.zeros((2, 3)))
        if low > high:
            raise InputError(f"low of HingeStop must not be above high, got {low:g} and {high:g}")

    @property
    def points(self) -> tuple[Point, ...]:
        """Both points."""
        return self.a, self.b

    @property
    def connection(self) -> Connection:
        """End stops."""
        return HINGE_STOP

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return both limits, stiffness and damping."""
        low, high = (-_NEVER if self.low is None else self.low), (_NEVER if self.high is None else self.high)
        return low, high, self.stiffness, self.damping

    def shapes(self) -> tuple[Spiral, ...]:
        """Return the shape to draw."""
        return (Spiral(self.a),)
