"""A segment of a path between two of its points, and the limit points on it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.quadrature import interpolation_weights
from beamfem.solve.continuation.continuation import Continuation, PathPoint
from beamfem.solve.newton.newton import balance_of

_SHARPNESS = 1e-12  # of a segment: accuracy of the fractions of critical points
_LEVEL = 1e-4  # largest slope of the load factor accepted at a limit point
DISTANCE = 5e-3  # of a part of a segment: least distance of samples from a crossing path
_NEARLY = 0.3  # of the smaller slope of the load factor at the ends: with less in between there may be two limit points
_TRIALS = 12
_BALANCINGS = 4
_EVEN = 1e-6  # relative difference of products a K^-1 b and b K^-1 a that still counts as symmetric


class SegmentLostError(Exception):
    """A point between two points of a path could not be found."""


@dataclass(eq=False)
class Segment:
    """The path between two of its points, by the fraction x of the chord from one to the other.

    turned: fractions where the load factor has an extremum because another path crosses, filled by `limit_points`.
    """

    line: Continuation
    before: PathPoint
    after: PathPoint
    found: dict[float, PathPoint] = field(default_factory=dict)
    turned: list[float] = field(default_factory=list)
    iterations: int = 0

    def __post_init__(self) -> None:
        self.found = {0.0: self.before, 1.0: self.after}
        self.chord = self.after.y - self.before.y
        squared = self.line.dot(self.chord, self.chord)
        points = (self.before, self.after)
        # slopes of the cubic through both points, with equal projections on the chord
        self.slopes = [point.tangent * squared / self.line.dot(point.tangent, self.chord) for point in points]

    def at(self, x: float, normal: np.ndarray | None = None) -> PathPoint:
        """Return the point of the path at a fraction x in [0, 1]; normal: of the plane searched, by default the chord.

        Raises SegmentLostError.
        """
        if x in self.found:
            return self.found[x]
        start = _cubic(x, self.before.y, self.after.y, *self.slopes)
        corrected = self.line.correct(start, self._stresses(x), self.chord if normal is None else normal)
        self.iterations += corrected.iterations
        if not corrected.ended.good or self.line.length(corrected.y - start) > self.line.length(self.chord):
            raise SegmentLostError(corrected.ended.value)
        try:
            point = self.line.linearised(corrected.y, self.chord)
        except LinAlgError as error:
            raise SegmentLostError("the tangent is singular") from error
        if normal is None:
            self.found[x] = point
        return point

    def critical(self, x: float) -> np.ndarray:
        """Return y (n + 1,) at the fraction of a limit point. Raises SegmentLostError.

        It is interpolated if more than the load factor is critical, so that no equilibrium can be solved for.
        """
        if x in self.found:
            return self.found[x].y
        y, system = self.interpolated(x)[0], self.line.system
        y[system.prescribed_dofs] = system.prescribed_values(float(y[-1]))  # weights add up to one but for round-off
        return y

    def interpolated(self, x: float) -> tuple[np.ndarray, np.ndarray]:
        """Return y (n + 1,) and the tangent (n + 1,) at a fraction from those beside it. Raises SegmentLostError."""
        _, weights, points = self.around(x)
        return weights @ [point.y for point in points], weights @ [point.tangent for point in points]

    def around(self, x: float) -> tuple[np.ndarray, np.ndarray, list[PathPoint]]:
        """Return fractions (s,) beside another one, the weights by which values there give its own, and the points."""
        fractions = self.beside(x, x, DISTANCE, 0.0, 1.0)
        return fractions, interpolation_weights(fractions, x), [self.at(at) for at in fractions.tolist()]

    def balanced(self, y: np.ndarray, modes: Sequence[np.ndarray]) -> np.ndarray:
        """Return an interpolated y (n + 1,), better balanced in directions orthogonal to its critical modes (k, n + 1).

        Along the orthonormal modes the nearly singular tangent gives round-off only. A step longer than the distance of
        the points used for the interpolation indicates another mode.
        """
        line = self.line
        best, least = y, np.inf
        try:
            for _ in range(_BALANCINGS):
                largest = balance_of(line.system, y[:-1], float(y[-1])).largest
                if not largest < least:
                    break
                best, least = y, largest
                step, _, _ = line.solve(y, None)
                for mode in modes:
                    step -= line.dot(mode, step) * mode
                if line.length(step) > DISTANCE * line.length(self.chord):
                    break
                y = y + step
        except LinAlgError:
            pass
        return best

    def at_load(self, load_factor: float) -> PathPoint:
        """Return the point with a load factor that lies between those of the ends. Raises SegmentLostError."""
        point = self.at(self._fraction(load_factor), normal=self.line.load_axis)
        point.y[-1] = load_factor
        return point

    def critical_at_load(self, load_factor: float, modes: Sequence[np.ndarray]) -> PathPoint:
        """Return the point with a load factor at which modes (k, n + 1) have no stiffness, with the pivots before it.

        No equilibrium can be solved for there; it is interpolated from the points beside it. Raises SegmentLostError.
        """
        points = np.array([point.y for point in self.around(self._fraction(load_factor))[2]])
        y = self.balanced(interpolation_weights(points[:, -1], load_factor) @ points, modes)
        y[-1] = load_factor
        return PathPoint(y, self.before.tangent, self.before.factors)

    def _fraction(self, load_factor: float) -> float:
        """Return the fraction of a load factor by the cubic through the ends."""
        from scipy.optimize import brentq  # slow to import and rarely needed

        ends = (self.before.y[-1], self.after.y[-1], *(slope[-1] for slope in self.slopes))
        return float(brentq(lambda x: _cubic(x, *ends) - load_factor, 0.0, 1.0, xtol=1e-15))

    def _stresses(self, x: float) -> tuple[np.ndarray, ...] | None:
        """Return the stress resultants from a cubic whose slopes at the ends are those along the path."""
        ends, zeros = (self.before, self.after), np.zeros(len(self.chord))
        now = [self.line.stresses(point.y, zeros) for point in ends]
        ahead = [self.line.stresses(point.y, slope) for point, slope in zip(ends, self.slopes, strict=True)]
        known = [stresses for stresses in (*now, *ahead) if stresses is not None]
        if len(known) < 4:
            return None
        return tuple(_cubic(x, a, b, c - a, d - b) for a, b, c, d in zip(*known, strict=True))

    def limit_points(self) -> list[float]:
        """Return the fractions x where the load factor has an extremum, in order. Raises SegmentLostError.

        An extremum at which another path crosses is a bifurcation: its fraction is added to `turned`.
        """
        stops = self._stops()
        limits: list[float] = []
        self.turned = []
        for start, end in pairwise(stops):
            left, right = self.at(start).tangent[-1], self.at(end).tangent[-1]
            if left * right < 0.0:
                x, crossed = self._extremum(start, end)
                (self.turned if crossed else limits).append(x)
            elif right == 0.0 != left:
                limits.append(end)
        rise = self.chord[-1]
        if not limits and not self.turned and rise * self.slopes[0][-1] < 0.0 and rise * self.slopes[1][-1] < 0.0:
            raise SegmentLostError("the load factor goes another way than the tangents at both ends")
        return limits

    @cached_property
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric; only then it has as many negative eigenvalues as negative pivots."""
        if self.line.system.symmetric:
            return True
        weights, factors = self.line.weights[self.line.system.free_dofs], self.before.factors
        a, b = weights * np.random.default_rng(0).standard_normal((2, len(weights)))
        one, other = a @ factors.solve(b), b @ factors.solve(a)
        return bool(abs(one - other) < _EVEN * max(abs(one), abs(other)))

    def change(self, start: float, end: float) -> int:
        """Return how many more eigenvalues of the tangent are negative at `end` than at `start`.

        For an unsymmetric tangent pivots give the sign of the determinant only: 1 if it differs, else 0.
        """
        change = self.at(end).negative_pivots - self.at(start).negative_pivots
        return change if self.symmetric else change % 2

    def beside(self, low: float, high: float, distance: float, start: float, end: float) -> np.ndarray:
        """Return fractions in [start, end] at a distance from [low, high], two on each side if there is space."""
        steps = distance * np.arange(1.0, 5.0)
        left, right = low - steps, high + steps
        left, right = left[left >= start], right[right <= end]
        on_left = max(2, 4 - len(right))
        return np.sort(np.append(left[:on_left], right[: max(2, 4 - len(left))]))

    def _extremum(self, start: float, end: float) -> tuple[float, bool]:
        """Return the fraction of the extremum of the load factor between two others, and whether a path crosses there.

        A limit point changes the sign of one pivot. If none changes, another path crosses, as when a branch returns to
        the path that it left: equilibria can be computed beside the point, but not at it.
        """
        from scipy.optimize import brentq  # slow to import and rarely needed

        if abs(self.change(start, end)) != 1:
            x, samples = self._extremum_between(start, end)
            start, end = max(samples[samples < x], default=start), min(samples[samples > x], default=end)
            changed = self.change(start, end)
            if abs(changed) != 1:
                return x, changed == 0
            if self.at(start).tangent[-1] * self.at(end).tangent[-1] >= 0.0:
                raise SegmentLostError("the load factor has an extremum that was not located")
        try:
            x = float(brentq(lambda x: self.at(x).tangent[-1], start, end, xtol=_SHARPNESS, rtol=1e-9))
        except SegmentLostError:
            # a pivot that vanishes to the last bit
            return self._extremum_between(start, end)[0], False
        if abs(self.at(x).tangent[-1]) > _LEVEL * self.line.load_scale:
            raise SegmentLostError("the step leads to another path")
        return x, False

    def _extremum_between(self, start: float, end: float) -> tuple[float, np.ndarray]:
        """Return the fraction of zero slope of the load factor, interpolated from samples, and their fractions."""
        samples = np.array([start, end])
        x = _zero([self.at(at).tangent[-1] for at in samples], samples)
        for _ in range(_TRIALS):
            samples = self.beside(x, x, DISTANCE * (end - start), start, end)
            before, x = x, _zero([self.at(at).tangent[-1] for at in samples], samples)
            if not start <= x <= end:
                break
            if abs(x - before) < 0.1 * DISTANCE * (end - start):
                return x, samples
        raise SegmentLostError("the load factor has an extremum that was not located")

    def _stops(self) -> list[float]:
        """Return fractions between which the slope of the load factor changes its sign once at the most.

        Where the load factor nearly has a pair of extrema by the cubic through the ends, the cubics to the point there
        tell. Raises SegmentLostError.
        """
        near = self._least_slope(0.0, 1.0, _NEARLY)
        if near is None:
            return [0.0, 1.0]
        if self.at(near).tangent[-1] * self.slopes[0][-1] <= 0.0:
            return [0.0, near, 1.0]
        hidden = [self._least_slope(start, end, 0.0) for start, end in ((0.0, near), (near, 1.0))]
        return sorted({0.0, near, 1.0, *(x for x in hidden if x is not None)})

    def _least_slope(self, start: float, end: float, fraction: float) -> float | None:
        """Return where the cubic between two fractions has the slope of the load factor nearest to a change of sign.

        None if its sign is not the same at both ends, or if it stays above a fraction of the smaller slope there.
        """
        points, width = (self.at(start), self.at(end)), end - start
        squared = self.line.dot(self.chord, self.chord)
        left, right = (
            width * squared * point.tangent[-1] / self.line.dot(point.tangent, self.chord) for point in points
        )
        rise = points[1].load_factor - points[0].load_factor
        curvature = 6.0 * (left + right - 2.0 * rise)
        if left * right <= 0.0 or curvature == 0.0:
            return None
        x = (2.0 * (2.0 * left + right) - 6.0 * rise) / curvature
        if not 0.0 < x < 1.0:
            return None
        slope = left + x * (6.0 * rise - 4.0 * left - 2.0 * right) + x**2 * 0.5 * curvature
        return float(start + x * width) if slope * np.sign(left) < fraction * min(abs(left), abs(right)) else None


def _cubic(x: float, a: Any, b: Any, a_slope: Any, b_slope: Any) -> Any:
    """Cubic on [0, 1] with values a, b and slopes at its ends."""
    y = 1.0 - x
    return y * y * (1.0 + 2.0 * x) * a + x * x * (3.0 - 2.0 * x) * b + x * y * (y * a_slope - x * b_slope)


def _zero(values: list[float], at: np.ndarray) -> float:
    """Return where values at `at` vanish, by inverse polynomial interpolation."""
    return float(interpolation_weights(np.array(values), 0.0) @ at)
