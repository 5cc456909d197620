"""Bifurcations between two points of an equilibrium path.

Close to a bifurcation round-off leads Newton's method off the path, so no equilibrium is solved for there: place, state
and mode are interpolated between points that keep their distance on both sides.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.analysis.continuation import PathPoint
from beamfem.analysis.critical_points import Segment, SegmentLostError
from beamfem.analysis.mode_stiffness import mode_stiffness

_BESIDE = 1e-3  # of a segment: how far from a limit point signs of pivots and positions are trusted
_JUMP = 1e-3  # of a segment: points that stay further apart however close their shares are lie on two paths
_DISTANCE = 5e-3  # of the part of a segment that is searched: samples are no closer to a bifurcation
_SHARPNESS = 1e-5  # of a segment: bifurcations closer than this are taken as one
_SAMPLES = (-2.0, -1.0, 1.0, 2.0)  # in units of the distance
_TRIALS = 12
_IMPERFECT = 1e-9  # how far a path may bend aside before a bifurcation: lengths of the model, radians


@dataclass(frozen=True, eq=False)
class Crossing:
    """A bifurcation: its share x of the segment, y (n + 1,), the tangent of the path and the unit mode."""

    share: float
    y: np.ndarray
    tangent: np.ndarray
    mode: np.ndarray


def _interpolated(at: Sequence[float] | np.ndarray, values: Sequence[float] | np.ndarray, x: float) -> float:
    from scipy.interpolate import krogh_interpolate  # slow to import

    return float(krogh_interpolate(at, values, x))


def bifurcations(segment: Segment, limits: list[float]) -> list[Crossing]:
    """Return where the tangent is singular but the load factor has no extremum, in order.

    limits: shares of the limit points, each of which changes the sign of one pivot. Raises SegmentLostError.
    """
    starts = [0.0, *(min(x + _BESIDE, 1.0) for x in limits)]
    ends = [*(max(x - _BESIDE, 0.0) for x in limits), 1.0]
    pairs = zip(starts, ends, strict=True)
    return [found for start, end in pairs if start < end for found in _search(segment, start, end)]


def _search(segment: Segment, start: float, end: float) -> list[Crossing]:
    left, right = segment.at(start), segment.at(end)
    _require_one_path(segment, start, end)
    change = abs(left.negative_pivots - right.negative_pivots)
    if change == 0 or (change % 2 == 0 and not (_symmetric(segment, left) and _symmetric(segment, right))):
        return []
    found = _zero(segment, start, end)
    if found is not None:
        return found
    if end - start < _SHARPNESS:
        raise SegmentLostError("the tangent is singular at several points that cannot be told apart")
    middle = 0.5 * (start + end)
    return [*_search(segment, start, middle), *_search(segment, middle, end)]


def _require_one_path(segment: Segment, start: float, end: float) -> None:
    """Raise SegmentLostError where two points are further apart than the way from one to the other can be."""
    line = segment.line
    apart = line.length(segment.at(end).y - segment.at(start).y) / line.length(segment.chord)
    if apart > 2.0 * (end - start) + _JUMP:
        raise SegmentLostError("the step leads to another path")


def _zero(segment: Segment, start: float, end: float) -> list[Crossing] | None:
    """Return where the stiffness of a mode that is soft at an end vanishes, None where that is not all that changes.

    A crossing for each mode whose stiffness vanishes there.
    """
    mode = _softer(segment, start, end)
    known = {x: _stiffness(segment, x, mode) for x in (start, end)}
    if known[start] * known[end] >= 0.0:
        return None
    distance = _DISTANCE * (end - start)
    x = start + (end - start) * known[start] / (known[start] - known[end])
    for _ in range(_TRIALS):
        samples = np.unique(np.clip(x + distance * np.array(_SAMPLES), start, end)).tolist()
        known |= {at: _stiffness(segment, at, mode) for at in samples}
        before, x = x, _root(known, start, end)
        if abs(x - before) < 0.1 * distance:
            pivots = [segment.at(at).negative_pivots for at in (start, samples[0], samples[-1], end)]
            if pivots[0] != pivots[1] or pivots[2] != pivots[3]:
                return None
            x = _interpolated([known[at] for at in samples], samples, 0.0)
            return _crossings(segment, x, np.array(samples), distance, abs(pivots[1] - pivots[2]))
    return None


def _softer(segment: Segment, start: float, end: float) -> np.ndarray:
    """Return the softest mode (n + 1,) of the end of a part of a segment where it is softer."""
    modes = [(at, segment.line.softest(segment.at(at).factors)) for at in (start, end)]
    return min(modes, key=lambda one: abs(_stiffness(segment, *one)))[1]


def _stiffness(segment: Segment, x: float, mode: np.ndarray) -> float:
    try:
        return 1.0 / segment.line.softness(segment.at(x).factors, mode)
    except LinAlgError:
        return 0.0


def _root(known: dict[float, float], start: float, end: float) -> float:
    """Return where the stiffness is zero, from the samples nearest to that; start and end differ in its sign."""
    sign = np.sign(known[start])
    low = max(x for x, value in known.items() if value * sign > 0.0)
    high = min((x for x, value in known.items() if value * sign <= 0.0 and x > low), default=end)
    near = sorted(known, key=lambda x: abs(known[x]))[: len(_SAMPLES)]
    x = _interpolated([known[at] for at in near], near, 0.0)
    return x if low <= x <= high else 0.5 * (low + high)


def _require_crossing(segment: Segment, shares: np.ndarray, aside: list[float]) -> None:
    """Raise SegmentLostError where the way of a path along the mode is a hyperbola: it bends aside, it is not crossed.

    shares: of a bifurcation, in units of the distance of the samples; aside: how far the samples are along the mode.
    """
    basis = np.stack([np.ones_like(shares), shares, 1.0 / shares], axis=1)
    bend = np.linalg.lstsq(basis, np.array(aside))[0][-1]
    if abs(bend) > _IMPERFECT:
        raise SegmentLostError("the step leads to another path")


def _crossings(segment: Segment, x: float, near: np.ndarray, distance: float, count: int) -> list[Crossing]:
    """Return the bifurcation about a share x with each of `count` modes, interpolated between shares near to it.

    Raises SegmentLostError.
    """
    line = segment.line
    points = [segment.at(at) for at in near]
    rows, tangents = np.array([point.y for point in points]), np.array([point.tangent for point in points])
    known: list[list[np.ndarray]] = [[] for _ in points]
    result = []
    for _ in range(count):
        for point, softer in zip(points, known, strict=True):
            softer.append(line.softest(point.factors, softer))
        modes = np.array([softer[-1] for softer in known])
        modes *= np.sign([line.dot(mode, modes[0]) for mode in modes])[:, None]
        place = _refined(segment, points, modes, near) if _symmetric(segment, points[0]) else x
        # round-off of tangents so near to a singular one is all along the mode, and of opposite sign on the two sides
        weights = [np.prod((place - others) / (at - others)) for at, others in ((at, near[near != at]) for at in near)]
        mode = weights @ modes
        mode /= np.copysign(line.length(mode), mode[np.argmax(np.abs(mode) / line.scale)])
        _require_crossing(segment, (near - place) / distance, [line.dot(mode, y) for y in rows])
        result.append(Crossing(place, weights @ rows, weights @ tangents, mode))
    return sorted(result, key=lambda found: found.share)


def _refined(segment: Segment, points: list[PathPoint], modes: np.ndarray, near: np.ndarray) -> float:
    """Return the share at which the stiffness of the modes is zero, without the round-off of assembled tangents."""
    system = segment.line.system
    stiffness = [
        mode_stiffness(system, point.y[:-1], point.load_factor, mode[:-1])
        for point, mode in zip(points, modes, strict=True)
    ]
    return _interpolated(stiffness, near, 0.0)


def _symmetric(segment: Segment, point: PathPoint) -> bool:
    """Tell whether a tangent is symmetric; only then the number of negative pivots is that of eigenvalues."""
    line = segment.line
    if line.system.symmetric:
        return True
    weights = line.weights[line.system.free_dofs]
    a, b = weights * np.random.default_rng(0).standard_normal((2, len(weights)))
    one, other = a @ point.factors.solve(b), b @ point.factors.solve(a)
    return bool(abs(one - other) < 1e-6 * max(abs(one), abs(other)))
