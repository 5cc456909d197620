"""An axis along a B-spline, rational (NURBS) or not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves.arc_length import ArcLength, measure
from beamfem.curves.curve import Curve, along, numbers, points, turned, unit
from beamfem.errors import InputError
from beamfem.reprs import brief
from beamfem.validation import convert, count, optional, positive


@dataclass(frozen=True)
class BSpline(Curve):
    """Axis along a B-spline, rational (NURBS) or not, by arc length.

    The axis is r(u) = sum N_i(u) w_i P_i / sum N_i(u) w_i. An interior knot that appears as often as the degree, and at
    which the tangent jumps, is a corner. Raises InputError for data that is not a connected spline, and if dr/du
    vanishes (a cusp). Source: L. Piegl, W. Tiller, The NURBS Book, 2nd ed., Springer 1997, chapters 2 to 4.

    Parameters
    ----------
    degree : int
        Degree of the pieces.
    knots : sequence of float, (n + degree + 1,)
        Non-decreasing knots, clamped or not; u runs from knots[degree] to knots[n].
    control_points : sequence, [m], (n, 2)
        Control points P.
    weights : sequence of float, [-], (n,), optional
        Weights w > 0, by default 1.

    Examples
    --------
    >>> spline = bf.BSpline(2, [0, 0, 0, 1, 1, 1], [(0, 0), (1, 1), (2, 0)])
    >>> round(spline.length, 4)
    2.2956
    """

    degree: int
    knots: Sequence[float] | np.ndarray
    control_points: Sequence[Sequence[float]] | np.ndarray
    weights: Sequence[float] | np.ndarray | None = None

    __repr__ = brief

    def __post_init__(self) -> None:
        convert(self, count, "degree")
        object.__setattr__(self, "knots", numbers("knots", self.knots))
        object.__setattr__(self, "control_points", points("control_points", self.control_points))
        object.__setattr__(self, "weights", optional(numbers)("weights", self.weights))
        self._check_counts()
        self._check_knots()
        _ = self._arc_length  # refuses cusps

    @property
    def length(self) -> float:
        return self._arc_length.length

    @cached_property
    def corners(self) -> tuple[float, ...]:
        inner = self.breaks[1:-1]
        ends = inner[[self.multiplicity(u) == self.degree for u in inner]] if len(inner) else inner
        jumps = turned(unit(self.derivative(np.nextafter(ends, -np.inf))), unit(self.derivative(ends)))
        return tuple(self._arc_length.at(ends[jumps]).tolist())

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        return self.evaluate(self.parameter(arc_length))

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        return unit(self.derivative(self.parameter(arc_length)))

    def parameter(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the parameters u (n,) at arc lengths (n,) [m] to round-off; beyond the ends, that of the nearer."""
        return self._arc_length.parameter(arc_length)

    def arc_length(self, u: np.ndarray) -> np.ndarray:
        """Return the arc lengths (n,) [m] at parameters u (n,), to round-off.

        >>> spline = bf.BSpline(2, [0, 0, 0, 1, 1, 1], [(0, 0), (1, 1), (2, 0)])
        >>> spline.arc_length(np.array([0.5, 1.0])).round(4)
        array([1.1478, 2.2956])
        """
        return self._arc_length.at(u)

    @cached_property
    def breaks(self) -> np.ndarray:
        """Distinct knots (m + 1,) from the start to the end, between which the m knot spans lie."""
        inside = np.array(self.knots[self.degree : len(self.control_points) + 1])
        return np.unique(inside)

    def multiplicity(self, knot: float) -> int:
        """Return how many times a number occurs among the knots."""
        return tuple(self.knots).count(float(knot))

    def evaluate(self, u: np.ndarray) -> np.ndarray:
        """Return the positions r(u) (n, 2) [m] at parameters (n,); beyond the ends, that of the nearer end.

        >>> spline = bf.BSpline(2, [0, 0, 0, 1, 1, 1], [(0, 0), (1, 1), (2, 0)])
        >>> spline.evaluate(np.array([0.5]))
        array([[1. , 0.5]])
        """
        return np.array(self.control_points[0]) + self._homogeneous(u)[0]

    def derivative(self, u: np.ndarray) -> np.ndarray:
        """Return dr/du (n, 2) [m] at parameters (n,); where it jumps at a knot, the one after it.

        Parameters outside knots[degree] to knots[n] are taken as the nearer end.
        """
        position, rate, weight = self._homogeneous(u)
        return (rate[:, :2] - rate[:, 2:] * position) / weight

    def hermite(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return parameters (m + 1,), positions [m] and derivatives dr/du [m] (m + 1, 2) at the ends of the knot spans.

        Between two ends the spline is the cubic with these values and derivatives. Raises InputError unless the degree
        is 3, all weights are equal, and no interior knot occurs more than twice.
        """
        advice = (
            "a cubic close to it goes through positions and tangents at arc lengths s: "
            "spline_through_hermite(s, curve.position(s), curve.tangent(s))"
        )
        if self.degree != 3:
            raise InputError(
                f"only a spline of degree 3 is one cubic a span, this one has degree {self.degree}", remedy=advice
            )
        if self.weights is not None and len(set(self.weights)) > 1:
            raise InputError("a spline with different weights is a quotient of cubics, not a cubic", remedy=advice)
        for knot in self.breaks[1:-1]:
            if self.multiplicity(knot) > 2:
                raise InputError(
                    f"the derivative may jump at knot {knot:g}, which appears {self.multiplicity(knot)} times; a cubic "
                    f"through values and derivatives needs it at most twice: split the spline there"
                )
        return self.breaks.copy(), self.evaluate(self.breaks), self.derivative(self.breaks)

    @cached_property
    def _arc_length(self) -> ArcLength:
        size = float(np.abs(np.array(self.control_points)).max())
        return measure(self.derivative, self.breaks, size, "u = {:g}".format)

    @cached_property
    def _spline(self) -> Any:
        """Spline of (w x, w y, w), x and y from the first control point: drawings lie far from their origin."""
        from scipy.interpolate import BSpline as Spline  # slow to import, and most models are straight

        weights = np.ones(len(self.control_points)) if self.weights is None else np.array(self.weights)
        control = np.array(self.control_points) - self.control_points[0]
        table = np.column_stack([weights[:, None] * control, weights])
        return Spline(np.array(self.knots), table, self.degree)

    def _homogeneous(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return r relative to the first control point, the derivatives of (w x, w y, w), and w at parameters (n,)."""
        start, end = self.breaks[0], self.breaks[-1]
        if self.multiplicity(end) > 1 and self.knots[len(self.control_points) - 1] == end:
            end = np.nextafter(end, start)  # the span that would be evaluated at the end is empty
        u = np.clip(u, start, end)
        value = self._spline(u)
        return value[:, :2] / value[:, 2:], self._spline(u, nu=1), value[:, 2:]

    def _check_counts(self) -> None:
        size, knots = len(self.control_points), len(self.knots)
        if size < self.degree + 1:
            raise InputError(f"control_points: degree {self.degree} needs at least {self.degree + 1}, got {size}")
        if knots != size + self.degree + 1:
            raise InputError(
                f"knots: {size} control points of degree {self.degree} need {size + self.degree + 1}, got {knots}"
            )
        if self.weights is not None:
            if len(self.weights) != size:
                raise InputError(f"weights: {size} control points need {size}, got {len(self.weights)}")
            for i, weight in enumerate(self.weights):
                positive(f"weights[{i}]", weight)

    def _check_knots(self) -> None:
        for i, (one, other) in enumerate(zip(self.knots, self.knots[1:], strict=False)):
            if other < one:
                raise InputError(f"knots must not decrease: knots[{i + 1}] is {other}, knots[{i}] is {one}")
        if len(self.breaks) < 2:
            raise InputError(f"knots[{self.degree}] to knots[{len(self.control_points)}], where u runs, are all equal")
        for knot in set(self.knots):
            inside = self.breaks[0] < knot < self.breaks[-1]
            allowed = self.degree if inside else self.degree + 1
            if self.multiplicity(knot) > allowed:
                raise InputError(
                    f"knot {knot:g} appears {self.multiplicity(knot)} times; a spline of degree {self.degree} "
                    f"{'falls apart' if inside else 'has points without use'} beyond {allowed}"
                )
