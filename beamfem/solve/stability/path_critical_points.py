"""Where on a loading path the tangent is singular: bifurcations and limit points.

No equilibrium is solved for at a critical point itself, where round-off leads off the path. The path, its load and the
stiffness of the softest modes are interpolated between points at a distance on both sides; modes whose stiffness
vanishes close together are interpolated as one subspace.
"""

from dataclasses import dataclass, replace

import numpy as np

from beamfem.solve.continuation.continuation import PathPoint
from beamfem.solve.stability.critical_point_fit import Window, Zero, on_path, smooth
from beamfem.solve.stability.loading_path import LoadingPath, PathLostError
from beamfem.solve.stability.paired_critical_points import loads, stops

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
