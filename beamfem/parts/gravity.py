"""Gravity."""

from dataclasses import dataclass, field

from beamfem.model.load_base import Amplitude, BodyLoad
from beamfem.validation import convert, squared, vector


@dataclass(frozen=True)
class Gravity(BodyLoad):
    """Gravity, an acceleration of the mass of every beam.

    Parameters
    ----------
    vector : (float, float), [m/s^2]
        Acceleration (gx, gy).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether gravity grows with the load factor in statics, if it has no amplitude.

    Examples
    --------
    >>> heavy = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -9.81))]))
    >>> heavy.reaction(beam.start)[-1, 1:].round(1)  # fy, m
    array([770.1, 770.1])
    """

    vector: tuple[float, float] = field(metadata={"unit": "m/s^2"})
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector")
        super().__post_init__()
