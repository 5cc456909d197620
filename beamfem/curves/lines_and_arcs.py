"""Axes of straight lines and circular arcs."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves.curve import Curve, along, piece_at, points, turned, unit, warn_of_turns
from beamfem.errors import InputError
from beamfem.reprs import brief
from beamfem.validation import convert, finite, positive, vector


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


@dataclass(frozen=True)
class Arc(Curve):
    """Circular axis about a center.

    It runs clockwise if end_angle < start_angle; more than a full turn is allowed. Raises InputError if the radius is
    not positive or the angles are equal. Warns with SeveralTurnsWarning for more than one full turn, which angles in
    degrees often cause.

    Parameters
    ----------
    center : (float, float), [m]
        Center (x, y).
    radius : float, [m]
        Radius.
    start_angle, end_angle : float, [rad]
        Angles from the x-axis at which the axis starts and ends.

    Examples
    --------
    >>> quarter = bf.Arc(center=(0, 0), radius=2.0, start_angle=0.0, end_angle=np.pi / 2)
    >>> round(quarter.length, 4)
    3.1416
    """

    center: tuple[float, float]
    radius: float
    start_angle: float
    end_angle: float

    def __post_init__(self) -> None:
        convert(self, vector, "center")
        convert(self, positive, "radius")
        convert(self, finite, "start_angle", "end_angle")
        if self.start_angle == self.end_angle:
            raise InputError(f"an Arc needs two different angles, start_angle and end_angle are both {self.end_angle}")
        warn_of_turns("the arc", self.end_angle - self.start_angle)

    @property
    def length(self) -> float:
        return self.radius * abs(self.end_angle - self.start_angle)

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        angle = self._angle(arc_length)
        return np.array(self.center) + self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        angle = self._angle(arc_length)
        return self._sense * np.stack([-np.sin(angle), np.cos(angle)], axis=1)

    @property
    def _sense(self) -> float:
        """1 if it runs counter-clockwise, -1 clockwise."""
        return float(np.sign(self.end_angle - self.start_angle))

    def _angle(self, arc_length: np.ndarray) -> np.ndarray:
        return self.start_angle + self._sense * np.asarray(arc_length, dtype=float) / self.radius


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

    points: Sequence[Sequence[float]] | np.ndarray

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
        piece = piece_at(self._ends, arc_length)
        fraction = ((arc_length - self._ends[piece]) / np.diff(self._ends)[piece])[:, None]
        table = np.array(self.points)
        return (1.0 - fraction) * table[piece] + fraction * table[piece + 1]

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        return self._directions[piece_at(self._ends, arc_length)]

    @cached_property
    def _ends(self) -> np.ndarray:
        """Arc lengths (n,) [m] of the points."""
        steps = np.diff(np.array(self.points), axis=0)
        return np.append(0.0, np.cumsum(np.hypot(steps[:, 0], steps[:, 1])))

    @cached_property
    def _directions(self) -> np.ndarray:
        """Unit tangents (n - 1, 2) of the segments."""
        return unit(np.diff(np.array(self.points), axis=0))
