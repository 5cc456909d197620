"""End stops of the displacement of two sections along an axis, such as that of a slider."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.part_units import UNIT
from beamfem.parts.end_stop import EndStop
from beamfem.physics.connections import BOUNCING_SLIDER_STOP, SLIDER_STOP, Connection
from beamfem.validation import convert, squared, vector


@dataclass(frozen=True, slots=True)
class SliderStop(EndStop):
    """End stops of a `Slider`: stiff one-sided springs that keep b between two limits along an axis that turns with a.

    At the excess d beyond a limit the force is k d (1 + c dd/dt) towards it, or bodies bounce with a coefficient of
    restitution, as off a `HingeStop`. Raises InputError for an invalid value, without a limit, and if low is above
    high.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    axis : (float, float), [-]
        Direction of the axis in the reference; its length does not matter.
    low, high : float, [m], optional
        Limits of the displacement of b along the axis, from the reference; None for no limit on that side.
    stiffness : float, [N/m]
        Stiffness k > 0.
    damping : float, [s/m], default 0
        Damping c; a body that hits at the speed v bounces with about 1 - 2 c v / 3 of it.
    restitution : float, [-], optional
        Coefficient of restitution, above 0 and up to 1, in place of a damping.

    Examples
    --------
    >>> rod = bf.Beam(bf.Line((2, 0), (3, 0)), 2, bf.CRBF(order=3), bf.Rectangle(0.02, 0.02), steel)
    >>> joint = bf.Slider(beam.end, rod.start, axis=(1, 0))
    >>> stop = bf.SliderStop(beam.end, rod.start, axis=(1, 0), low=-0.1, high=0.5, stiffness=1e6, restitution=0.6)
    >>> telescope = bf.Model([beam, rod], [bf.Clamp(beam.start)], joints=[joint], connectors=[stop])
    """

    a: Point
    b: Point
    axis: tuple[float, float]
    low: float | None = field(default=None, metadata={UNIT: "m"})
    high: float | None = field(default=None, metadata={UNIT: "m"})
    stiffness: float = field(kw_only=True, metadata={UNIT: "N/m"})
    damping: float = field(default=0.0, kw_only=True, metadata={UNIT: "s/m"})
    restitution: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        EndStop.__post_init__(self)
        convert(self, squared(vector), "axis")
        if not any(self.axis):
            raise InputError("the axis of a SliderStop must not be zero")

    @property
    def connection(self) -> Connection:
        """End stops, with history only where there is a coefficient of restitution."""
        return SLIDER_STOP if self.restitution is None else BOUNCING_SLIDER_STOP

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness, damping, rebound, both limits from a on, and the axis."""
        x, y = (np.array(self.axis) / np.hypot(*self.axis)).tolist()
        start = float((reference[1, :2] - reference[0, :2]) @ (x, y))
        *others, low, high = EndStop.data(self, reference)
        return *others, low + start, high + start, x, y
