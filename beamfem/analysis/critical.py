"""Where on a loading path the tangent is singular: bifurcations and limit points.

No equilibrium is solved for at a critical point itself, where round-off leads off the path. The path, its load and the
stiffness of the softest modes are interpolated between points that keep their distance on both sides; modes whose
stiffness vanishes close together are interpolated as one subspace.
"""

from dataclasses import dataclass, replace

import numpy as np

from beamfem.analysis.continuation import PathPoint
from beamfem.analysis.loading_path import LoadingPath, PathLostError
from beamfem.analysis.newton import round_off_floor
from beamfem.analysis.window import Window, Zero

BIFURCATION = "bifurcation"
LIMIT_POINT = "limit point"

_INSIDE = 0.3  # of the radius: critical points further out are left to windows of their own
_CLEAR = 1.2  # times the radius: where the nearest critical point outside may be
_RADII = 0.2 * 0.3 ** np.arange(8)  # of the step in which a critical point lies
_RECENTRED = 4
_IMPERFECT = 1e-9  # how far a path may bend aside before a bifurcation: lengths of the model, radians
_EXACT = 1e-12  # of the load: no smaller window is tried


@dataclass(frozen=True, eq=False)
class Critical:
    """A singular point of a loading path: what it is, its load factor and state p (n,), the mode (n,) that is not
    resisted, and how far from it the load factor of a smaller or larger window is.
    """

    kind: str
    load_factor: float
    p: np.ndarray
    mode: np.ndarray
    uncertainty: float


def critical_points(path: LoadingPath, before: PathPoint, after: PathPoint) -> tuple[list[Critical], PathPoint]:
    """Return the first critical points between two points of a path, those that lie close together, and a point behind
    them up to which there are no others; none and `after` where nothing changes in between. Raises PathLostError.
    """
    while True:
        search = Search(path, before, after)
        place = search.estimate()
        if place is None:
            return [], after
        found, first, last = search.located(place)
        if search.distance(first) <= 0.0 or Search(path, before, first).estimate() is None:
            return found, last
        after = first


class Search:
    """The search for the critical points next to a place between two points of a path."""

    def __init__(self, path: LoadingPath, before: PathPoint, after: PathPoint) -> None:
        self.path, self.line = path, path.line
        self.before, self.after = before, after
        chord = after.y - before.y
        self.normal = self.line.plane(chord / self.line.length(chord))
        self.reach = self.distance(after)

    def distance(self, point: PathPoint) -> float:
        return self.line.dot(self.normal, point.y - self.before.y)

    def estimate(self) -> float | None:
        """Return about where the first critical point lies, None where stability and the slope of the load stay."""
        ends, places = (self.before, self.after), []
        unstable = sorted(point.negative_pivots for point in ends)
        if unstable[0] < unstable[1]:
            values = [self.path.softest(point, unstable[1]).values[unstable[0] :] for point in ends]
            places += [a / (a - b) if a * b < 0.0 else 0.5 for a, b in zip(*values, strict=True)]
        slopes = [point.tangent[-1] for point in ends]
        if slopes[0] * slopes[1] < 0.0:
            places.append(slopes[0] / (slopes[0] - slopes[1]))
        return self.reach * min(places) if places else None

    def located(self, place: float) -> tuple[list[Critical], PathPoint, PathPoint]:
        """Return the critical points next to a place and the ends of the window that they were found in.

        Windows shrink until what they find no longer settles. Raises PathLostError.
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
            found = self._read(window, inside)
            if len(found) == len(before):
                found = [
                    replace(one, uncertainty=abs(one.load_factor / other.load_factor - 1.0))
                    for one, other in zip(found, before, strict=True)
                ]
                if best is not None and _worst(found) > 0.5 * _worst(best[0]):
                    break
                best = found, window.points[0], window.points[-1]
                if _worst(found) < _EXACT:
                    break
            before = found
        if best is None:
            raise PathLostError("critical points lie too close together to be told apart")
        return best

    def _centred(self, place: float, radius: float) -> tuple[Window, list[Zero]]:
        """Return the window about the critical point nearest to a place, and all that vanishes there."""
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
        """Return what lies where the tangent is singular."""
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
            result.append(Critical(kind, float(y[-1]), y[:-1], mode, np.inf))
        return sorted(result, key=lambda one: one.load_factor)

    def _require_crossing(self, window: Window, zero: Zero, mode: np.ndarray) -> None:
        """Raise PathLostError where the path bends aside along the mode, on a hyperbola, instead of being crossed.

        Round-off bends it as well: by the force that it leaves, over the stiffness of the mode.
        """
        system = self.path.system
        shares = (window.at - zero.at) / window.radius
        largest = float(np.max(np.abs(mode) / system.scale))
        basis = np.column_stack([shares**0, shares, shares**2, shares**3, 1.0 / shares])
        bend = largest * abs(np.linalg.lstsq(basis, window.aside(mode))[0][-1])
        floor = round_off_floor(system, window.rows[0, :-1]) * float(np.linalg.norm(mode[system.free_dofs]))
        stiffness = min(float(np.abs(soft.values).min()) for soft in window.softest)
        if bend > max(_IMPERFECT, floor * largest / stiffness):
            raise PathLostError("the path bends aside")


def _worst(found: list[Critical]) -> float:
    return max(one.uncertainty for one in found)
