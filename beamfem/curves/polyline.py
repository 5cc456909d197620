"""An axis of straight segments."""

from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves.curve import Curve, along, points, turned, unit
from beamfem.errors import InputError
from beamfem.reprs import brief


@dataclass(frozen=True)
class Polyline(Curve):
    """Straight axis from point to point, with a corner wherever the direction changes.

    Raises InputError for fewer than two points, or if two consecutive ones coincide.

    Parameters
    ----------
    points : sequence of (float, float), [m], (n, 2)
        Points in order.

    Examples
    --------
    >>> bf.Polyline([(0, 0), (1, 0), (1, 1)]).corners
    (1.0,)
    """

    points: tuple[tuple[float, float], ...]

    __repr__ = brief

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", points("points", self.points))
        if len(self.points) < 2:
            raise InputError(f"a Polyline needs at least two points, got {len(self.points)}")
        for i, (one, other) in enumerate(zip(self.points, self.points[1:], strict=False)):
            if one == other:
                raise InputError(f"points {i} and {i + 1} of a Polyline are both {one}; leave one of them out")

    @property
    def length(self) -> float:
        return float(self._ends[-1])

    @property
    def corners(self) -> tuple[float, ...]:
        return tuple(self._ends[1:-1][turned(self._directions[:-1], self._directions[1:])].tolist())

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        piece = self._piece(arc_length)
        fraction = ((arc_length - self._ends[piece]) / np.diff(self._ends)[piece])[:, None]
        table = np.array(self.points)
        return (1.0 - fraction) * table[piece] + fraction * table[piece + 1]

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        return self._directions[self._piece(arc_length)]

    @cached_property
    def _ends(self) -> np.ndarray:
        """Arc lengths (n,) [m] of the points."""
        steps = np.diff(np.array(self.points), axis=0)
        return np.append(0.0, np.cumsum(np.hypot(steps[:, 0], steps[:, 1])))

    @cached_property
    def _directions(self) -> np.ndarray:
        """Unit tangents (n - 1, 2) of the segments."""
        return unit(np.diff(np.array(self.points), axis=0))

    def _piece(self, arc_length: np.ndarray) -> np.ndarray:
        return np.clip(np.searchsorted(self._ends, arc_length, side="right") - 1, 0, len(self._ends) - 2)
