"""Bifurcations between two points of an equilibrium path.

The count of negative pivots gives their number, and the tangent condensed onto as many modes their positions. Close to
a bifurcation round-off leads Newton's method off the path, so no equilibrium is solved for there: states, stiffness and
modes are interpolated between points at a distance on both sides.
"""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.equations.equations import linearise_at_rest, residual_at_rest
from beamfem.quadrature import interpolation_weights
from beamfem.solve.continuation.continuation import Continuation, PathPoint
from beamfem.solve.continuation.critical_points import DISTANCE, Segment, SegmentLostError
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes


@dataclass(frozen=True, eq=False)
class Condensed:
    """Stiffness (k, k) against unit displacements along k directions, and the deformed shapes (k, n + 1) they cause."""

    stiffness: np.ndarray
    shapes: np.ndarray


def condensed(line: Continuation, point: PathPoint, directions: np.ndarray) -> Condensed:
    """Return the tangent K of a point condensed onto orthonormal directions D (k, n + 1), S = (D W K^-1 W D^T)^-1.

    W: the weights of the continuation. The shapes F = S D W K^-1 satisfy D W F^T = 1 and need no other forces, so that
    S = F K F^T, in which errors of F are of second order; K is singular exactly where S is. Raises LinAlgError.
    """
    free = line.system.free_dofs
    forces = (line.weights * directions)[:, free]
    moved = np.array([point.factors.solve(force) for force in forces])
    if not np.isfinite(moved).all():
        raise LinAlgError("the tangent is singular")
    # transposed, because K need not be symmetric
    stiffness = np.linalg.inv((forces @ moved.T).T)
    shapes = np.zeros(directions.shape)
    shapes[:, free] = stiffness @ moved
    if line.system.symmetric:
        p, correction = point.y[:-1], np.zeros(len(point.y) - 1)
        correction[free] = -point.factors.solve(residual_at_rest(line.system, p, point.load_factor)[free])
        stiffness = stiffness_of_modes(line.system, p, point.load_factor, shapes[:, :-1], correction)
    return Condensed(stiffness, shapes)


_IMPERFECT = 1e-9  # deviation of a path that still counts as a bifurcation: lengths of the model, radians
_LEFT = 4.0  # factor on the deviation that unbalanced forces can explain
_LEFT_ASIDE = 30.0  # the same along a mode, whose stiffness has a round-off of its own
_RESOLVED = 1e-2  # of the distance of samples: closer bifurcations may be one
_ONE = 1e-7  # of the distance of samples: closer bifurcations are one, whatever the counts say
_WIDTH = 1e-3  # of the distance of samples: step of differences of interpolated values
_ALONG = 1e-3  # of a tangent: the part that may lie outside the span of the modes


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
    tangent = linearise_at_rest(line.system, y[:-1], float(y[-1]))[1]
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
    unbalanced = max(abs(mode[:-1] @ residual_at_rest(line.system, y[:-1], float(y[-1]))) for y in samples.y)
    if abs(bend) > max(_IMPERFECT, _LEFT_ASIDE * unbalanced / (abs(rate) * samples.distance)):
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
    line = segment.line
    fractions, _, points = segment.around(x)
    _require_straight(segment, fractions - x, points)
    y, tangent = segment.interpolated(x)
    tangent /= line.length(tangent)
    (mode,) = _orthonormal(line, [np.append(tangent[:-1], 0.0)])
    y = segment.balanced(y, [mode])
    # a limit point near a bifurcation: a second mode is as soft, and as unreliable
    with suppress(LinAlgError):
        y = segment.balanced(y, list(line.softest_modes(line.solve(y, None)[2], 2)))
    return Crossing(x, y, tangent, mode)


def _require_straight(segment: Segment, fractions: np.ndarray, points: list[PathPoint]) -> None:
    """Raise SegmentLostError if points (s,) around a turning point at fraction 0 are on a hyperbola that avoids it.

    Unbalanced forces move the points as well.
    """
    line, scaled = segment.line, fractions / DISTANCE
    basis = np.stack([np.ones_like(scaled), scaled, scaled**2, 1.0 / scaled], axis=1)
    bend = np.linalg.lstsq(basis, np.array([point.y for point in points]))[0][-1]
    moved = max(line.length(line.solve(point.y, None)[0]) for point in points)
    if line.length(bend) > max(_IMPERFECT, _LEFT * moved):
        raise SegmentLostError("the step leads to another path")


def without_limit(segment: Segment, x: float, found: list[Crossing]) -> list[Crossing]:
    """Return the bifurcations around a limit point at a fraction x without the one, or the mode, of the limit point.

    There the path is tangential to the mode. Raises SegmentLostError.
    """
    line, along = segment.line, segment.interpolated(x)[1]
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


_BESIDE = 1e-3  # of a segment: distance from a limit point at which signs of pivots and positions are reliable
_SHARPEST = 1.0  # [rad] per segment: turn of the tangent beside a limit point; a whole step turns by 0.5 at most
_REAL = 1e-6  # of an eigenvalue: imaginary part that is round-off
_WINDOW = 0.1  # of a segment: around a limit point that coincides with a bifurcation
_JUMP = 1e-3  # of a segment: points further apart than this at nearly equal fractions lie on two paths
_TOGETHER = 4.0  # of the distance: bifurcations closer than this are located together
_SHARPNESS = 1e-5  # of a segment: shorter parts are not divided further
_CLEAR = 0.02  # of a segment: in shorter parts, condensed stiffness and pivot counts must agree
_TRIALS = 12
_SETTLED = 3  # trials after which the roots must converge
_GRID = np.linspace(-1.0, 1.0, 65) ** 3  # where the signs of interpolated stiffnesses are evaluated


def bifurcations(segment: Segment, limits: list[float], distance: float = DISTANCE) -> list[Crossing]:
    """Return the bifurcations of a segment in order, including those at which the load factor has an extremum.

    There the tangent is singular and another path crosses. Several modes that lose their stiffness at one point count
    as several bifurcations. limits: fractions of the limit points, each of which changes the sign of one pivot;
    distance: of samples from a bifurcation, of the searched part of the segment. Raises SegmentLostError.
    """
    extrema = sorted([*limits, *segment.turned])
    result = [turning_point(segment, x) for x in segment.turned]
    start = 0.0
    for i, x in enumerate(extrema):
        low, high = max(x - _BESIDE, start), min(x + _BESIDE, 1.0)
        if x in limits:
            _require_no_corner(segment, [low, x, high] if x in segment.found else [low, high])
        if abs(segment.change(low, high)) != (x in limits):
            if x not in limits:
                raise SegmentLostError("several paths cross where the load factor turns")
            low = max(x - _WINDOW, start)
            high = min(x + _WINDOW, 0.5 * (x + extrema[i + 1]) if i + 1 < len(extrema) else 1.0)
            result += without_limit(segment, x, list(_search(segment, low, high, distance)))
        if start < low:
            result += require_no_limit(segment, _search(segment, start, low, distance))
        start = high
    if start < 1.0:
        result += require_no_limit(segment, _search(segment, start, 1.0, distance))
    if limits or result:
        _require_no_hidden_pair(segment, len(limits) + len(result))
    return sorted(result, key=lambda crossing: crossing.fraction)


def _require_no_hidden_pair(segment: Segment, found: int) -> None:
    """Raise SegmentLostError if more soft modes change the sign of their stiffness over a segment than were found.

    A step that changes over from sheet to sheet where several modes are soft keeps the count of negative pivots if one
    mode gains the sign that another loses. The tangents at its ends, condensed onto the same modes, show them: between
    S and T, the matrix (1 - x) S + x T is singular once for each negative eigenvalue of S^-1 T. The number of modes is
    doubled until some of them keep their sign. If the tangents are symmetric, no more modes change their sign than have
    a negative stiffness at one end.
    """
    if segment.symmetric and segment.before.negative_pivots + segment.after.negative_pivots < found + 2:
        return
    line, count = segment.line, found + 3
    while True:
        modes = line.softest_modes(segment.before.factors, count)
        try:
            start, end = (condensed(line, point, modes).stiffness for point in (segment.before, segment.after))
            ratios = np.linalg.eigvals(np.linalg.solve(start, end))
        except LinAlgError as error:
            raise SegmentLostError("the tangent is singular at the end of a step") from error
        changed = int(np.sum((ratios.real < 0.0) & (np.abs(ratios.imag) < _REAL * np.abs(ratios))))
        if changed >= found + 2:
            raise SegmentLostError("the step leads to another path")
        if changed < count or count > len(modes):
            return
        count *= 2


def _require_no_corner(segment: Segment, fractions: list[float]) -> None:
    """Raise SegmentLostError if the path turns much more sharply beside a limit point than the segment as a whole.

    Where modes become soft at nearly equal loads, the path is a hyperbola along them. A segment that is longer than the
    vertex seems smooth though its ends lie on different sheets, but its limit point is at a vertex.
    """
    for start, end in pairwise(fractions):
        turn = segment.line.length(segment.at(end).tangent - segment.at(start).tangent)
        if turn > _SHARPEST * (end - start):
            raise SegmentLostError("the step leads to another path")


def _search(segment: Segment, start: float, end: float, distance: float) -> Iterator[Crossing]:
    line = segment.line
    ratio = line.length(segment.at(end).y - segment.at(start).y) / line.length(segment.chord)
    if ratio > 2.0 * (end - start) + _JUMP:  # further apart than a path between the two allows
        raise SegmentLostError("the step leads to another path")
    change = segment.change(start, end)
    if change == 0:
        return
    try:
        found = _together(segment, start, end, change, distance * (end - start))
    except LinAlgError as error:
        if end - start < _CLEAR:
            raise SegmentLostError("the tangent is singular at the ends of every part") from error
        found = 0.5 * (start + end)
    if not isinstance(found, float):
        yield from found
    elif end - start < _SHARPNESS:
        raise SegmentLostError("the tangent is singular at several points that cannot be distinguished")
    else:
        yield from _search(segment, start, found, distance)
        yield from _search(segment, found, end, distance)


def _together(segment: Segment, start: float, end: float, change: int, distance: float) -> list[Crossing] | float:
    """Return the bifurcations between two fractions if they are close together, else a fraction at which to divide."""
    line, middle = segment.line, 0.5 * (start + end)
    directions = _softer(segment, start, end, abs(change))
    known = {x: condensed(line, segment.at(x), directions) for x in (start, end)}
    fractions = np.array([start, end])
    if end - start < _CLEAR and not _shows(known[start], known[end], change, line.system.symmetric):
        raise SegmentLostError("round-off decides where the tangent is singular")
    roots, moved = _roots(known, fractions, (start, end)), np.inf
    for trial in range(_TRIALS):
        if len(roots) != abs(change):
            return middle
        if roots[-1] - roots[0] > _TOGETHER * distance:
            widest = int(np.argmax(np.diff(roots)))
            return float(roots[widest] + roots[widest + 1]) / 2.0
        fractions = segment.beside(roots[0], roots[-1], distance, start, end)
        known |= {x: condensed(line, segment.at(x), directions) for x in fractions.tolist() if x not in known}
        before, roots = roots, _roots(known, fractions, (start, end))
        if len(roots) != len(before):
            return middle
        last, moved = moved, float(np.abs(roots - before).max())
        if trial >= _SETTLED and moved > 0.5 * last:
            return middle
        if moved < 0.1 * distance:
            left = max(fractions[fractions < roots[0]], default=start)
            right = min(fractions[fractions > roots[-1]], default=end)
            if segment.change(start, left) or segment.change(right, end):
                return middle
            samples = Samples(segment, fractions, [known[x] for x in fractions.tolist()], left, change, distance)
            return crossings(samples, roots)
    return middle


def _shows(start: Condensed, end: Condensed, change: int, symmetric: bool) -> bool:
    """Return whether the condensed stiffness gains as many negative eigenvalues over a part as the tangent does.

    If they are not symmetric, only the sign of the determinant counts.
    """
    if not symmetric:
        signs = [np.sign(np.linalg.det(sample.stiffness)) for sample in (start, end)]
        return bool(signs[0] * signs[1] == (-1.0) ** change)
    before, after = (int(np.sum(np.linalg.eigvalsh(sample.stiffness) < 0.0)) for sample in (start, end))
    return after - before == change


def _softer(segment: Segment, start: float, end: float, count: int) -> np.ndarray:
    """Return the softest modes (count, n + 1) at that end of a part of a segment where they are softer."""
    line, candidates = segment.line, []
    for x in (start, end):
        modes = line.softest_modes(segment.at(x).factors, count)
        stiffness = condensed(line, segment.at(x), modes).stiffness
        candidates.append((float(np.abs(np.linalg.eigvalsh(stiffness)).max()), modes))
    return min(candidates, key=lambda candidate: candidate[0])[1]


def _roots(known: dict[float, Condensed], fractions: np.ndarray, within: tuple[float, float]) -> np.ndarray:
    """Return the fractions where the polynomial through the stiffnesses at `fractions` is singular, ascending.

    One root for each eigenvalue that changes its sign, the one nearest to the samples.
    """
    from scipy.optimize import brentq  # slow to import

    stiffness = np.array([known[x].stiffness for x in fractions.tolist()])

    def eigenvalues(x: float | np.ndarray) -> np.ndarray:
        # not by BLAS, which rounds one matrix differently from many
        weights = interpolation_weights(fractions, x)
        return np.asarray(np.linalg.eigvalsh(np.einsum("...k,kij->...ij", weights, stiffness)))

    centre = 0.5 * (fractions[0] + fractions[-1])
    reach = np.where(_GRID < 0.0, centre - within[0], within[1] - centre)
    grid = centre + _GRID * reach
    signs = np.sign(eigenvalues(grid))
    roots = []
    for number, row in enumerate(signs.T):
        changes = np.flatnonzero(row[1:] != row[:-1])
        if len(changes):
            i = changes[np.argmin(np.abs(changes - len(grid) // 2))]
            roots.append(brentq(lambda x, j=number: eigenvalues(x)[j], grid[i], grid[i + 1], xtol=1e-15))
    return np.sort(roots)
