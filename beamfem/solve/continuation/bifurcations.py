"""Bifurcations between two points of an equilibrium path.

The count of negative pivots gives their number, and the tangent condensed onto as many modes their positions. Close to
a bifurcation round-off leads Newton's method off the path, so no equilibrium is solved for there: states, stiffness and
modes are interpolated between points at a distance on both sides.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.solve.continuation.condensed import Condensed, condensed
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError, interpolation_weights
from beamfem.solve.continuation.crossings import (
    Crossing,
    Samples,
    crossings,
    require_no_limit,
    turning_point,
    without_limit,
)

_BESIDE = 1e-3  # of a segment: distance from a limit point at which signs of pivots and positions are reliable
_SHARPEST = 1.0  # [rad] per segment: turn of the tangent beside a limit point; a whole step turns by 0.5 at most
_REAL = 1e-6  # of an eigenvalue: imaginary part that is round-off
_WINDOW = 0.1  # of a segment: around a limit point that coincides with a bifurcation
_JUMP = 1e-3  # of a segment: points further apart than this at nearly equal fractions lie on two paths
_DISTANCE = 5e-3  # of the searched part of a segment: least distance of samples from a bifurcation
_TOGETHER = 4.0  # of the distance: bifurcations closer than this are located together
_SHARPNESS = 1e-5  # of a segment: shorter parts are not divided further
_CLEAR = 0.02  # of a segment: in shorter parts, condensed stiffness and pivot counts must agree
_TRIALS = 12
_SETTLED = 3  # trials after which the roots must converge
_GRID = np.linspace(-1.0, 1.0, 65) ** 3  # where the signs of interpolated stiffnesses are evaluated


def bifurcations(segment: Segment, limits: list[float]) -> list[Crossing]:
    """Return the bifurcations of a segment in order, including those at which the load factor has an extremum.

    There the tangent is singular and another path crosses. Several modes that lose their stiffness at one point count
    as several bifurcations. limits: fractions of the limit points, each of which changes the sign of one pivot. Raises
    SegmentLostError.
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
            result += without_limit(segment, x, list(_search(segment, low, high)))
        if start < low:
            result += require_no_limit(segment, _search(segment, start, low))
        start = high
    if start < 1.0:
        result += require_no_limit(segment, _search(segment, start, 1.0))
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


def _search(segment: Segment, start: float, end: float) -> Iterator[Crossing]:
    _require_one_path(segment, start, end)
    change = segment.change(start, end)
    if change == 0:
        return
    try:
        found = _together(segment, start, end, change)
    except LinAlgError as error:
        if end - start < _CLEAR:
            raise SegmentLostError("the tangent is singular at the ends of every part") from error
        found = 0.5 * (start + end)
    if not isinstance(found, float):
        yield from found
    elif end - start < _SHARPNESS:
        raise SegmentLostError("the tangent is singular at several points that cannot be distinguished")
    else:
        yield from _search(segment, start, found)
        yield from _search(segment, found, end)


def _require_one_path(segment: Segment, start: float, end: float) -> None:
    """Raise SegmentLostError if two points are further apart than a path between them allows."""
    line = segment.line
    ratio = line.length(segment.at(end).y - segment.at(start).y) / line.length(segment.chord)
    if ratio > 2.0 * (end - start) + _JUMP:
        raise SegmentLostError("the step leads to another path")


def _together(segment: Segment, start: float, end: float, change: int) -> list[Crossing] | float:
    """Return the bifurcations between two fractions if they are close together, else a fraction at which to divide."""
    line, middle, distance = segment.line, 0.5 * (start + end), _DISTANCE * (end - start)
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
            left, right = (
                max(fractions[fractions < roots[0]], default=start),
                min(fractions[fractions > roots[-1]], default=end),
            )
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
        return np.asarray(np.linalg.eigvalsh(np.tensordot(interpolation_weights(fractions, x), stiffness, axes=1)))

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
