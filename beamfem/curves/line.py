"""A straight axis."""

import math
from dataclasses import dataclass

import numpy as np

from beamfem.curves.curve import Curve, along
from beamfem.errors import InputError
from beamfem.validation import vector


@dataclass(frozen=True, slots=True)
class Line(Curve):
    """Straight axis.

    Raises InputError if they coincide.

    Parameters
    ----------
    start, end : (float, float), [m]
        Positions (x, y) of the ends.

    Examples
    --------
    >>> bf.Line((0, 0), (3, 4)).length
    5.0
    """

    start: tuple[float, float]
    end: tuple[float, float]

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", vector("start of Line", self.start))
        object.__setattr__(self, "end", vector("end of Line", self.end))
        if self.start == self.end:
            raise InputError(f"a Line needs two different points, start and end are both {self.start}")

    @property
    def length(self) -> float:
        return math.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        fraction = arc_length[:, None] / self.length
        return (1.0 - fraction) * np.array(self.start) + fraction * np.array(self.end)

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        direction = (np.array(self.end) - np.array(self.start)) / self.length
        return np.broadcast_to(direction, (len(arc_length), 2)).copy()
