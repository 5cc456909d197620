"""Outlines of parts of sections, between heights y [m], for the stress over them.

Each is `known` if it ends at `low` and `high`. It has its width [m] at heights, nan where that is not known, the
integrals of 1 [m^2] and y [m^3] below heights, and heights [m] and weights [m^2] of a quadrature.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.quadrature import gauss_between


@dataclass(frozen=True)
class RectangleOutline:
    """A rectangle from low to high [m] with the width `breadth` [m]."""

    breadth: float
    low: float
    high: float
    known: ClassVar[bool] = True

    def width(self, y: np.ndarray) -> np.ndarray:
        return np.full(np.shape(y), self.breadth)

    def below(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        thickness = y - self.low
        return self.breadth * thickness, 0.5 * self.breadth * thickness * (y + self.low)

    def quadrature(self, points: int) -> tuple[np.ndarray, np.ndarray]:
        at, weights = gauss_between(self.low, self.high, points)
        return at, self.breadth * weights


@dataclass(frozen=True)
class TubeOutline:
    """A circular tube with outer and inner radius [m] about the axis; a full circle if inner = 0."""

    outer: float
    inner: float = 0.0
    known: ClassVar[bool] = True

    @property
    def low(self) -> float:
        return -self.outer

    @property
    def high(self) -> float:
        return self.outer

    def width(self, y: np.ndarray) -> np.ndarray:
        return 2.0 * (_half_chord(self.outer, y) - _half_chord(self.inner, y))

    def below(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        outer, inner = _segment(self.outer, y), _segment(self.inner, y)
        return outer[0] - inner[0], outer[1] - inner[1]

    def quadrature(self, points: int) -> tuple[np.ndarray, np.ndarray]:
        heights, weights = _disc_rule(self.outer, points)
        hole, missing = _disc_rule(self.inner, points)
        return np.append(heights, hole), np.append(weights, -missing)


@dataclass(frozen=True)
class StripOutline:
    """A strip from low to high [m] between lines and arcs, of the width a + b y + sum of c sqrt(r^2 - (y - m)^2) [m].

    line: a and b; arcs: c, m and r of each.
    """

    low: float
    high: float
    line: tuple[float, float]
    arcs: tuple[tuple[float, float, float], ...] = ()
    known: ClassVar[bool] = True

    def width(self, y: np.ndarray) -> np.ndarray:
        width = self.line[0] + self.line[1] * y
        return np.asarray(width + sum(c * _half_chord(r, y - m) for c, m, r in self.arcs))

    def below(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        offset, slope = self.line
        powers = [(y**n - self.low**n) / n for n in (1, 2, 3)]
        area, first = (offset * powers[n] + slope * powers[n + 1] for n in (0, 1))
        for c, m, r in self.arcs:
            segment, moment = (a - b for a, b in zip(_segment(r, y - m), _segment(r, self.low - m), strict=True))
            area, first = area + 0.5 * c * segment, first + 0.5 * c * (m * segment + moment)
        return area, first

    def quadrature(self, points: int) -> tuple[np.ndarray, np.ndarray]:
        if not self.arcs:
            heights, weights = gauss_between(self.low, self.high, points)
            return heights, weights * self.width(heights)
        angle, weights = gauss_between(0.0, np.pi, points)  # of a circle: arcs may end upright at the faces
        half = 0.5 * (self.high - self.low)
        heights = self.low + half * (1.0 - np.cos(angle))
        return heights, weights * half * np.sin(angle) * self.width(heights)


@dataclass(frozen=True)
class MomentsOutline:
    """A part of which only the integrals of 1, y, ..., y^4 [m^2 ... m^6] are known.

    known: whether it ends at low and high [m]; otherwise these belong to the equivalent rectangle.
    """

    moments: tuple[float, float, float, float, float]
    low: float
    high: float
    known: bool = True

    def width(self, y: np.ndarray) -> np.ndarray:
        return np.full(np.shape(y), np.nan)

    def below(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the integrals, nan between the two ends, where they are unknown."""
        fraction = np.where(y >= self.high, 1.0, np.where(y <= self.low, 0.0, np.nan))
        return self.moments[0] * fraction, self.moments[1] * fraction

    def quadrature(self, points: int) -> tuple[np.ndarray, np.ndarray]:
        """Return three points about the centroid with the moments up to the second and the central fourth moment.

        The fourth moment is not met if it would put the outer points beyond known faces.
        """
        area, first, second, third, fourth = self.moments
        centroid = first / area
        spread = second - first * centroid
        central = fourth - 4.0 * centroid * third + 6.0 * centroid**2 * second - 3.0 * centroid**4 * area
        reach = np.sqrt(central / spread)
        if self.known:
            reach = min(reach, max(centroid - self.low, self.high - centroid))
        outer = 0.5 * spread / reach**2
        heights = centroid + reach * np.array([-1.0, 0.0, 1.0])
        return heights, np.array([outer, area - 2.0 * outer, outer])


@dataclass(frozen=True)
class Part:
    """A part of a section: its Young's modulus [Pa] and its outline."""

    modulus: float
    outline: RectangleOutline | TubeOutline | StripOutline | MomentsOutline


def _half_chord(radius: float, y: np.ndarray | float) -> np.ndarray:
    return np.sqrt(np.maximum((radius - y) * (radius + y), 0.0))


def _segment(radius: float, y: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Return the area and first moment of the part of a disc below y."""
    at = np.clip(y, -radius, radius)
    chord = _half_chord(radius, at)
    return radius**2 * np.arctan2(chord, -at) + at * chord, -2.0 / 3.0 * chord**3


def _disc_rule(radius: float, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return heights and weights of a Gauss rule over a disc, with Chebyshev points of the second kind."""
    angle = np.pi * np.arange(1, points + 1) / (points + 1)
    return radius * np.cos(angle), 2.0 * np.pi / (points + 1) * (radius * np.sin(angle)) ** 2
