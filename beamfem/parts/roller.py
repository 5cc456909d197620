"""A roller, also on an inclined plane."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport, Value
from beamfem.validation import convert, squared, vector


@dataclass(frozen=True)
class Roller(PointSupport):
    """Constrain the displacement along a normal only.

    Raises InputError for a zero normal.

    Parameters
    ----------
    point : Point
        The supported point.
    normal : (float, float), [-], default (0, 1)
        Direction of the constraint; its length does not matter.

    Examples
    --------
    >>> inclined = bf.Roller(beam.end, normal=(-1.0, 1.0))
    >>> inclined.direction.round(3)
    array([-0.707,  0.707])
    """

    point: Point
    normal: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "normal")
        if not any(self.normal):
            raise InputError("the normal of a Roller must not be zero")

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"normal": 0.0}

    @property
    def direction(self) -> np.ndarray:
        """Unit normal (2,) [-]."""
        return np.array(self.normal) / np.hypot(*self.normal)
