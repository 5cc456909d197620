"""Discretisation error of an equilibrium path: of its rows, and of the load factors of its critical points."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.locking import locking
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.results.solution import Solution, State
from beamfem.solve.accuracy.adapted_mesh import Shares, require_unlocked
from beamfem.solve.accuracy.error_estimate import (
    carried_coordinates,
    carried_stresses,
    enriched,
    error_shares,
    largest_position_error,
    mode_shares,
    position_shares,
    shares_of_rows,
)
from beamfem.solve.accuracy.quantity_change import LOST, Quantity, change_if_found
from beamfem.solve.continuation.bifurcations import bifurcations
from beamfem.solve.continuation.continuation import Continuation
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError
from beamfem.solve.newton.newton import Newton
from beamfem.solve.stability.linearised import critical_growth

_MOST_ROWS = 24  # of a path whose errors are estimated
_WIDER = 3  # rows on each side of a critical point, at the most, between which it is looked for on finer elements


def path_attempt(
    path: Path, quantity: Quantity, trace: Callable[[Model], Path], accuracy: float
) -> tuple[Path, float, Shares]:
    """Return a path, its largest estimated error [-], and the shares of the elements in it.

    The error is that of displacements relative to the size of the model, or that of load factors relative to the
    largest one; if it is no more than an accuracy [-], that of the load factors of critical points, relative to the
    largest of them, counts as well. With a quantity it is that of a point at some rows, or of a function of the path,
    which is traced on finer elements for it, relative to the largest value. Raises InputError for elements that lock.
    """
    require_unlocked(path.computed(locking))
    finer, largest = _FinerPath(path), float(np.abs(path.load_factor).max()) or 1.0
    pairs, moved, off = list[tuple[PathState, Solution]](), list[float](), list[float]()
    lost = False
    rows = np.unique(np.linspace(0, len(path) - 1, _MOST_ROWS).round().astype(int)).tolist()
    for number in range(1, len(rows)):
        state = path[rows[number]]
        try:
            row = finer.row(rows[number], rows[number - 1], rows[min(number + 1, len(rows) - 1)]).as_row(static=True)
        except SegmentLostError:
            lost = True
            continue
        change = largest_position_error(state, row) / finer.line.system.extent
        moved.append(max(change, abs(float(row.at[-1]) - state.at) / largest))
        if isinstance(quantity, Point):
            off.append(float(np.linalg.norm(row.displacement(quantity)[-1] - state.displacement(quantity))))
        pairs.append((state, row))
    if not pairs:
        return path, np.inf, None
    error = max(moved)
    if isinstance(quantity, Point):
        error = max(off) / (float(np.linalg.norm(path.displacement(quantity), axis=1).max()) or 1.0)
    elif quantity is not None:
        error = change_if_found(path, trace(finer.model), quantity, LOST if lost else error)
    elif not lost and error <= accuracy:
        try:
            of_critical, critical_shares = _critical_error(finer, dict(zip(rows[1:], pairs, strict=True)))
        except (SegmentLostError, LinAlgError):
            return path, LOST, None
        if of_critical > error:
            return path, of_critical, critical_shares
    shares = shares_of_rows(pairs, np.array(moved), position_shares if quantity is None else error_shares)
    return path, max(error, LOST) if lost else error, shares


def _critical_error(finer: "_FinerPath", rows: dict[int, tuple[PathState, Solution]]) -> tuple[float, Shares]:
    """Return the largest error of the load factors of critical points, over the largest one, and the shares in it.

    rows: some of the path by their numbers, and the same on finer elements; where another number of modes has lost its
    stiffness on these, and no critical point is beside, one is missing. One that only an end of the path parts from it
    is off by about twice the way to there. Raises SegmentLostError if one is not found on finer elements, or if by
    linear analysis they more than halve the way from the last stable state to the next one, as even finer ones may.
    """
    path, points = finer.path, finer.points
    largest, errors, modes = max((abs(point.at) for point in points), default=0.0), list[float](), list[Any]()
    for point, place in zip(points, finer.places, strict=True):
        try:
            other = finer.critical(point)
        except SegmentLostError:
            if place < len(path) - 2:
                raise
            errors.append(2.0 * abs(float(path.at[-1]) - point.at))
            continue
        errors.append(abs(other.state.at - point.at))
        modes.append((errors[-1], (point, finer.own_mode(point), *other)))
    stable: tuple[State, State] | None = None
    for row, (state, same) in rows.items():
        softened = _softened(finer.line, same[0]), _softened(finer.own_line, state)
        if softened == (0, 0) and path.at[row] > path.at[row - 1]:
            stable = state, same[0]
        missing = abs(softened[0] - softened[1])
        if missing and not {row - 1, row} & set(finer.places):
            found = [other.state.at for kind in finer.between(row - 1, row) for other in kind]
            if len(found) != missing:
                raise SegmentLostError("another number of modes has lost its stiffness")
            errors += [2.0 * abs(float(path.at[row]) - at) for at in found]
            largest = max(largest, *map(abs, found))
    if stable is not None:
        own, ahead = (critical_growth(system_of(row.model, static=True), row.p, row.at) for row in stable)
        if own > 2.0 * ahead:
            raise SegmentLostError("a mode that coarse elements stiffen may have lost its stiffness")
    if not errors:
        return 0.0, None
    of_modes = np.array([error for error, _ in modes]) / (largest or 1.0)
    shares = mode_shares((mode for _, mode in modes), of_modes, np.zeros_like(of_modes))
    return max(errors) / (largest or 1.0), shares or None


def _softened(line: Continuation, state: State) -> int:
    """Return how many modes have a negative stiffness; of unsymmetric tangents pivots tell whether they are odd."""
    y = np.append(state.p, state.at)
    count = line.linearised(y, y).negative_pivots
    return count if line.system.symmetric else count % 2


def critical_error(path: Path, point: PathState) -> float:
    """Return the load factor of a limit point or bifurcation of a path on the enriched space less its own.

    Raises ConvergenceError if it is not found there.
    """
    try:
        return _FinerPath(path).critical(point).state.at - point.at
    except (SegmentLostError, LinAlgError) as reason:
        raise ConvergenceError(
            f"the error cannot be estimated: on finer elements this critical point was not found: {reason}",
            remedy="The mesh is too coarse for it; trace the path with more elements",
        ) from None


class _Critical(NamedTuple):
    """A critical point on the enriched space, and its mode (n,)."""

    state: State
    mode: np.ndarray


class _FinerPath:
    """The rows of a path on the enriched space, each in the plane across the path, and critical points between them.

    The load factor is measured such that the path goes as far in it as in displacements.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.model = path, enriched(path.model)
        self.points: tuple[PathState, ...] = (*path.limit_points, *path.bifurcations)
        self._y = np.column_stack([path.p, path.at])
        moves = self._line_of(path.model, 1.0).weights
        moved = float(np.sqrt(((self._y - self._y[0])[:, :-1] ** 2 @ moves[:-1]).max()))
        scale = float(np.ptp(path.at)) / (moved or 1.0) or 1.0
        self.own_line, self.line = (self._line_of(model, scale) for model in (path.model, self.model))
        self._carried, self._found = dict[int, np.ndarray](), dict[tuple[int, int], tuple[list[_Critical], ...]]()

    @staticmethod
    def _line_of(model: Model, scale: float) -> Continuation:
        return Continuation(system_of(model, static=True), Newton(), scale, scale)

    def _state(self, y: np.ndarray) -> State:
        rest = np.zeros(self.model.size)
        return State(y[:-1], rest, rest.copy(), float(y[-1]), self.model)

    def carried(self, row: int) -> np.ndarray:
        """Return y (n + 1,) of a row before its correction."""
        if row not in self._carried:
            self._carried[row] = np.append(carried_coordinates(self.path[row], self.model), self.path.at[row])
        return self._carried[row]

    def row(self, row: int, before: int, after: int) -> State:
        """Return a row, corrected in the plane across the way between two others. Raises SegmentLostError."""
        chord = self.carried(after) - self.carried(before)
        stresses = carried_stresses(self.path[row], self.model)
        corrected = self.line.correct(self.carried(row), stresses, chord / self.line.length(chord))
        if not corrected.ended.good:
            raise SegmentLostError(corrected.ended.value)
        return self._state(corrected.y)

    def critical(self, point: PathState) -> _Critical:
        """Return the limit point or bifurcation that is one of the path on coarser elements. Raises SegmentLostError.

        It is that with the same number between two rows, if there are as many.
        """
        kind, number = isinstance(point, Bifurcation), next(i for i, own in enumerate(self.points) if own is point)
        alike = [i for i, own in enumerate(self.points) if isinstance(own, Bifurcation) == kind]
        for wider in range(_WIDER):
            first = max(self.places[number] - wider, 0)
            last = min(self.places[number] + 1 + wider, len(self.path) - 1)
            own = [i for i in alike if first <= self.places[i] < last]
            with suppress(SegmentLostError, LinAlgError):
                if len(found := self.between(first, last)[kind]) == len(own):
                    return found[own.index(number)]
        raise SegmentLostError("there is another number of them between the states beside it")

    def own_mode(self, point: PathState) -> np.ndarray:
        """Return the mode (n,) of a critical point of the path; at a limit point it is along the path."""
        if isinstance(point, Bifurcation):
            return point.mode
        y = np.append(point.p, point.at)
        return self.own_line.linearised(y, y).tangent[:-1]

    @cached_property
    def places(self) -> list[int]:
        """The row before each critical point."""
        steps, result = self._lengths(np.diff(self._y, axis=0)), []
        for point in self.points:
            ways = self._lengths(self._y - np.append(point.p, point.at))
            result.append(int(np.argmin(ways[:-1] + ways[1:] - steps)))
        return result

    def _lengths(self, changes: np.ndarray) -> np.ndarray:
        return np.sqrt(changes**2 @ self.own_line.weights)

    def between(self, first: int, last: int) -> tuple[list[_Critical], ...]:
        """Return limit points and bifurcations between two rows. Raises SegmentLostError."""
        if (first, last) not in self._found:
            self._found[first, last] = [], []
            chord = self.carried(last) - self.carried(first)
            low, high = sorted(self.path.at[[first, last]].tolist())
            line = replace(self.line, piece=(low, high))
            ends = (self.row(row, max(row - 1, 0), min(row + 1, len(self.path) - 1)) for row in (first, last))
            before, after = (line.linearised(np.append(end.p, end.at), chord) for end in ends)
            segment = Segment(line, before, after)
            limits = segment.limit_points()
            self._found[first, last] = (
                [_Critical(self._state(segment.critical(x)), segment.interpolated(x)[1][:-1]) for x in limits],
                [_Critical(self._state(each.y), each.mode[:-1]) for each in bifurcations(segment, limits)],
            )
        return self._found[first, last]
