"""A prismatic joint between two sections."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import ROUGH_SLIDER, SLIDER, Connection
from beamfem.validation import convert, not_negative, positive, squared, vector


@dataclass(frozen=True, slots=True)
class Slider(BetweenPlaces):
    """A prismatic joint: b slides along an axis that turns with a, and keeps its angle to a.

    Its conditions are (r_b - r_a) . n = constant, with the normal n of the axis, and t_b - t_a = 0; its multipliers are
    the force N across the axis [N] and the moment [N m] on a.

    With friction, a spring along the axis holds b until its force reaches friction |N| (Coulomb); then b slips. Its
    losses are in `solution.energy().dissipated`. Raises InputError for an invalid value, or friction without stiffness.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    axis : (float, float), [-]
        Direction of the axis in the reference; its length does not matter.
    friction : float, [-], default 0
        Coefficient of friction >= 0.
    stiffness : float, [N/m], optional
        Stiffness > 0 with which friction sticks; the larger, the smaller the steps that it needs.

    Examples
    --------
    >>> rod = bf.Beam(bf.Line((2, 0), (3, 0)), 2, bf.CRBF(order=3), bf.Rectangle(0.02, 0.02), steel)
    >>> joint = bf.Slider(beam.end, rod.start, axis=(1, 0))
    >>> telescope = bf.Model([beam, rod], [bf.Clamp(beam.start), bf.Pin(rod.end)], connectors=[joint])
    """

    a: Point
    b: Point
    axis: tuple[float, float]
    friction: float = 0.0
    stiffness: float | None = field(default=None, metadata={UNIT: "N/m"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, squared(vector), "axis")
        if not any(self.axis):
            raise InputError("the axis of a Slider must not be zero")
        convert(self, squared(not_negative), "friction")
        if self.friction and self.stiffness is None:
            raise InputError("friction of a Slider needs a stiffness with which it sticks")
        if self.stiffness is not None:
            convert(self, squared(positive), "stiffness")

    @property
    def conservative(self) -> bool:  # type: ignore[override]
        """Whether it is without friction."""
        return self.friction == 0.0

    @property
    def connection(self) -> Connection:
        """A slider, with history only where there is friction."""
        return ROUGH_SLIDER if self.friction else SLIDER

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return the unit normal of the axis, the distance of b from it, and what friction needs."""
        (x, y), apart = np.array(self.axis) / np.hypot(*self.axis), reference[1, :2] - reference[0, :2]
        smooth = -y, x, float(apart @ (-y, x))
        if not self.friction:
            return smooth
        stiffness = self.stiffness or 0.0
        # in the reference, where N is zero, round-off of the distance must not make it slip
        least = 1e-15 * stiffness * float(np.hypot(*apart))
        return (*smooth, self.friction, stiffness, float(apart @ (x, y)), least)
