"""A force that moves along a beam."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from beamfem.model.beam import Beam
from beamfem.model.load_base import Amplitude, MovingLoad
from beamfem.validation import convert, function_of_one, function_value, squared, vector


@dataclass(frozen=True)
class MovingForce(MovingLoad):
    """A force on the axis that moves along a beam, such as that of a wheel; off the beam there is none.

    The nodal forces are exact at each position. The section forces of the element on which it stands are those of a
    distributed load with the same resultant. Raises InputError for an invalid value.

    Parameters
    ----------
    beam : Beam
        The beam.
    position : callable, [m]
        Arc length from the start as a function of time [s], or of the load factor in statics.
    vector : (float, float), [N]
        Force (fx, fy).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default False
        Whether the force grows with the load factor in statics, if it has no amplitude.

    Examples
    --------
    >>> wheel = bf.MovingForce(beam, lambda time: 10.0 * time, (0.0, -1e4))
    >>> crossed = bf.simulate(model.with_loads([wheel]), duration=0.2, step=1e-3)
    """

    beam: Beam
    position: Callable[[float], float] = field(metadata={"unit": "m"})
    vector: tuple[float, float] = field(metadata={"unit": "N"})
    amplitude: Amplitude = None
    scale: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        function_of_one("position of MovingForce", self.position, "time")
        convert(self, squared(vector), "vector")

    def place_at(self, time: float) -> float:
        """Return the arc length [m] at a time [s] or load factor, see `MovingLoad.place_at`."""
        return function_value("position of MovingForce", self.position, time)

    def moved(self, position: Callable[[float], float]) -> "MovingForce":
        """Return the load at other positions, see `MovingLoad.moved`."""
        return replace(self, position=position)
