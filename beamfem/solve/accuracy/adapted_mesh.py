"""Meshes refined until the estimated error of a static solution is small enough."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from beamfem.assembly.system import system_of
from beamfem.element.coordinates import Rotation
from beamfem.element.fields import HIGHEST_ORDER, Lagrange
from beamfem.errors import ConvergenceError, InputError, LockingWarning
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.results.locking import locking
from beamfem.results.solution import Solution
from beamfem.solve.accuracy.error_estimate import (
    Quantity,
    enriched_row,
    error,
    error_shares,
    largest_displacement_error,
    of_order,
    remeshed,
)

_MOST_MESHES = 16
# orders below are raised first, by so much at a time, and up to the highest one where most elements would be divided
_RAISED, _STEP = 4, 2
_MOST_PARTS = 4  # of an element from one mesh to the next: far from the limit its order promises too much
_SAFETY = 2.0  # by how much the next mesh is to fall below the accuracy


def solved_to_accuracy(
    model: Model, accuracy: float, quantity: Quantity, solve: Callable[[Model], Solution]
) -> Solution:
    """Return the solution on the first mesh whose estimated error of the last row is below an accuracy [-].

    The error is relative to the size of the model or, with a quantity, to its largest value. Raises InputError for
    elements that lock, since their error does not show, and ConvergenceError if no mesh is fine enough.
    """
    iterations = 0
    for number in range(1, _MOST_MESHES + 1):
        solution = solve(model)
        iterations += solution.iterations
        found = [finding.sentence for finding in solution.computed(locking) if finding.kind is LockingWarning]
        if found:
            raise InputError(f"an accuracy cannot be had with these elements: {found[0]}")
        try:
            off = _relative_error(solution, quantity)
        except ConvergenceError:  # too far from the finer mesh to say how far
            model = refined(model, [np.ones(mesh.elements) for mesh in model.meshes], np.inf)
            continue
        if off <= accuracy:
            statistics = solution.statistics
            elements = sum(mesh.elements for mesh in model.meshes)
            ended = f"{statistics.ended}; the estimated error is {off:.2g} on mesh {number}, of {elements} elements"
            return replace(solution, statistics=replace(statistics, ended=ended, iterations=iterations))
        last = len(solution) - 1
        shares = error_shares(solution[last], enriched_row(solution, last))
        model = refined(model, shares, _SAFETY * off / accuracy)
    raise ConvergenceError(
        f"the estimated error is {off:.2g} after {_MOST_MESHES} meshes, more than the accuracy {accuracy:g} asked for",
        solution,
    )


def _relative_error(solution: Solution, quantity: Quantity) -> float:
    last = len(solution) - 1
    if quantity is None:
        finer = enriched_row(solution, last)
        return (
            largest_displacement_error(solution[last], finer, between_nodes=True)
            / system_of(solution.model, static=True).extent
        )
    change = np.abs(error(solution, quantity, last)).max()
    evaluated = quantity(solution[last:]) if callable(quantity) else solution.displacement(quantity)[-1]
    size = float(np.abs(evaluated).max())
    return float(change / size) if size > 0.0 else float(change)


def refined(model: Model, shares: list[np.ndarray], excess: float) -> Model:
    """Return a model with elements of higher order, or else shorter ones, so that they share an error evenly.

    shares (ne,): of the elements of each beam in the error, see `error_shares`; excess: how many times too large it is.
    """
    elements = sum(len(share) for share in shares)
    wanted = [share * elements * excess for share in shares]
    return remeshed(model, [_refined(*each) for each in zip(model.meshes, wanted, strict=True)])


def _refined(mesh: BeamMesh, wanted: np.ndarray) -> Beam:
    """Return a beam whose elements have at most their part of an error; wanted (ne,): by how much it is to fall."""
    beam, field = mesh.beam, mesh.beam.element.field
    if not (wanted > 1.0).any():
        return beam
    rotates = isinstance(beam.element.coordinates, Rotation) and beam.element.integration == "reduced"
    raisable = type(field) is Lagrange and rotates
    rate = 2 * field.degree if raisable else 2
    parts = np.clip(np.ceil(np.minimum(wanted, 1e300) ** (1.0 / rate)), 1, _MOST_PARTS).astype(int)
    if raisable and (field.degree < _RAISED or (field.degree + _STEP <= HIGHEST_ORDER and np.median(parts) > 1)):
        order = field.degree + _STEP
        return replace(beam, element=of_order(beam.element, order if field.degree >= _RAISED else min(order, _RAISED)))
    within = [np.arange(count) / count for count in parts.tolist()]
    element = np.repeat(np.arange(mesh.elements), parts)
    ends = mesh.arc_length(element, np.concatenate(within)) / mesh.vertices[-1]
    return replace(beam, elements=(*ends.tolist(), 1.0))
