"""Singular points of the tangent on a loading path: bifurcations and limit points."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from beamfem.cached_properties import cached_property
from beamfem.linalg.lapack import LinAlgError, eigh, svd
from beamfem.solve.continuation.bifurcations import condensed
from beamfem.solve.continuation.continuation import PathPoint
from beamfem.solve.continuation.critical_points import interpolation_weights
from beamfem.solve.modes.pencil import Pencil
from beamfem.solve.stability.loading_path import LoadingPath, PathLostError, Softest

_NODES = np.array([-1.0, -0.75, -0.45, 0.45, 0.75, 1.0])  # in units of the radius
_REFERENCE = 2  # the node to whose modes those of the others are rotated
_SPARE = 2  # modes found beyond those that are unstable
_APART = 0.5  # of the change of stiffness in a window: closer modes are taken as one subspace
_ALIKE = 0.7  # smallest cosine between the subspaces of soft modes at two nodes


@dataclass(frozen=True)
class Zero:
    """A distance at which the stiffness of a mode of a window vanishes, and the number of that mode by stiffness."""

    at: float
    number: int


@dataclass(frozen=True, eq=False)
class Window:
    """Points of a path at distances `at` along a direction.

    softest: modes of each point; slopes: of the load factor (points,); mass (unknown, unknown) at one point; free: the
    unknown coordinates.
    """

    centre: float
    radius: float
    at: np.ndarray
    points: list[PathPoint]
    softest: list[Softest]
    slopes: np.ndarray
    mass: csr_array
    free: np.ndarray

    @classmethod
    def about(
        cls, path: LoadingPath, normal: np.ndarray, ends: tuple[PathPoint, PathPoint], centre: float, radius: float
    ) -> "Window":
        """Return the window about a distance from the first of two ends along a normal (n + 1,).

        Raises PathLostError, ConvergenceError.
        """
        at = centre + radius * _NODES
        points = [on_path(path, normal, ends, x) for x in at]
        count = max(point.negative_pivots for point in points) + _SPARE
        softest = [path.softest(point, count) for point in points]
        slopes = np.array([point.tangent[-1] / path.line.dot(normal, point.tangent) for point in points])
        mass = Pencil(path.system, points[_REFERENCE].y[:-1], points[_REFERENCE].load_factor).mass
        return cls(centre, radius, at, points, softest, slopes, mass, path.system.free_dofs)

    @cached_property
    def rows(self) -> np.ndarray:
        """Coordinates and load factor (points, n + 1)."""
        return np.array([point.y for point in self.points])

    def weights(self, x: float) -> np.ndarray:
        """Return the weights (points,) of the polynomial through all points, at a distance x."""
        return interpolation_weights(self.at, x)

    @cached_property
    def _soft(self) -> slice:
        """The modes whose stiffness changes its sign, and those that come close to them in stiffness."""
        count = min(len(soft.values) for soft in self.softest)
        values = np.array([soft.values[:count] for soft in self.softest])
        low, high = values.min(axis=0), values.max(axis=0)
        changing = np.flatnonzero((low < 0.0) & (high >= 0.0))
        if not len(changing):
            return slice(0, 0)
        first, last = int(changing[0]), int(changing[-1]) + 1
        gap = _APART * float((high - low)[changing].max())
        while last < count and low[last] < high[last - 1] + gap:
            last += 1
        while first > 0 and high[first - 1] > low[first] - gap:
            first -= 1
        return slice(first, last)

    @cached_property
    def _turned(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Soft modes of each point (points, unknown, m), rotated to those of one of them, their stiffness
        (points, m, m) and the smallest cosine between their subspaces.
        """
        reference = self.mass @ self.softest[_REFERENCE].vectors[:, self._soft]
        vectors, stiffness, least = [], [], 1.0
        for soft in self.softest:
            modes = soft.vectors[:, self._soft]
            left, cosines, right = svd(modes.T @ reference)
            turn = left @ right
            vectors.append(modes @ turn)
            stiffness.append(turn.T @ (soft.values[self._soft, None] * turn))
            least = min(least, float(cosines.min()))
        return np.array(vectors), np.array(stiffness), least

    @property
    def alike(self) -> bool:
        """Whether the soft modes of all points span nearly the same subspace."""
        return self._soft.stop == 0 or self._turned[2] > _ALIKE

    def zeros(self, reach: float) -> list[Zero]:
        """Return the zeros of the stiffness of soft modes, at most `reach` from the centre."""
        from scipy.optimize import brentq  # slow to import

        if self._soft.stop == 0:
            return []

        def stiffness(x: float, number: int) -> float:
            return float(self._modes(x)[0][number])

        ends = self.centre - reach, self.centre + reach
        values = [self._modes(x)[0] for x in ends]
        changing = np.flatnonzero(values[0] * values[1] < 0.0)
        zeros = [Zero(brentq(stiffness, *ends, args=(int(i),), xtol=1e-15, rtol=1e-14), int(i)) for i in changing]
        return sorted(zeros, key=lambda zero: zero.at)

    def mode(self, zero: Zero) -> np.ndarray:
        """Return the mode (n,) whose stiffness vanishes at a zero."""
        turned = np.tensordot(self.weights(zero.at), self._turned[0], axes=1)
        result = np.zeros(self.rows.shape[1] - 1)
        result[self.free] = turned @ self._modes(zero.at)[1][:, zero.number]
        return result

    def _modes(self, x: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness (m,), ascending, and combinations (m, m) of the soft modes at a distance."""
        return eigh(np.tensordot(self.weights(x), self._turned[1], axes=1))

    def turn(self) -> float | None:
        """Return the distance at which the load has an extremum between the inner points, None if it has none."""
        from scipy.optimize import brentq  # slow to import

        inner = self.at[_REFERENCE], self.at[_REFERENCE + 1]
        if self.slopes[_REFERENCE] * self.slopes[_REFERENCE + 1] >= 0.0:
            return None
        return float(brentq(lambda x: self.weights(x) @ self.slopes, *inner, xtol=1e-15, rtol=1e-14))

    def aside(self, mode: np.ndarray) -> np.ndarray:
        """Return the component of each point (points,) along a mode (n,)."""
        return np.asarray(self.rows[:, self.free] @ (self.mass @ mode[self.free]))


def on_path(path: LoadingPath, normal: np.ndarray, ends: tuple[PathPoint, PathPoint], x: float) -> PathPoint:
    """Return the point of a path at a distance along a normal from the first of two others. Raises PathLostError."""
    before, after = (end.y for end in ends)
    nearest = before if 2.0 * x < path.line.dot(normal, after - before) else after
    return path.corrected(smooth(path, normal, ends, x), nearest, normal, after - before)


def smooth(path: LoadingPath, normal: np.ndarray, ends: tuple[PathPoint, PathPoint], x: float) -> np.ndarray:
    """Return coordinates and load factor (n + 1,) on the cubic through two points, continued by its tangents."""
    before, after = (end.y for end in ends)
    slopes = [end.tangent / path.line.dot(normal, end.tangent) for end in ends]
    reach = path.line.dot(normal, after - before)
    if x <= 0.0:
        return np.asarray(before + x * slopes[0])
    if x >= reach:
        return np.asarray(after + (x - reach) * slopes[1])
    t = x / reach
    interpolated = (1.0 - t) ** 2 * (1.0 + 2.0 * t) * before + t**2 * (3.0 - 2.0 * t) * after
    return np.asarray(interpolated + reach * t * (1.0 - t) * ((1.0 - t) * slopes[0] - t * slopes[1]))


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


BIFURCATION = "bifurcation"
LIMIT_POINT = "limit point"

_INSIDE = 0.3  # of the radius: critical points further out get windows of their own
_CLEAR = 1.2  # times the radius: least distance of the nearest critical point outside
_RADII = 0.2 * 0.3 ** np.arange(8)  # of the step in which a critical point lies
_RECENTRED = 4
_NEARER = (
    1.0 - 1e-6
)  # of the distance searched: a search before a critical point is shorter by the radius of its window
_IMPERFECT = 1e-9  # deviation of a path that still counts as a bifurcation: lengths of the model, radians
_ROUND_OFF = 30.0  # times the unbalanced force along a mode: deviation of a path that round-off can explain
_SMOOTH = 0.03  # of a step: largest deviation of its interior from the prediction of its ends
_EXACT = 1e-12  # of the load: no smaller window is tried


@dataclass(frozen=True, eq=False)
class Critical:
    """A singular point of a loading path: its kind, its load factor and state p (n,), the mode (n,) without stiffness,
    and the difference from the load factor found in a smaller or larger window.
    """

    kind: str
    load_factor: float
    p: np.ndarray
    mode: np.ndarray
    uncertainty: float


def critical_points(path: LoadingPath, before: PathPoint, after: PathPoint) -> tuple[list[Critical], PathPoint]:
    """Return the first critical points between two points of a path, those close together, and a point beyond them up
    to which there are no others; none and `after` if nothing changes in between. Raises PathLostError.
    """
    middle = _between(path, before, after)
    after = next((point for point in stops(path, before, middle, after) if Search(path, before, point).changes), after)
    while True:
        search = Search(path, before, after)
        if not search.changes:
            return [], after
        criticals, first, last = search.located(search.estimate())
        if search.distance(first) <= 0.0 or not Search(path, before, first).changes:
            return criticals, last
        if search.distance(first) > _NEARER * search.reach:
            raise PathLostError("a change of stability was found again where there is none")
        after = first


def _between(path: LoadingPath, before: PathPoint, after: PathPoint) -> PathPoint:
    """Return a point inside a step, where the slope of the load differs most from those at the ends.

    Raises PathLostError if it is not on the smooth path predicted by the ends: these lie on different paths.
    """
    normal = path.normal(before, after)
    reach, slopes, rise = loads(path, normal, before, after)
    curvature = slopes[0] + slopes[1] - 2.0 * rise
    fraction = 0.5
    if curvature != 0.0:
        extreme = (2.0 * slopes[0] + slopes[1] - 3.0 * rise) / (3.0 * curvature)
        fraction = extreme if 0.1 < extreme < 0.9 else 0.5
    foretold = smooth(path, normal, (before, after), fraction * reach)
    middle = on_path(path, normal, (before, after), fraction * reach)
    if path.line.length(middle.y - foretold) > _SMOOTH * path.line.length(after.y - before.y):
        raise PathLostError("the path turns too sharply")
    return middle


class Search:
    """The search for the critical points next to a place between two points of a path."""

    def __init__(self, path: LoadingPath, before: PathPoint, after: PathPoint) -> None:
        self.path, self.line = path, path.line
        self.before, self.after = before, after
        self.normal = path.normal(before, after)
        self.reach = self.distance(after)

    def distance(self, point: PathPoint) -> float:
        return self.line.dot(self.normal, point.y - self.before.y)

    @property
    def changes(self) -> bool:
        """Whether stability or the sign of the slope of the load differs at the end."""
        turns = self.before.tangent[-1] * self.after.tangent[-1] < 0.0
        return turns or self.before.negative_pivots != self.after.negative_pivots

    def estimate(self) -> float:
        """Return an estimate of the position of the first critical point."""
        ends, places = (self.before, self.after), []
        unstable = sorted(point.negative_pivots for point in ends)
        if unstable[0] < unstable[1]:
            values = [self.path.softest(point, unstable[1]).values[unstable[0] :] for point in ends]
            places += [a / (a - b) if a * b < 0.0 else 0.5 for a, b in zip(*values, strict=True)]
        slopes = [point.tangent[-1] for point in ends]
        if slopes[0] * slopes[1] < 0.0:
            places.append(slopes[0] / (slopes[0] - slopes[1]))
        return float(self.reach * min(places))

    def located(self, place: float) -> tuple[list[Critical], PathPoint, PathPoint]:
        """Return the critical points next to a place and the ends of the window in which they were found.

        Windows shrink until the results no longer converge. Raises PathLostError.
        """
        best: tuple[list[Critical], PathPoint, PathPoint] | None = None
        before: list[Critical] = []
        for radius in _RADII * self.reach:
            window, zeros = self._centred(place, radius)
            place = window.centre
            inside = [zero for zero in zeros if abs(zero.at - place) <= _INSIDE * window.radius and zero.at > 0.0]
            if not inside or len(inside) < len(zeros) or not window.alike:
                before = []
                continue
            try:
                criticals = self._read(window, inside)
            except PathLostError:
                if best is None:
                    raise
                break
            if len(criticals) == len(before):
                criticals = [
                    replace(critical, uncertainty=abs(critical.load_factor / previous.load_factor - 1.0))
                    for critical, previous in zip(criticals, before, strict=True)
                ]
                if best is not None and _worst(criticals) > 0.5 * _worst(best[0]):
                    break
                best = criticals, window.points[0], window.points[-1]
                if _worst(criticals) < _EXACT:
                    break
            before = criticals
        if best is None:
            raise PathLostError("critical points are too close together to be distinguished")
        return best

    def _centred(self, place: float, radius: float) -> tuple[Window, list[Zero]]:
        """Return the window about the critical point nearest to a place, and all zeros of stiffnesses in it."""
        for _ in range(_RECENTRED):
            if self.before is self.path.start:
                radius = min(radius, 0.9 * place)
            window = Window.about(self.path, self.normal, (self.before, self.after), place, radius)
            zeros = window.zeros(_CLEAR * radius)
            if not zeros:
                break
            nearest = min((zero.at for zero in zeros), key=lambda at: abs(at - place))
            if abs(nearest - place) <= 0.5 * _INSIDE * radius:
                return window, zeros
            place = nearest if nearest > 0.0 else 0.5 * place
        raise PathLostError("a change of stability was not found again")

    def _read(self, window: Window, zeros: list[Zero]) -> list[Critical]:
        """Return the critical points at the zeros, in the order of the path.

        A bifurcation at the load factor of a limit point comes before it, since there the path ends.
        """
        turn = window.turn()
        limit = None if turn is None else min(zeros, key=lambda zero: abs(zero.at - turn))
        result = []
        for zero in zeros:
            mode, kind, at = window.mode(zero), BIFURCATION, zero.at
            if zero is limit and turn is not None:
                kind, at = LIMIT_POINT, turn
            else:
                self._require_crossing(window, zero, mode)
            y = window.weights(at) @ window.rows
            result.append((at, Critical(kind, float(y[-1]), y[:-1], mode, np.inf)))
        if turn is not None:
            least = (1.0 - _EXACT) * max(critical.load_factor for _, critical in result)
            result = [(turn if critical.load_factor >= least else at, critical) for at, critical in result]
        return [critical for _, critical in sorted(result, key=lambda row: (row[0], row[1].kind == LIMIT_POINT))]

    def _require_crossing(self, window: Window, zero: Zero, mode: np.ndarray) -> None:
        """Raise PathLostError if the path bends aside along the mode, on a hyperbola, instead of being crossed.

        Round-off bends it as well, by the unbalanced force over the stiffness of the mode.
        """
        system = self.path.system
        fractions = (window.at - zero.at) / window.radius
        largest = float(np.max(np.abs(mode) / system.scale))
        basis = np.column_stack([fractions**0, fractions, fractions**2, fractions**3, 1.0 / fractions])
        bend = largest * abs(np.linalg.lstsq(basis, window.aside(mode))[0][-1])
        unbalanced = max(abs(float(mode @ self.path.unbalanced(point))) for point in window.points)
        stiffness = min(float(np.abs(soft.values).min()) for soft in window.softest)
        if bend > max(_IMPERFECT, _ROUND_OFF * unbalanced * largest / stiffness):
            raise PathLostError("the path bends aside")


def _worst(found: list[Critical]) -> float:
    return max(critical.uncertainty for critical in found)
