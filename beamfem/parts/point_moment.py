"""A moment at a point."""

from dataclasses import dataclass, field

from beamfem.model.beam import Point
from beamfem.model.load_base import Amplitude, PointLoad
from beamfem.validation import convert, finite, squared


@dataclass(frozen=True)
class PointMoment(PointLoad):
    """Moment, counter-clockwise, conjugate to the rotation of the section: virtual work M dtheta.

    Parameters
    ----------
    point : Point
        Point of application.
    moment : float, [N m]
        Moment.
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the moment grows with the load factor in statics, if it has no amplitude.
    follower : bool, default False
        Accepted for uniformity; in the plane a moment that rotates with the section is the same moment.

    Examples
    --------
    >>> bent = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 1e4)]))
    >>> round(float(bent.rotation(beam.end)[-1]), 5)  # M L / E I
    0.02286
    """

    point: Point
    moment: float = field(metadata={"unit": "N m"})
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(finite), "moment")

    @property
    def value(self) -> tuple[float, float, float]:
        """Force fx, fy [N] and moment [N m]."""
        return (0.0, 0.0, self.moment)
