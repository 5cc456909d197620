"""Meshes refined until the estimated error of a result is small enough."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from beamfem.curves import Line, Polyline
from beamfem.element.coordinates import Rotation
from beamfem.element.element import Element
from beamfem.element.fields import HIGHEST_ORDER, Lagrange
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError, LimitPointError, LockingWarning
from beamfem.mesh.beam_grid import distances, element_ends
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
    decay_errors,
    enriched,
    enriched_row_kept,
    error_shares,
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
_MOST_MESHES = 16
# orders of elements on the first mesh for a low accuracy, otherwise there are as many as digits
_LOWEST, _LOWEST_CURVED = 2, 4
_REACH = 1e-2  # to the power of an order: by how much an error falls as far as elements of this order can tell
_FROM = 3  # order from which on an error of 1 / _FROM belongs to a solution that is singular at once, see `_distance`
_LARGEST = 0.2  # error that is believed; beyond, all that is known is that the mesh is too coarse
_MOST_PARTS, _FEW_PARTS = 8.0, 2.0  # of an element from one mesh to the next, and where little is known or gained
_PACE = 0.5  # part of the promised decrease of errors, in digits, below which that is slow
_ENOUGH = 1.3  # times the unknowns needed: if the enriched space has no more, it is the next mesh
_BETTER = 0.1  # of an error: that of the space it is estimated by
_ASYMPTOTIC = 0.2  # of the largest displacement: errors above it fall more slowly than orders promise
_TRUST = 1.5  # how many times as large as its estimate an error may be
_SLOWEST = 0.1  # part of the promised decrease of errors, in digits, that is believed at the least
_SAFETY = 2.0  # by how much the next mesh is to fall below the accuracy
_FALLS = 0.5  # what a mesh is to leave of the error of the one before; the shares are of no use otherwise
_MOST_STALLED = 3  # meshes divided evenly, or no finer, whose error is not the smallest so far: it is round-off
# meshes that may have no solution, or end at limit points, before a finer one does not
_MOST_LOST, _MOST_LIMITED = 2, 5
_TINY = 1e-30  # error [-] of elements that have none
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
) -> _Result:
    """Return the result on the first mesh whose estimated error is well below an accuracy [-].

    attempt: returns the result on a mesh, None if it is far too coarse, its relative error, and the shares (ne,) of the
    elements of each beam in it or a function for them, see `error_shares`, or None for equal ones; most: number of
    meshes to try. Raises ConvergenceError if none of them is fine enough, whose `solution` is the result with the
    smallest error, or that of a solve that fails on finer meshes, too.
    """
    # a result lists its elements, and has beams with numbers of them to be saved
    profiles = profiles_of(model)
    jumps = [() if profile is None else profile.jumps for profile in profiles]
    needed = [(*own, *others) for own, others in zip(model.nodes_needed.fractions, jumps, strict=True)]
    first = [_first(*each, accuracy) for each in zip(model.beams, needed, strict=True)]
    fixed = [ends for _, ends in first]
    model = remeshed(model, [beam for beam, _ in first])
    iterations = elements = unknowns = stalled = number = 0
    pace, expected = 1.0, 0.0
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
        divided = sum(mesh.elements for mesh in model.meshes) > elements
        elements = sum(mesh.elements for mesh in model.meshes)
        more = sum(map(_intervals, model.beams)) > unknowns
        unknowns = sum(map(_intervals, model.beams))
        if isinstance(result, Solution):
            iterations += result.iterations
            mesh = f"mesh {number}, of {elements} elements"
            ended = f"{result.statistics.ended}; the estimated error is {error:.2g} on {mesh}"
            statistics = replace(result.statistics, ended=ended, iterations=iterations)
            result = replace(result, statistics=statistics)
        if _TRUST * error <= accuracy:
            assert result is not None
            return result
        stalled = stalled + 1 if ((evenly and divided) or not more) and smallest <= error < np.inf else 0
        # shares are those of stress resultants, which may be exact where the interpolated axis is not
        evenly = shares is None or (divided and error > _FALLS * before)
        if max(expected, error) < before < np.inf:
            # where functions are less smooth than believed, errors fall more slowly
            pace = float(np.clip(np.log(before / error) / np.log(before / expected), _SLOWEST, 1.0))
        if error < smallest:
            smallest, best = error, result
        before = error
        own = None if evenly else shares() if callable(shares) else shares
        most_parts = _MOST_PARTS if pace > _PACE else _FEW_PARTS
        model, expected = refined(model, own, error, accuracy / _SAFETY, fixed, pace, most_parts)
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


def _first(beam: Beam, fractions: Sequence[float], accuracy: float) -> tuple[Beam, np.ndarray]:
    """Return a beam with its first elements, and the arc lengths [m] at which elements end on every mesh.

    These are all ends of the user's own elements.
    """
    ends, length, element = element_ends(beam, fractions), beam.curve.length, beam.element
    if beam.elements != "auto":
        return beam if beam.elements == "knots" else with_elements(beam, ends / length), ends
    if _raisable(element):
        lowest = _LOWEST if isinstance(beam.curve, Line | Polyline) else _LOWEST_CURVED
        element = of_order(element, int(np.clip(np.rint(-np.log10(accuracy)), lowest, HIGHEST_ORDER)))
    kept = np.array([*np.multiply(fractions, length), *beam.curve.corners])
    return with_elements(beam, ends / length, element), kept


def require_unlocked(findings: Iterable[Finding]) -> None:
    """Raise InputError if one of the findings is that elements lock, since their error does not show."""
    found = [finding.sentence for finding in findings if finding.kind is LockingWarning]
    if found:
        raise InputError(f"an accuracy cannot be had with these elements: {found[0]}")


class StaticAttempts:
    """Static solutions on one mesh after another, their estimated errors [-], and the shares of the elements in them.

    Each but the first begins with the states of the one before, unless these do not tell its path. An error is that of
    the last row or, if it is larger, of the row that the mesh approximates worst, relative to the size of the model;
    with a quantity, that of the last row, relative to its largest value. Raises InputError for elements that lock.
    """

    def __init__(self, solve: Callable[[Model], Solution], quantity: Quantity, accuracy: float) -> None:
        self._solve, self._quantity, self._accuracy = solve, quantity, accuracy
        # the last solution, and its last row on the enriched space
        self._known: tuple[Solution | None, Solution | None] = None, None

    def __call__(self, model: Model) -> tuple[Solution, float, Callable[[], Shares] | Shares]:
        """See `refined_until`."""
        (path, finer), self._known = self._known, (None, None)
        carried = None if path is None else carried_path(path, finer, model)
        solution = self._solve(model) if carried is None else carried
        require_unlocked(solution.computed(locking))
        worst = len(solution) - 1 if self._quantity else _worst_row(solution)
        if self._quantity is None and (coarse := self._too_coarse(solution, worst)) is not None:
            self._known = solution, None
            return coarse
        if carried is not None and finer is not None and model.tables.get("enriched") is finer.model:
            keep_enriched_row(solution, finer)
        try:
            last, finer = enriched_row_kept(solution, -1)
            pairs = [(solution[last], finer)]
            if worst != last:
                pairs.append((solution[worst], enriched_row_kept(solution, worst)[1]))
        except ConvergenceError:  # too far from the finer mesh to say how far
            return solution, np.inf, None
        extent = system_of(model, static=True).extent
        errors = np.array([largest_position_error(*pair) for pair in pairs]) / extent
        off = float(errors.max())
        if off < NEAR:
            self._known = solution, finer
        if self._quantity is None:
            moved = max(largest_displacement(finer.model, finer.p[0]) for _, finer in pairs) / extent
            if off > _ASYMPTOTIC * moved > _ASYMPTOTIC**2 * self._accuracy:
                off = np.inf  # where layers are much thinner than elements, finer ones show but a part of them
            return solution, off, lambda: shares_of_rows(pairs, errors, position_shares)
        off = relative_change(solution[last:], finer, self._quantity, self._accuracy)
        return solution, off, lambda: error_shares(*pairs[0])

    def _too_coarse(self, solution: Solution, row: int) -> tuple[Solution, float, Shares] | None:
        """Return what the decay of coefficients tells of a mesh without an estimate, None if it may be fine enough."""
        errors = decay_errors(solution[row])
        if errors is None:
            return None
        largest = max(float(each.max()) for each in errors)
        elements = sum(map(len, errors))
        if largest <= self._accuracy:
            return None
        return solution, largest, [each / (elements * largest) for each in errors]


def _worst_row(solution: Solution) -> int:
    """Return the row that a mesh approximates worst: by its coefficients, or that with the largest strain energy."""
    last = len(solution) - 1
    if last <= 1:
        return last
    if decay_errors(solution[last]) is None:
        return int(np.argmax(solution.energy().strain))
    decay = [decay_errors(solution[row]) or [] for row in range(last + 1)]
    return int(np.argmax([max(float(each.max()) for each in errors) for errors in decay]))


def refined(
    model: Model,
    shares: Shares,
    error: float,
    target: float,
    fixed: list[np.ndarray],
    pace: float = 1.0,
    most_parts: float = _MOST_PARTS,
) -> tuple[Model, float]:
    """Return a model whose elements share a smaller error evenly, by higher orders or shorter elements, and that error.

    It has the fewest unknowns for it, or is the enriched one, which is there already. shares (ne,): of the elements of
    each beam in the error, see `error_shares`, None to divide all alike; fixed: arc lengths [m] of each beam at which
    elements stay to end; pace: how many digits of the error go for one that the orders promise; most_parts: into how
    many an element is divided.
    """
    elements = sum(mesh.elements for mesh in model.meshes)
    even = [np.full(mesh.elements, 1.0 / elements) for mesh in model.meshes]
    if not error < _LARGEST:
        error, most_parts = _LARGEST, _FEW_PARTS
    lowest = min(mesh.beam.element.field.degree for mesh in model.meshes)
    target = max(error * max((target / error) ** (1.0 / pace), _REACH**lowest), np.finfo(float).eps)
    errors = [np.minimum(elements * error * share, _LARGEST) for share in shares or even]
    parted = zip(model.meshes, errors, fixed, strict=True)
    result = remeshed(model, [_refined(*each, target, shares is None, most_parts) for each in parted])
    finer = enriched(model)
    known = [(mesh, _distances(mesh, own)) for mesh, own in zip(model.meshes, errors, strict=True)]
    expected, finest = (
        max(_error_on(*each, beam) for each, beam in zip(known, other.beams, strict=True)) for other in (result, finer)
    )
    needed, most = (sum(map(_intervals, other.beams)) for other in (result, finer))
    if finest <= target and most <= _ENOUGH * needed:
        return finer, finest
    if finest <= _BETTER * expected and needed < most:
        result.tables["enriched"] = finer
    return result, expected


def _raisable(element: Element) -> bool:
    rotates = isinstance(element.coordinates, Rotation) and element.integration == "reduced"
    return type(element.field) is Lagrange and rotates


def _intervals(beam: Beam) -> int:
    return beam.element_count * beam.element.field.degree


def _rate(element: Element) -> int:
    """Return the power of the length of short elements with which errors fall."""
    return element.field.degree + 1 if _raisable(element) else 2


def _at_once(rate: int) -> float:
    return 1.0 / min(rate - 1, _FROM)


def _distance(error: Any, rate: int) -> Any:
    """Return how many half-lengths of an element away its solution is singular, to the side, by its error [-].

    An interpolated function that is analytic within the ellipse of Bernstein with the semi-axes (rho + 1 / rho) / 2 and
    (rho - 1 / rho) / 2, which has both ends of the element as foci, has an error of C rho^-rate; C was fitted to random
    models. Source: Trefethen, Approximation Theory and Approximation Practice, 2013, theorem 8.2.
    """
    rho = (_at_once(rate) / error) ** (1.0 / rate)
    return 0.5 * (rho - 1.0 / rho)


def _error(distance: Any, rate: int) -> Any:
    """Return the error of an element by that distance, see `_distance`."""
    return _at_once(rate) * (distance + np.hypot(distance, 1.0)) ** -float(rate)


def _error_on(mesh: BeamMesh, distance: np.ndarray, finer: Beam) -> float:
    """Return the largest error of other elements of a beam; distance (ne,): of those of its mesh, see `_distance`."""
    ends = np.asarray(finer.elements) * mesh.vertices[-1]
    parent = np.searchsorted(mesh.vertices[1:-1], 0.5 * (ends[1:] + ends[:-1]))
    parts = mesh.lengths[parent] / np.diff(ends)
    return float(_error((distance[parent] * parts).min(), _rate(finer.element)))


def _distances(mesh: BeamMesh, errors: np.ndarray) -> np.ndarray:
    return np.asarray(_distance(np.maximum(errors, _TINY), _rate(mesh.beam.element)))


def _refined(
    mesh: BeamMesh, errors: np.ndarray, fixed: np.ndarray, target: float, evenly: bool, most_parts: float
) -> Beam:
    """Return a beam whose elements have errors of at most a target; errors (ne,): of those of its mesh."""
    beam = best = mesh.beam
    if not (errors > target).any():
        return beam
    distance, lowest, least = _distances(mesh, errors), beam.element.field.degree, (np.inf, 0)
    for order in range(lowest, HIGHEST_ORDER + 1 if _raisable(beam.element) else lowest + 1):
        element = beam.element if order == lowest else of_order(beam.element, order)
        parts = np.clip(_distance(target, _rate(element)) / distance, 1.0, most_parts)
        finer = with_elements(beam, _ends(mesh, np.ceil(parts) if evenly else parts, fixed), element)
        cost = max(_error_on(mesh, distance, finer), target), _intervals(finer)
        if cost <= least:
            least, best = cost, finer
    return best


def _ends(mesh: BeamMesh, parts: np.ndarray, fixed: np.ndarray) -> tuple[float, ...]:
    """Return the fractions at which new elements end, of which so many are needed instead of each element (ne,).

    They are whole numbers between fixed ends: if 1.2 times as many do, halves of all would be far too many.
    """
    length = mesh.vertices[-1]
    inner = 1 + np.flatnonzero(distances(mesh.vertices[1:-1], fixed) < _SAME * length)
    ends = [0.0]
    for first, last in pairwise([0, *inner.tolist(), mesh.elements]):
        along = np.append(0.0, np.cumsum(parts[first:last]))
        wanted = np.linspace(0.0, along[-1], int(np.ceil(along[-1] - _SAME)) + 1)
        ends += (np.interp(wanted[1:], along, mesh.vertices[first : last + 1]) / length).tolist()
    return (*ends[:-1], 1.0)
