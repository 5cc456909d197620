"""Bifurcations close together, interpolated between samples around them and verified by counts of pivots."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, linearise, residual
from beamfem.cached_properties import cached_property
from beamfem.solve.continuation.condensed import Condensed
from beamfem.solve.continuation.continuation import Continuation, PathPoint
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError, interpolation_weights

_IMPERFECT = 1e-9  # deviation of a path that still counts as a bifurcation: lengths of the model, radians
_LEFT = 4.0  # factor on the deviation that unbalanced forces can explain
_RESOLVED = 1e-2  # of the distance of samples: closer bifurcations may be one
_ONE = 1e-7  # of the distance of samples: closer bifurcations are one, whatever the counts say
_WIDTH = 1e-3  # of the distance of samples: step of differences of interpolated values
_ALONG = 1e-3  # of a tangent: the part that may lie outside the span of the modes
_BESIDE = 5e-3  # of a segment: samples around a turning point


@dataclass(frozen=True, eq=False)
class Crossing:
    """A bifurcation: its fraction x of the segment, y (n + 1,), the tangent of the path and the unit mode."""

    fraction: float
    y: np.ndarray
    tangent: np.ndarray
    mode: np.ndarray


@dataclass(frozen=True, eq=False)
class Samples:
    """Fractions (s,) of a segment around bifurcations, the tangents condensed there, and one fraction before them.

    change: how many more eigenvalues of the tangent are negative beyond them.
    """

    segment: Segment
    fractions: np.ndarray
    condensed: list[Condensed]
    before: float
    change: int
    distance: float

    @cached_property
    def y(self) -> np.ndarray:
        return np.array([self.segment.at(x).y for x in self.fractions])

    @cached_property
    def tangents(self) -> np.ndarray:
        return np.array([self.segment.at(x).tangent for x in self.fractions])

    @cached_property
    def shapes(self) -> np.ndarray:
        return np.array([sample.shapes for sample in self.condensed])

    def stiffness(self, x: float) -> np.ndarray:
        """Return the condensed tangent (k, k) at a fraction."""
        return self.at(x, np.array([sample.stiffness for sample in self.condensed]))

    def at(self, x: float, values: np.ndarray) -> np.ndarray:
        """Return values (s, ...) at the samples, interpolated at a fraction."""
        return np.tensordot(interpolation_weights(self.fractions, x), values, axes=1)


def crossings(samples: Samples, roots: np.ndarray) -> list[Crossing]:
    """Return the bifurcations at fractions (k,), ascending, where condensed tangents are singular.

    Between any two of them the count of negative pivots must have changed by the number of those before; if they are
    too close for that, they are taken as one point with as many modes. Raises SegmentLostError.
    """
    groups = [[float(roots[0])]]
    for number, (left, right) in enumerate(pairwise(roots.tolist()), 1):
        if samples.segment.symmetric and not _apart(samples, left, right, number):
            groups[-1].append(right)
        else:
            groups.append([right])
    return [crossing for group in groups for crossing in _at_one_place(samples, float(np.mean(group)), len(group))]


def _apart(samples: Samples, left: float, right: float, passed: int) -> bool:
    """Return whether the count between two fractions confirms that `passed` eigenvalues changed their sign before.

    False if it does not because the fractions are too close to be distinguished. Raises SegmentLostError.
    """
    x, gap = 0.5 * (left + right), right - left
    if gap < _ONE * samples.distance:
        return False
    line, y = samples.segment.line, samples.at(x, samples.y)
    zeros = np.zeros(len(y) - 1)
    tangent = linearise(line.system, y[:-1], zeros, zeros, float(y[-1]), STATICS)[1]
    count = tangent.factorised(line.system.rotated).negative_pivots
    if count == samples.segment.at(samples.before).negative_pivots + passed * np.sign(samples.change):
        return True
    if gap > _RESOLVED * samples.distance:
        raise SegmentLostError("the tangent is not singular where its modes lose their stiffness")
    return False


def _at_one_place(samples: Samples, x: float, count: int) -> list[Crossing]:
    """Return the bifurcation at a fraction with each of `count` modes, orthonormal. Raises SegmentLostError."""
    line = samples.segment.line
    values, vectors = np.linalg.eigh(samples.stiffness(x))
    lost = vectors[:, np.argsort(np.abs(values), kind="stable")[:count]]
    width = _WIDTH * samples.distance
    slope = (samples.stiffness(x + width) - samples.stiffness(x - width)) / (2.0 * width)
    # modes that lose their stiffness together do so at different rates
    rates, mixed = np.linalg.eigh(lost.T @ slope @ lost)
    modes = _orthonormal(line, (lost @ mixed).T @ samples.at(x, samples.shapes))
    y, tangent = samples.at(x, samples.y), samples.at(x, samples.tangents)
    for mode, rate in zip(modes, rates, strict=True):
        _require_crossing(samples, x, mode, rate)
    y = samples.segment.balanced(y, modes)
    return [Crossing(x, y, tangent, mode) for mode in modes]


def _orthonormal(line: Continuation, modes: Iterable[np.ndarray]) -> list[np.ndarray]:
    """Return modes (k, n + 1) of length 1, each orthogonal to those before it, with positive largest coordinates."""
    result: list[np.ndarray] = []
    for mode in modes:
        for other in result:
            mode = mode - line.dot(mode, other) * other
        largest = mode[np.argmax(np.abs(mode) / line.scale)]
        result.append(mode / np.copysign(line.length(mode), largest))
    return result


def _require_crossing(samples: Samples, x: float, mode: np.ndarray, rate: float) -> None:
    """Raise SegmentLostError if the path bends aside along the mode, on a hyperbola, instead of being crossed.

    rate: derivative of the stiffness of the mode with respect to the fraction. Unbalanced forces bend the path as well.
    """
    line = samples.segment.line
    fractions = (samples.fractions - x) / samples.distance
    basis = np.stack([np.ones_like(fractions), fractions, 1.0 / fractions], axis=1)
    aside = [line.dot(mode, y) for y in samples.y]
    bend = np.linalg.lstsq(basis, np.array(aside))[0][-1]
    zeros = np.zeros(len(mode) - 1)
    unbalanced = max(abs(mode[:-1] @ residual(line.system, y[:-1], zeros, zeros, float(y[-1]))) for y in samples.y)
    if abs(bend) > max(_IMPERFECT, _LEFT * unbalanced / (abs(rate) * samples.distance)):
        raise SegmentLostError("the step leads to another path")


def require_no_limit(segment: Segment, found: Iterable[Crossing]) -> list[Crossing]:
    """Return bifurcations beside limit points, after a check that none of them is a limit point of another path.

    At a limit point the path is tangential to the mode. Raises SegmentLostError.
    """
    line, result = segment.line, list(found)
    for crossing in result:
        aside = crossing.tangent - line.dot(crossing.mode, crossing.tangent) * crossing.mode
        if line.length(aside) < _ALONG * line.length(crossing.tangent):
            raise SegmentLostError("the step leads to another path")
    return result


def turning_point(segment: Segment, x: float) -> Crossing:
    """Return the bifurcation at a fraction where the load factor has an extremum because another path crosses.

    There the path is tangential to the mode. Raises SegmentLostError.
    """
    line, fractions = segment.line, segment.beside(x, x, _BESIDE, 0.0, 1.0)
    weights = interpolation_weights(fractions, x)
    points = [segment.at(at) for at in fractions.tolist()]
    _require_straight(segment, fractions - x, points)
    tangent = weights @ [point.tangent for point in points]
    tangent /= line.length(tangent)
    mode = np.append(tangent[:-1], 0.0)
    largest = mode[np.argmax(np.abs(mode) / line.scale)]
    mode /= np.copysign(line.length(mode), largest)
    y = segment.balanced(weights @ [point.y for point in points], [mode])
    # a limit point near a bifurcation: a second mode is as soft, and as unreliable
    with suppress(LinAlgError):
        y = segment.balanced(y, list(line.softest_modes(line.solve(y, None)[2], 2)))
    return Crossing(x, y, tangent, mode)


def _require_straight(segment: Segment, fractions: np.ndarray, points: list[PathPoint]) -> None:
    """Raise SegmentLostError if points (s,) around a turning point at fraction 0 are on a hyperbola that avoids it.

    Unbalanced forces move the points as well.
    """
    line, scaled = segment.line, fractions / _BESIDE
    basis = np.stack([np.ones_like(scaled), scaled, scaled**2, 1.0 / scaled], axis=1)
    bend = np.linalg.lstsq(basis, np.array([point.y for point in points]))[0][-1]
    moved = max(line.length(line.solve(point.y, None)[0]) for point in points)
    if line.length(bend) > max(_IMPERFECT, _LEFT * moved):
        raise SegmentLostError("the step leads to another path")


def without_limit(segment: Segment, x: float, found: list[Crossing]) -> list[Crossing]:
    """Return the bifurcations around a limit point at a fraction x without the one, or the mode, of the limit point.

    There the path is tangential to the mode. Raises SegmentLostError.
    """
    line = segment.line
    fractions = segment.beside(x, x, _BESIDE, 0.0, 1.0)
    along = interpolation_weights(fractions, x) @ [segment.at(at).tangent for at in fractions.tolist()]
    along[-1] = 0.0
    nearest = sorted(found, key=lambda crossing: abs(crossing.fraction - x))
    for count in range(1, len(nearest) + 1):
        modes = np.array(_orthonormal(line, [crossing.mode for crossing in nearest[:count]]))
        parts = modes @ (line.weights * along)
        if line.length(along - parts @ modes) < _ALONG * line.length(along):
            others = _orthonormal(line, np.linalg.svd(parts[None])[2][1:] @ modes)
            y, tangent = segment.critical(x), nearest[0].tangent
            return [*nearest[count:], *(Crossing(x, y, tangent, mode) for mode in others)]
    raise SegmentLostError("the path does not go along a mode at a limit point")
