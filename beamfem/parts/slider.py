"""A prismatic joint between two sections."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import SLIDER, Connection
from beamfem.validation import convert, squared, vector


@dataclass(frozen=True, slots=True)
class Slider(BetweenPlaces):
    """A prismatic joint: b slides along an axis that turns with a, and keeps its angle to a.

    Its conditions are (r_b - r_a) . n = constant, with the normal n of the axis, and t_b - t_a = 0; its multipliers are
    the force across the axis [N] and the moment [N m].

    Parameters
    ----------
    a, b : Point
        Points of beams.
    axis : (float, float), [-]
        Direction of the axis in the reference; its length does not matter.

    Raises
    ------
    InputError
        For an invalid value.

    Examples
    --------
    >>> rod = bf.Beam(bf.Line((2, 0), (3, 0)), 2, bf.CRBF(order=3), bf.Rectangle(0.02, 0.02), steel)
    >>> joint = bf.Slider(beam.end, rod.start, axis=(1, 0))
    >>> telescope = bf.Model([beam, rod], [bf.Clamp(beam.start), bf.Pin(rod.end)], connectors=[joint])
    """

    a: Point
    b: Point
    axis: tuple[float, float]

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, squared(vector), "axis")
        if not any(self.axis):
            raise InputError("the axis of a Slider must not be zero")

    @property
    def connection(self) -> Connection:
        """A slider."""
        return SLIDER

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return the unit normal of the axis and the distance of b from it."""
        x, y = np.array(self.axis) / np.hypot(*self.axis)
        return -y, x, float((reference[1, :2] - reference[0, :2]) @ (-y, x))
