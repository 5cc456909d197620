"""A stop: a wall that a point cannot pass."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.load_shapes import Wall
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import AtPoint
from beamfem.parts.end_stop import rebound_of, require_rebound
from beamfem.physics.connections import BOUNCING_STOP, ROUGH_STOP, STOP, Connection
from beamfem.validation import convert, not_negative, squared, vector


@dataclass(frozen=True, slots=True)
class Stop(AtPoint):
    """A straight, rigid wall that keeps a point on the side of its normal, by a stiff one-sided spring with friction.

    At the penetration d = max(-gap, 0) its pressure is k d (1 + c dd/dt) (Hunt and Crossley 1975). Friction sticks with
    the stiffness k and slips at the limit mu k d, in statics from step to step. Bodies may bounce with a coefficient of
    restitution instead, as off a `HingeStop`. Raises InputError for an invalid value, or a normal of zero.

    Parameters
    ----------
    point : Point
        Point of a beam.
    place : (float, float), [m]
        A place on the wall.
    normal : (float, float), [-]
        Normal of the wall, towards the side on which the point may be; its length does not matter.
    stiffness : float, [N/m]
        Stiffness k > 0.
    damping : float, [s/m], default 0
        Damping c; a body that hits at the speed v bounces with about 1 - 2 c v / 3 of it.
    friction : float, [-], default 0
        Coefficient of friction mu.
    restitution : float, [-], optional
        Coefficient of restitution, above 0 and up to 1, in place of damping and friction.

    Examples
    --------
    >>> table = bf.Stop(beam.end, place=(0.0, -0.01), normal=(0, 1), stiffness=1e8, friction=0.3)
    >>> held = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e4))], connectors=[table])
    >>> round(float(bf.solve_static(held).displacement(beam.end)[-1, 1]), 4)
    -0.0101
    """

    point: Point
    place: tuple[float, float] = field(metadata={UNIT: "m"})
    normal: tuple[float, float]
    stiffness: float = field(metadata={UNIT: "N/m"})
    damping: float = field(default=0.0, metadata={UNIT: "s/m"})
    friction: float = 0.0
    restitution: float | None = None

    def __post_init__(self) -> None:
        AtPoint.__post_init__(self)
        convert(self, squared(vector), "place")
        convert(self, squared(vector), "normal")
        require_rebound(self)
        convert(self, squared(not_negative), "friction")
        if self.restitution is not None and self.friction:
            raise InputError("Stop takes a coefficient of restitution or friction, got both")
        if not any(self.normal):
            raise InputError("the normal of a Stop must not be zero")

    @property
    def conservative(self) -> bool:  # type: ignore[override]
        """Whether its force at rest has a potential: without friction and loss."""
        return self.friction == 0.0 and self.restitution is None

    @property
    def connection(self) -> Connection:
        """A wall, with history only where there is friction or a coefficient of restitution."""
        return ROUGH_STOP if self.friction else STOP if self.restitution is None else BOUNCING_STOP

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness, damping, rebound, friction, place, unit normal, and the point in the reference."""
        nx, ny = (np.array(self.normal) / np.hypot(*self.normal)).tolist()
        x, y, _ = reference[0].tolist()
        return self.stiffness, self.damping, rebound_of(self), self.friction, *self.place, nx, ny, x, y

    def shapes(self) -> tuple[Wall, ...]:
        """Return the shape to draw."""
        return (Wall(self.place, self.normal),)
