"""A force at a point."""

from dataclasses import dataclass, field

from beamfem.model.beam import Point
from beamfem.model.load_base import Amplitude, PointLoad
from beamfem.validation import convert, squared, vector


@dataclass(frozen=True)
class PointForce(PointLoad):
    """Force on the axis at a point.

    Parameters
    ----------
    point : Point
        Point of application.
    vector : (float, float), [N]
        Force (fx, fy).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the force grows with the load factor in statics, if it has no amplitude.
    follower : bool, default False
        Whether the force rotates with the section.

    Examples
    --------
    >>> push = bf.PointForce(beam.end, (0.0, -1e4))
    >>> periodic = bf.PointForce(beam.end, (0.0, -1e4), amplitude=lambda time: np.sin(20.0 * time))
    """

    point: Point
    vector: tuple[float, float] = field(metadata={"unit": "N"})
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "vector")

    @property
    def value(self) -> tuple[float, float, float]:
        """Force fx, fy [N] and moment [N m]."""
        return (*self.vector, 0.0)
