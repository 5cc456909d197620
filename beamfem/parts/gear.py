"""A gear between two sections."""

from dataclasses import dataclass

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import GEAR
from beamfem.validation import convert, finite, squared


@dataclass(frozen=True, slots=True)
class Gear(BetweenPlaces):
    """A gear between two sections: the rotation of b from the reference is `ratio` times that of a.

    Its condition is t_b - ratio t_a = 0, its multiplier the moment [N m] that b exerts on it, opposite to the one on b.
    Raises InputError for an invalid value, or a ratio of zero.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    ratio : float, [-]
        Transmission ratio, negative if both turn in opposite directions.

    Examples
    --------
    >>> shaft = bf.Beam(bf.Line((0, 1), (2, 1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> gear = bf.Gear(beam.start, shaft.start, ratio=-2.0)
    >>> pins = [bf.Pin(beam.start), bf.Pin(beam.end), bf.Pin(shaft.start), bf.Pin(shaft.end)]
    >>> geared = bf.Model([beam, shaft], pins, [bf.PointMoment(beam.start, 10.0)], connectors=[gear])
    """

    connection = GEAR

    a: Point
    b: Point
    ratio: float

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, squared(finite), "ratio")
        if self.ratio == 0.0:
            raise InputError("the ratio of a Gear must not be zero")
