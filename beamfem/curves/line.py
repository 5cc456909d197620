"""A straight axis."""

import math
from dataclasses import dataclass

import numpy as np

from beamfem.curves.curve import along
from beamfem.errors import InputError
from beamfem.validation import vector


@dataclass(frozen=True, slots=True)
class Line:
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
        """Length of the axis [m]."""
        return math.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    @property
    def corners(self) -> tuple[float, ...]:
        """Arc lengths (k,) [m] of the corners between the two ends, at which the tangent jumps."""
        return ()

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the positions (n, 2) [m] at arc lengths (n,) [m] from the start, see `Curve.position`."""
        fraction = arc_length[:, None] / self.length
        return (1.0 - fraction) * np.array(self.start) + fraction * np.array(self.end)

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the unit tangents (n, 2) [-] at arc lengths (n,) [m] from the start, see `Curve.tangent`."""
        direction = (np.array(self.end) - np.array(self.start)) / self.length
        return np.broadcast_to(direction, (len(arc_length), 2)).copy()
