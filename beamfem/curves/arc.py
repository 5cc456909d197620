"""A circular axis."""

from dataclasses import dataclass

import numpy as np

from beamfem.curves.curve import Curve, along, warn_of_turns
from beamfem.errors import InputError
from beamfem.validation import convert, finite, positive, vector


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
