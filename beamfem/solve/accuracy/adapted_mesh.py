"""Meshes refined until the estimated error of a result is small enough."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from beamfem.element.coordinates import Rotation
from beamfem.element.element import Element
from beamfem.element.fields import HIGHEST_ORDER, Lagrange
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError, LimitPointError, LockingWarning
from beamfem.mesh.beam_grid import distances
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.model_meshes import required_nodes
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.results.locking import locking
from beamfem.results.solution import Solution, State
from beamfem.results.status import Finding
from beamfem.solve.accuracy.carried_start import tied_to_mesh
from beamfem.solve.accuracy.error_estimate import (
    Quantity,
    enriched_row_kept,
    error,
    error_shares,
    largest_displacement_error,
    of_order,
    position_shares,
    remeshed,
)
from beamfem.validation import positive

DEFAULT = 1e-4  # accuracy of beams whose elements are "auto"
_MOST_MESHES = 16
# orders below are raised first, by so much at a time, and up to the highest one where most elements would be divided
_RAISED, _STEP = 4, 2
_LITTLE = 100.0  # by how much a step from order 4 lowers an error as a rule; for more, two are taken
_MUCH = 1000.0  # by how much it may lower one: if that is not enough, elements are divided as well
_MOST_PARTS = 4  # of an element from one mesh to the next: far from the limit its order promises too much
_TRUST = 1.5  # how many times as large as its estimate an error may be
_SLOWEST = 0.1  # part of the promised rate of errors that is believed
_SAFETY = 2.0  # by how much the next mesh is to fall below the accuracy
_FALLS = 0.5  # what a mesh is to leave of the error of the one before; the shares are of no use otherwise
_MOST_STALLED = 3  # meshes divided evenly whose error is not the smallest so far: it is round-off
# meshes that may have no solution, or end at limit points, before a finer one does not
_MOST_LOST, _MOST_LIMITED = 2, 5
_NOISE = 10.0  # by how much a quantity is to exceed what round-off of the coordinates makes of it
_SAME = 1e-9  # of the length of a beam: tolerance between places
_SAME_LOAD = 1e-2  # relative difference of limit points that two meshes agree on

_Result = TypeVar("_Result")
Shares = list[np.ndarray] | None


def prepared(model: Model, accuracy: float | None, start: State | Solution | None = None) -> tuple[Model, float | None]:
    """Return a model and the accuracy [-] that its mesh is to be refined to, None for the mesh as it is.

    It is that which is asked for, or the default for beams whose elements are "auto". With a state to start from, the
    first of their meshes is that of the state, and the only one if the state cannot be found on another one. Raises
    InputError.
    """
    automatic = system_of(model, static=True).model.automatic
    if automatic and isinstance(start, State | Solution):
        model = model.meshed(start)
    tied = tied_to_mesh(start)
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
    attempt: Callable[[Model], tuple[_Result | None, float, Shares]],
    most: int = _MOST_MESHES,
) -> _Result:
    """Return the result on the first mesh whose estimated error is well below an accuracy [-].

    attempt: returns the result on a mesh, None if it is far too coarse, its relative error, and the shares (ne,) of the
    elements of each beam in it, see `error_shares`, or None for equal ones; most: number of meshes to try. Raises
    ConvergenceError if none of them is fine enough, whose `solution` is the result with the smallest error, or that of
    a solve that fails on finer meshes, too.
    """
    fixed = [_fixed(*each) for each in zip(model.meshes, required_nodes(model), strict=True)]
    # a result lists its elements, and has beams with numbers of them to be saved
    model = remeshed(model, [_listed(mesh) for mesh in model.meshes])
    iterations = elements = stalled = number = 0
    pace = 1.0
    lost, known = list[ConvergenceError](), list[int]()
    before = smallest = np.inf
    best: _Result | None = None
    evenly = False
    while number < most and stalled < _MOST_STALLED:
        number += 1
        try:
            result, error, shares = attempt(model)
        except ConvergenceError as reason:
            lost.append(reason)
            if len(lost) > (_MOST_LIMITED if isinstance(reason, LimitPointError) else _MOST_LOST) or _agree(lost):
                raise
            result, error, shares = None, np.inf, None
        parts = sum(mesh.elements for mesh in model.meshes) / max(elements, 1)
        divided = parts > 1.0
        elements = sum(mesh.elements for mesh in model.meshes)
        if isinstance(result, Solution):
            iterations += result.iterations
            mesh = f"mesh {number}, of {elements} elements"
            ended = f"{result.statistics.ended}; the estimated error is {error:.2g} on {mesh}"
            statistics = replace(result.statistics, ended=ended, iterations=iterations)
            result = replace(result, statistics=statistics)
        if _TRUST * error <= accuracy:
            assert result is not None
            return result
        stalled = stalled + 1 if evenly and divided and smallest <= error < np.inf else 0
        # shares are those of stress resultants, which may be exact where the interpolated axis is not
        evenly = shares is None or (divided and error > _FALLS * before)
        rates = [_rate(mesh.beam.element) for mesh in model.meshes]
        if rates == known and divided and error < before < np.inf:
            # far from its limit a rate rises with each division: the next one is between it and the promise
            pace = float(np.sqrt(np.clip(np.log(before / error) / np.log(parts) / np.mean(rates), _SLOWEST, 1.0)))
        before, known = error, rates
        if error < smallest:
            smallest, best = error, result
        model = refined(model, None if evenly else shares, _SAFETY * error / accuracy, fixed, pace)
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


def _fixed(mesh: BeamMesh, parts: list[tuple[float, str]]) -> np.ndarray:
    """Return the arc lengths [m] at which elements end on every mesh: all ends of the user's own elements."""
    if mesh.beam.elements != "auto":
        return mesh.vertices
    return np.array([*(fraction * mesh.vertices[-1] for fraction, _ in parts), *mesh.beam.curve.corners])


def _listed(mesh: BeamMesh) -> Beam:
    beam = mesh.beam
    return (
        beam
        if beam.elements == "knots"
        else replace(beam, elements=tuple((mesh.vertices / mesh.vertices[-1]).tolist()))
    )


def require_unlocked(findings: Iterable[Finding]) -> None:
    """Raise InputError if one of the findings is that elements lock, since their error does not show."""
    found = [finding.sentence for finding in findings if finding.kind is LockingWarning]
    if found:
        raise InputError(f"an accuracy cannot be had with these elements: {found[0]}")


def static_attempt(solution: Solution, quantity: Quantity) -> tuple[Solution, float, Shares]:
    """Return a static solution, the estimated error [-] of its last row, and the shares of the elements in it.

    The error is relative to the size of the model or, with a quantity, to its largest value. Raises InputError for
    elements that lock.
    """
    require_unlocked(solution.computed(locking))
    try:
        last, finer = enriched_row_kept(solution, -1)
    except ConvergenceError:  # too far from the finer mesh to say how far
        return solution, np.inf, None
    state = solution[last]
    if quantity is None:
        off = largest_displacement_error(state, finer, between_nodes=True)
        return solution, off / system_of(solution.model, static=True).extent, position_shares(state, finer)
    change = float(np.abs(error(solution, quantity, last)).max())
    row = solution[last:]
    evaluated = _evaluated(row, quantity)
    size = float(np.abs(evaluated).max())
    if max(size, change) <= _NOISE * float(np.abs(_evaluated(_rounded(row), quantity) - evaluated).max()):
        return solution, 0.0, None  # zero, as far as numbers can tell
    return solution, change / size if size > 0.0 else change, error_shares(state, finer)


def _evaluated(row: Solution, quantity: Callable[[Solution], Any] | Point) -> np.ndarray:
    return np.asarray(quantity(row) if callable(quantity) else row.displacement(quantity)[-1], dtype=float)


def _rounded(row: Solution) -> Solution:
    """Return a solution of one row with other round-off: every coordinate off by one part in 2^52, up or down."""
    system = system_of(row.model, static=True)
    signs = np.random.default_rng(0).choice((-1.0, 1.0), row.p.shape)
    off = np.where(system.positions, system.extent, 1.0)
    off[system.history.numbers] = 0.0
    return replace(row, p=row.p + np.finfo(float).eps * signs * off)


def refined(model: Model, shares: Shares, excess: float, fixed: list[np.ndarray], pace: float = 1.0) -> Model:
    """Return a model with elements of higher order, or else shorter ones, so that they share an error evenly.

    shares (ne,): of the elements of each beam in the error, see `error_shares`, None to divide all
    alike; excess: how many times too large it is; fixed: arc lengths [m] of each beam at which elements stay to end;
    pace: rate at which errors fall by division, as part of what the orders promise.
    """
    elements = sum(mesh.elements for mesh in model.meshes)
    even = [np.full(mesh.elements, 1.0 / elements) for mesh in model.meshes]
    wanted = [share * elements * excess for share in shares or even]
    evenly = shares is None
    return remeshed(model, [_refined(*each, evenly, pace) for each in zip(model.meshes, wanted, fixed, strict=True)])


def _raisable(element: Element) -> bool:
    rotates = isinstance(element.coordinates, Rotation) and element.integration == "reduced"
    return type(element.field) is Lagrange and rotates


def _rate(element: Element) -> int:
    """Return the power of the length of elements with which errors fall."""
    return 2 * element.field.degree if _raisable(element) else 2


def _refined(mesh: BeamMesh, wanted: np.ndarray, fixed: np.ndarray, evenly: bool, pace: float) -> Beam:
    """Return a beam whose elements have at most their part of an error; wanted (ne,): by how much it is to fall."""
    beam, field = mesh.beam, mesh.beam.element.field
    if not (wanted > 1.0).any():
        return beam
    raisable, wanted = _raisable(beam.element), np.minimum(wanted, 1e300)
    parts = np.clip(wanted ** (1.0 / (pace * _rate(beam.element))), 1.0, _MOST_PARTS)
    if raisable and (field.degree < _RAISED or (field.degree + _STEP <= HIGHEST_ORDER and np.median(parts) > 1.0)):
        low, steps = field.degree < _RAISED, 1 + int(np.median(wanted) > _LITTLE)
        order = min(field.degree + _STEP, _RAISED) if low else min(field.degree + _STEP * steps, HIGHEST_ORDER)
        beam = replace(beam, element=of_order(beam.element, order))
        left = wanted / _MUCH ** ((order - field.degree) / _STEP)
        if order < HIGHEST_ORDER or not (left > 1.0).any():
            return beam
        parts = np.clip(left ** (1.0 / _rate(beam.element)), 1.0, _MOST_PARTS)
    if evenly:
        parts = np.ceil(parts)
    # whole numbers of elements between fixed ends: if 1.2 times as many do, halves of all would be far too many
    length = mesh.vertices[-1]
    inner = 1 + np.flatnonzero(distances(mesh.vertices[1:-1], fixed) < _SAME * length)
    ends = [0.0]
    for first, last in pairwise([0, *inner.tolist(), mesh.elements]):
        along = np.append(0.0, np.cumsum(parts[first:last]))
        wanted_ends = np.linspace(0.0, along[-1], int(np.ceil(along[-1] - _SAME)) + 1)
        ends += (np.interp(wanted_ends[1:], along, mesh.vertices[first : last + 1]) / length).tolist()
    return replace(beam, elements=(*ends[:-1], 1.0))
