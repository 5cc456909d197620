"""Meshes refined until the estimated error of a result is small enough."""

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from typing import Any, TypeVar

import numpy as np

from beamfem.curves import Line, Polyline
from beamfem.element.coordinates import Rotation
from beamfem.element.element import Element
from beamfem.element.fields import HIGHEST_ORDER, Lagrange
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError, LimitPointError, LockingWarning
from beamfem.mesh.beam_grid import distances as distances_of
from beamfem.mesh.beam_grid import element_ends
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.results.locking import locking
from beamfem.results.solution import Solution, State
from beamfem.results.status import Finding
from beamfem.solve.accuracy.carried_start import tied_to_mesh
from beamfem.solve.accuracy.error_estimate import (
    NEAR,
    carried_path,
    enriched_row_kept,
    error_shares,
    errors_of_orders,
    keep_enriched_row,
    largest_displacement,
    largest_position_error,
    of_order,
    position_shares,
    remeshed,
    shares_of_rows,
    with_elements,
)
from beamfem.solve.accuracy.narrow_features import profiles_of, resolved
from beamfem.solve.accuracy.quantity_change import Quantity, relative_change, require_quantity
from beamfem.validation import positive

DEFAULT = 1e-4  # accuracy of beams whose elements are "auto"
# of the largest displacement, and of the model: the accuracy that it needs besides, and that which round-off leaves
_OF_MOVEMENT, _ROUND_OFF = 1e-3, 1e-14
_MOST_MESHES = 16
# orders of elements on the first mesh for a low accuracy, otherwise there are as many as digits
_LOWEST, _LOWEST_CURVED = 2, 4
_REACH = 1e-2  # to the power of an order: by how much an error falls as far as elements of this order can tell
_LARGEST = 0.2  # error that is believed; beyond, all that is known is that the mesh is too coarse
_MOST_PARTS, _FEW_PARTS = 8.0, 2.0  # of an element from one mesh to the next, and where little is known or gained
_BETTER = 0.2  # of an error: that of a mesh which tells it
_ASYMPTOTIC = 0.2  # of the largest displacement: errors above it fall more slowly than orders promise
_TRUST = 1.5  # how many times as large as its estimate an error may be
_SAFETY = 2.0  # by how much the next mesh is to fall below the accuracy
_FALLS = 0.5  # what a mesh is to leave of the error of the one before; the shares are of no use otherwise
_MOST_STALLED = 3  # meshes divided evenly, or no finer, whose error is not the smallest so far: it is round-off
# meshes that may have no solution, or end at limit points, before a finer one does not
_MOST_LOST, _MOST_LIMITED = 2, 5
_MOST_ROWS = 24  # whose errors are estimated
_TINY, _MOST = 1e-30, 0.9  # error [-] of elements that have none, and of those that are off by all they show
_SAME = 1e-9  # of the length of a beam: tolerance between places
_SAME_LOAD = 1e-2  # relative difference of limit points that two meshes agree on

_Result = TypeVar("_Result")
Shares = list[np.ndarray] | None


def prepared(
    model: Model, accuracy: float | None, start: State | Solution | None = None, quantity: Quantity = None
) -> tuple[Model, float | None]:
    """Return a model and the accuracy [-] that its mesh is to be refined to, None for the mesh as it is.

    It is that which is asked for, or the default for beams whose elements are "auto". With a state to start from, the
    first of their meshes is that of the state, and the only one if the state cannot be found on another one. Raises
    InputError, also for a quantity without an accuracy.
    """
    require_quantity(quantity)
    automatic = system_of(model, static=True).model.automatic
    if automatic and isinstance(start, State | Solution):
        model = model.meshed(start)
    tied = tied_to_mesh(start) if automatic or accuracy is not None else ""
    if quantity is not None and accuracy is None and (tied or not automatic):
        raise InputError("a quantity is what is to be accurate, so it needs an accuracy, such as accuracy=1e-4")
    if accuracy is not None:
        accuracy = positive("accuracy", accuracy)
        if tied:
            raise InputError(
                f"an accuracy needs a mesh that may change, but the state to start from {tied}, so that it has its own",
                remedy="Ask for an accuracy where this state is found; what starts from it has the same mesh",
            )
        return model, accuracy
    return model, DEFAULT if automatic and not tied else None


def refined_until(
    model: Model,
    accuracy: float,
    attempt: Callable[[Model], tuple[_Result | None, float, Callable[[], Shares] | Shares]],
    most: int = _MOST_MESHES,
    first_order: int | None = None,
    needs: Callable[[_Result], float] | None = None,
) -> _Result:
    """Return the result on the first mesh whose estimated error is well below an accuracy [-].

    attempt: returns the result on a mesh, None if it is far too coarse, its relative error, and the shares (ne,) of the
    elements of each beam in it or a function for them, see `error_shares`, or None for equal ones; most: number of
    meshes to try; first_order: of elements that may have any, by default as many as the accuracy has digits; needs:
    returns the accuracy that a result needs, if that is smaller, as far as round-off allows. Raises ConvergenceError if
    none of them is fine enough, whose `solution` is the result with the smallest error, or that of a solve that fails
    on finer meshes, too.
    """
    asked = accuracy
    # a result lists its elements, and has beams with numbers of them to be saved
    profiles = profiles_of(model)
    jumps = [() if profile is None else profile.jumps for profile in profiles]
    needed = [(*own, *others) for own, others in zip(model.nodes_needed.fractions, jumps, strict=True)]
    digits = int(np.rint(-np.log10(accuracy)))
    first = [_first(*each, first_order or digits) for each in zip(model.beams, needed, strict=True)]
    fixed = [ends for _, ends in first]
    model = remeshed(model, [beam for beam, _ in first])
    iterations = unknowns = stalled = number = 0
    lost = list[ConvergenceError]()
    before = smallest = np.inf
    best: _Result | None = None
    evenly = False
    while number < most and stalled < _MOST_STALLED:
        number += 1
        model = resolved(model, profiles, accuracy)
        try:
            result, error, shares = attempt(model)
        except ConvergenceError as reason:
            lost.append(reason)
            if len(lost) > (_MOST_LIMITED if isinstance(reason, LimitPointError) else _MOST_LOST) or _agree(lost):
                raise
            result, error, shares = None, np.inf, None
        except KeyboardInterrupt as interrupt:
            found = getattr(interrupt, "solution", None)
            if isinstance(found, Solution):
                ended = f"{found.statistics.ended}; it stopped on mesh {number}, whose error is not known"
                interrupt.solution = found.with_statistics(ended=ended)  # type: ignore[attr-defined]
            raise
        if needs is not None and result is not None:
            accuracy = min(accuracy, needs(result))
        finer = sum(map(_intervals, model.beams)) > unknowns
        unknowns = sum(map(_intervals, model.beams))
        if isinstance(result, Solution):
            iterations += result.iterations
            mesh = f"mesh {number}, of {sum(mesh.elements for mesh in result.model.meshes)} elements"
            ended = f"{result.statistics.ended}; the estimated error is {error:.2g} on {mesh}"
            result = result.with_statistics(ended=ended, iterations=iterations)
        if _TRUST * error <= accuracy:
            assert result is not None
            return result
        stalled = stalled + 1 if (evenly or not finer) and smallest <= error < np.inf else 0
        # shares are those of stress resultants, which may be exact where the interpolated axis is not
        evenly = shares is None or (finer and error > _FALLS * before)
        if error < smallest:
            smallest, best = error, result
        before = error
        own = None if evenly else shares() if callable(shares) else shares
        model = refined(model, own, error, accuracy / _SAFETY, fixed)
    if _TRUST * smallest <= asked:
        assert best is not None
        return best
    falls = ", and falls no further" if stalled else ""
    raise ConvergenceError(
        f"the estimated error is at best {smallest:.2g} on {number} meshes{falls}; for an accuracy of {accuracy:g} it "
        f"must be at most {accuracy / _TRUST:.2g}",
        best if isinstance(best, Solution) else None,
    )


def _agree(lost: list[ConvergenceError]) -> bool:
    """Return whether the last two meshes without a solution end at the same limit point."""
    loads = [reason.load_factor for reason in lost[-2:] if isinstance(reason, LimitPointError)]
    return len(loads) == 2 and abs(loads[1] - loads[0]) <= _SAME_LOAD * abs(loads[1])


def _first(beam: Beam, fractions: Sequence[float], order: int) -> tuple[Beam, np.ndarray]:
    """Return a beam with its first elements, and the arc lengths [m] at which elements end on every mesh.

    These are all ends of the user's own elements.
    """
    ends, length, element = element_ends(beam, fractions), beam.curve.length, beam.element
    if beam.elements != "auto":
        return beam if beam.elements == "knots" else with_elements(beam, ends / length), ends
    if _raisable(element):
        lowest = _LOWEST if isinstance(beam.curve, Line | Polyline) else _LOWEST_CURVED
        element = of_order(element, int(np.clip(order, lowest, HIGHEST_ORDER)))
    kept = np.array([*np.multiply(fractions, length), *beam.curve.corners])
    return with_elements(beam, ends / length, element), kept


def require_unlocked(findings: Iterable[Finding]) -> None:
    """Raise InputError if one of the findings is that elements lock, since their error does not show."""
    found = [finding.sentence for finding in findings if finding.kind is LockingWarning]
    if found:
        raise InputError(f"an accuracy cannot be had with these elements: {found[0]}")


def refined_statically(
    model: Model, accuracy: float, solve: Callable[[Model], Solution], quantity: Quantity, by_movement: bool
) -> Solution:
    """Return the static solution on a mesh with few unknowns whose estimated error is below an accuracy [-].

    by_movement: whether the error is to be small beside the largest displacement as well.
    """
    lowest = [1 if beam.elements == "auto" else beam.element.field.degree for beam in model.beams]
    needs = _accuracy_of_movement if by_movement else None
    attempts = _StaticAttempts(solve, quantity, accuracy, lowest, needs)
    first = HIGHEST_ORDER if quantity is None else None
    return refined_until(model, accuracy, attempts, first_order=first, needs=needs)


def _accuracy_of_movement(solution: Solution) -> float:
    """Return the accuracy [-] that leaves a displacement few digits, but for round-off."""
    moved = max(largest_displacement(solution.model, p) for p in solution.p)
    return max(_OF_MOVEMENT * moved / system_of(solution.model, static=True).extent, _ROUND_OFF)


class _StaticAttempts:
    """Static solutions on one mesh after another, their estimated errors [-], and the shares of the elements in them.

    Each but the first begins with the states of the one before, unless these do not tell its path. An error is the
    largest of all rows, or of some where coefficients do not tell it, see `_rows_before`, relative to the size of the
    model; with a quantity, that of the last row, relative to its largest value. Where coefficients tell the errors of
    all orders, a fine mesh is found by them, which tells the error of the cheapest one. Raises InputError for elements
    that lock.
    """

    def __init__(
        self,
        solve: Callable[[Model], Solution],
        quantity: Quantity,
        accuracy: float,
        lowest: list[int],
        needs: Callable[[Solution], float] | None,
    ) -> None:
        self._needs = needs
        self._solve, self._quantity, self._accuracy, self._lowest = solve, quantity, accuracy, lowest
        # the last solution, and its last row on the enriched space
        self._known: tuple[Solution | None, Solution | None] = None, None
        self._first = list[np.ndarray]()  # ends of the elements of the first mesh, which are those of all

    def __call__(self, model: Model) -> tuple[Solution, float, Callable[[], Shares] | Shares]:
        """See `refined_until`."""
        self._first = self._first or [mesh.vertices for mesh in model.meshes]
        (path, finer), self._known = self._known, (None, None)
        carried = None if path is None else carried_path(path, finer, model)
        solution = self._solve(model) if carried is None else carried
        require_unlocked(solution.computed(locking))
        if self._needs is not None:
            self._accuracy = min(self._accuracy, self._needs(solution))
        told = self._quantity is None and all(_raisable(mesh.beam.element) for mesh in model.meshes)
        of_rows = errors_of_orders(solution) if told else None
        if of_rows is not None:
            errors = [each.max(axis=0) for each in of_rows]
            largest = max(float(each[:, -1].max()) for each in errors)
            unseen = _unseen(largest, solution, self._accuracy)
            if largest > _BETTER * self._accuracy or unseen:
                self._known = solution, None
                elements = sum(map(len, errors))
                shares = [each[:, -1] / (elements * largest) for each in errors]
                return solution, np.inf if unseen else largest / _BETTER, shares
            cheaper = self._cheaper(path, solution, errors)
            if cheaper is not None:
                return *cheaper, None
        try:
            last, finer = enriched_row_kept(solution, -1)
            pairs = [(solution[last], finer)]
            others = [] if self._quantity else _rows_before(solution)
            pairs += [(solution[row], enriched_row_kept(solution, row)[1]) for row in others]
        except ConvergenceError:  # too far from the finer mesh to say how far
            return solution, np.inf, None
        of_rows = np.array([largest_position_error(*pair) for pair in pairs]) / system_of(model, static=True).extent
        off = float(of_rows.max())
        if off < NEAR:
            self._known = solution, finer
        if self._quantity is None:
            if all(_unseen(off, row, self._accuracy) for _, row in pairs):
                off = np.inf
            return solution, off, lambda: shares_of_rows(pairs, of_rows, position_shares)
        off = relative_change(solution[last:], finer, self._quantity, self._accuracy)
        return solution, off, lambda: error_shares(*pairs[0])

    def _cheaper(
        self, coarser: Solution | None, solution: Solution, errors: list[np.ndarray]
    ) -> tuple[Solution, float] | None:
        """Return a solution that is accurate enough with fewer unknowns than one that is more than that, and its error.

        It is a known coarser one, or that on the cheapest mesh; None if there is none. errors: see `errors_of_orders`.
        """
        model = solution.model
        orders = [np.arange(low, own.shape[1] + 1) for own, low in zip(errors, self._lowest, strict=True)]
        known = [_distance(own.T[each - 1], each[:, None] + 1) for own, each in zip(errors, orders, strict=True)]
        largest = max(float(each[:, -1].max()) for each in errors)
        target, expected, most, last = self._accuracy / _SAFETY, np.inf, sum(map(_intervals, model.beams)), 0
        while True:
            if coarser is not None:
                error = largest + _difference(coarser, solution)
                if _TRUST * error <= self._accuracy:
                    coarser.model.tables["enriched"] = model
                    keep_enriched_row(coarser, solution[-1:])
                    return coarser, error
                # the errors of elements add up
                target = min(target, expected * self._accuracy / error)
                coarser = None
            parted = zip(model.meshes, orders, known, self._first, strict=True)
            found = [_cheapest(*each, target) for each in parted]
            expected, fewer = max(error for error, _ in found), remeshed(model, [beam for _, beam in found])
            unknowns = sum(map(_intervals, fewer.beams))
            if unknowns >= most:
                return None
            target /= _SAFETY
            if unknowns > last:
                last, coarser = unknowns, carried_path(solution, None, fewer)
                with suppress(ConvergenceError):
                    coarser = coarser or self._solve(fewer)


def _difference(solution: Solution, finer: Solution) -> float:
    """Return the largest distance [-] of the axis in two solutions, by the size of the model; of others the last."""
    pair = (solution, finer) if np.array_equal(solution.at, finer.at) else (solution[-1], finer[-1:])
    return largest_position_error(*pair) / system_of(solution.model, static=True).extent


def _unseen(error: float, solution: Solution, accuracy: float) -> bool:
    """Return whether an error [-] may be much larger: where layers are thinner than elements, it is but a part."""
    system = system_of(solution.model, static=True)
    moved = max(largest_displacement(solution.model, p) for p in solution.p) / system.extent
    return error > _ASYMPTOTIC * moved > _ASYMPTOTIC**2 * accuracy


def _rows_before(solution: Solution) -> list[int]:
    """Return the rows before the last whose errors are estimated: those that a mesh may approximate worse.

    It is the worst one by its coefficients; where these do not tell it, some of all, as even the largest strain energy
    does not, or that one if what remembers is led through the rows before each.
    """
    last = len(solution) - 1
    if (found := errors_of_orders(solution)) is not None:
        rows = [int(np.argmax(np.max([each[..., -1].max(axis=1) for each in found], axis=0)))]
    elif len(system_of(solution.model, static=True).history.numbers):
        rows = [int(np.argmax(solution.energy().strain))]
    else:
        rows = np.unique(np.linspace(1, last, _MOST_ROWS).round().astype(int)).tolist() if last else []
    return [row for row in rows if row != last]


def refined(model: Model, shares: Shares, error: float, target: float, fixed: list[np.ndarray]) -> Model:
    """Return a model with the fewest unknowns whose elements share a smaller error evenly.

    They are of higher orders or shorter. shares (ne,): of the elements of each beam in the error, see `error_shares`,
    None to divide all alike; fixed: arc lengths [m] of each beam at which elements stay to end.
    """
    elements = sum(mesh.elements for mesh in model.meshes)
    even = [np.full(mesh.elements, 1.0 / elements) for mesh in model.meshes]
    most_parts = _MOST_PARTS if shares and error < _LARGEST else _FEW_PARTS
    error = min(error, _LARGEST)
    lowest = min(mesh.beam.element.field.degree for mesh in model.meshes)
    target = max(target, error * _REACH**lowest, np.finfo(float).eps)
    beams = []
    for mesh, share, ends in zip(model.meshes, shares or even, fixed, strict=True):
        errors, element = np.minimum(elements * error * share, _LARGEST), mesh.beam.element
        orders = np.arange(element.field.degree, HIGHEST_ORDER + 1) if _raisable(element) else np.zeros(1, dtype=int)
        known = np.tile(_distance(errors, _rate(element)), (len(orders), 1))
        parted = mesh, orders, known, ends, target, shares is None, 1.0, most_parts
        beams.append(_cheapest(*parted)[1] if (errors > target).any() else mesh.beam)
    return remeshed(model, beams)


def _raisable(element: Element) -> bool:
    rotates = isinstance(element.coordinates, Rotation) and element.integration == "reduced"
    return type(element.field) is Lagrange and rotates


def _intervals(beam: Beam) -> int:
    return beam.element_count * beam.element.field.degree


def _rate(element: Element) -> int:
    """Return the power of the length of short elements with which errors fall."""
    return element.field.degree + 1 if _raisable(element) else 2


def _distance(error: Any, rate: Any) -> Any:
    """Return how many half-lengths of an element away its solution is singular, to the side, by its error [-].

    An interpolated function that is analytic within the ellipse of Bernstein with the semi-axes (rho + 1 / rho) / 2 and
    (rho - 1 / rho) / 2, which has both ends of the element as foci, has an error of about rho^-rate. Source: Trefethen,
    Approximation Theory and Approximation Practice, 2013, theorem 8.2.
    """
    rho = np.clip(error, _TINY, _MOST) ** (-1.0 / rate)
    return 0.5 * (rho - 1.0 / rho)


def _error(distance: Any, rate: Any) -> Any:
    """Return the error of an element by that distance, see `_distance`."""
    return (distance + np.hypot(distance, 1.0)) ** (-1.0 * rate)


def _error_on(mesh: BeamMesh, distance: np.ndarray, finer: Beam) -> float:
    """Return the largest error of other elements of a beam; distance (ne,): of those of its mesh, see `_distance`."""
    ends = np.asarray(finer.elements) * mesh.vertices[-1]
    parent = np.searchsorted(mesh.vertices[1:-1], 0.5 * (ends[1:] + ends[:-1]))
    parts = mesh.lengths[parent] / np.diff(ends)
    return float(_error((distance[parent] * parts).min(), _rate(finer.element)))


def _cheapest(
    mesh: BeamMesh,
    orders: np.ndarray,
    distances: np.ndarray,
    fixed: np.ndarray,
    target: float,
    evenly: bool = False,
    least_parts: float = 0.0,
    most_parts: float = np.inf,
) -> tuple[float, Beam]:
    """Return the beam with the fewest unknowns whose elements have errors of at most a target, or the smallest ones.

    orders (m,): to choose from, 0 for elements that have one; distances (m, ne): of the elements of its mesh with each,
    see `_distance`. Returns the largest error, too.
    """
    beam, length = mesh.beam, mesh.vertices[-1]
    rates = np.where(orders, orders + 1, _rate(beam.element))
    parts = np.clip(_distance(target, rates)[:, None] / distances, least_parts, most_parts)
    parts = np.ceil(parts) if evenly else parts
    inner = 1 + np.flatnonzero(distances_of(mesh.vertices[1:-1], fixed) < _SAME * length)
    pieces = [0, *inner.tolist()]
    # elements are whole between fixed ends: if 1.2 times as many do, halves of all would be far too many
    counts = np.ceil(np.add.reduceat(parts, pieces, axis=1) - _SAME).astype(int)
    errors = _error((parts * distances).min(axis=1), rates)
    best = np.lexsort((-orders, counts.sum(axis=1) * orders, np.maximum(errors, (1.0 + _SAME) * target)))[0]
    ends = [0.0]
    for first, last, count in zip(pieces, [*pieces[1:], mesh.elements], counts[best].tolist(), strict=True):
        along = np.append(0.0, np.cumsum(parts[best, first:last]))
        wanted = np.linspace(0.0, along[-1], count + 1)[1:]
        ends += (np.interp(wanted, along, mesh.vertices[first : last + 1]) / length).tolist()
    element = of_order(beam.element, int(orders[best])) if orders[best] else beam.element
    finer = with_elements(beam, (*ends[:-1], 1.0), element)
    return _error_on(mesh, distances[best], finer), finer
