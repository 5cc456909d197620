"""Pairs of critical points inside a step of a loading path, which neither its ends nor its middle show."""

from collections.abc import Iterator

import numpy as np

from beamfem.linalg.lapack import LinAlgError
from beamfem.solve.continuation.condensed import condensed
from beamfem.solve.continuation.continuation import PathPoint
from beamfem.solve.continuation.critical_points import interpolation_weights
from beamfem.solve.stability.critical_point_fit import on_path
from beamfem.solve.stability.loading_path import LoadingPath

_MODES = 3  # softest ones, of which one may lose its stiffness and gain it again
_FRACTION = 0.3  # of the least stiffness of a mode at the points of a step: with less in between it may lose it
_GRID = np.linspace(0.0, 1.0, 65)


def stops(path: LoadingPath, before: PathPoint, middle: PathPoint, after: PathPoint) -> Iterator[PathPoint]:
    """Yield points of a step in order, at which a pair of limit points or of bifurcations would show.

    Cubics through the loads and their slopes tell where the load may fall in between, a parabola through the condensed
    tangents where a mode may lose its stiffness. Raises PathLostError.
    """
    soft = _softest_place(path, before, middle, after)
    for start, end in ((before, middle), (middle, after)):
        normal = path.normal(start, end)
        places = [_extreme_slope(path, start, end)]
        if soft is not None:
            at = path.line.dot(normal, soft - start.y)
            places.append(at if 0.0 < at < path.line.dot(normal, end.y - start.y) else None)
        for at in sorted(place for place in places if place is not None):
            yield on_path(path, normal, (start, end), at)
        yield end


def loads(
    path: LoadingPath, normal: np.ndarray, before: PathPoint, after: PathPoint
) -> tuple[float, tuple[float, float], float]:
    """Return the distance of two points along a normal, the slopes of the load over its fractions, and its rise."""
    reach = path.line.dot(normal, after.y - before.y)
    first, last = (reach * end.tangent[-1] / path.line.dot(normal, end.tangent) for end in (before, after))
    return reach, (first, last), after.load_factor - before.load_factor


def _extreme_slope(path: LoadingPath, before: PathPoint, after: PathPoint) -> float | None:
    """Return the distance along the chord at which the load falls by the cubic through two points between which it
    rises at both ends, or the other way round; None if it does not.
    """
    reach, slopes, rise = loads(path, path.normal(before, after), before, after)
    curvature = slopes[0] + slopes[1] - 2.0 * rise
    if slopes[0] * slopes[1] <= 0.0 or curvature == 0.0:
        return None
    x = (2.0 * slopes[0] + slopes[1] - 3.0 * rise) / (3.0 * curvature)
    slope = slopes[0] + x * (6.0 * rise - 4.0 * slopes[0] - 2.0 * slopes[1]) + 3.0 * x**2 * curvature
    return x * reach if 0.0 < x < 1.0 and slope * slopes[0] < 0.0 else None


def _softest_place(path: LoadingPath, before: PathPoint, middle: PathPoint, after: PathPoint) -> np.ndarray | None:
    """Return y (n + 1,) where by parabolas through three points a mode keeps the least fraction of its stiffness.

    None if all modes keep more of it than a fraction, or round-off hides the stiffnesses.
    """
    line, points = path.line, (before, middle, after)
    normal = path.normal(before, after)
    try:
        modes = line.softest_modes(before.factors, _MODES)
        eigenvalues = np.array([np.linalg.eigvalsh(condensed(line, point, modes).stiffness) for point in points])
    except LinAlgError:
        return None
    steady = np.flatnonzero(np.all(eigenvalues > 0.0, axis=0) | np.all(eigenvalues < 0.0, axis=0))
    if not len(steady):
        return None
    at = np.array([line.dot(normal, point.y - before.y) for point in points])
    grid = at[-1] * _GRID
    fractions = interpolation_weights(at, grid) @ (
        eigenvalues / eigenvalues[np.argmin(np.abs(eigenvalues), axis=0), np.arange(eigenvalues.shape[1])]
    )
    row, mode = np.unravel_index(np.argmin(fractions[:, steady]), (len(grid), len(steady)))
    if fractions[row, steady[mode]] > _FRACTION:
        return None
    return np.asarray(interpolation_weights(at, float(grid[row])) @ np.array([point.y for point in points]))
