"""Warning of a mesh that is too coarse for the displacements of a static solution, or of a motion that keeps it."""

from collections.abc import Callable
from functools import lru_cache
from math import comb
from typing import Any, TypeVar
from warnings import catch_warnings

import numpy as np

from beamfem.element.coordinates import Rotation
from beamfem.element.element import Element
from beamfem.element.fields import Lagrange
from beamfem.equations.system import System, system_of
from beamfem.errors import CoarseMeshWarning, ConvergenceError, InputError, LockingWarning
from beamfem.kernels.bent_elements import ELEMENT, FACTORS, WEIGHTS, coarseness
from beamfem.kernels.records import address_of
from beamfem.mesh.beam_grid import distances
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.model_meshes import required_nodes
from beamfem.model.beam import beam_in_words
from beamfem.model.model import Model
from beamfem.progress import ends_as_a_whole
from beamfem.results.locking import locking, pairs
from beamfem.results.solution import Solution
from beamfem.results.solution_checks import warn_of
from beamfem.results.status import Finding
from beamfem.solve.accuracy.error_estimate import (
    EnrichedModel,
    enriched,
    enriched_row_kept,
    error_shares,
    largest_displacement,
    largest_displacement_error,
)

_Rows = TypeVar("_Rows", bound=Solution)

WARNED = 0.02  # of the largest displacement, or of a frequency: error above which there is a warning
_STILL = 1e-13  # of the size of the model: movement that may be round-off
_ROWS = 50  # of a motion, about: that are compared
_ENOUGH = 0.005  # of it: error that the advice leads to
_MARGIN = 1.05  # of an indicator whose error is small: larger ones for which it is not estimated again
_CHIEF = 0.8  # of the error: what the elements that a warning names account for

_FEW = 4  # elements below which the error is always estimated
_SMALLEST = np.finfo(float).tiny  # bending stiffness [N m^2]
_SAMPLES, _PER_SAMPLE = 3, 8  # of a section without jumps: at the least, and elements for each
_SAME = 1e-9  # of the length of a beam: tolerance between places

# sum of the angles between the directors of an element of order k, with which a strip that is rolled up is off by 1 %
_TURN = (0.19, 1.1, 2.4, 3.8, 5.3, 6.2, 7.5, 8.8)
_CUBIC_TURN = 0.9  # the same for the cubic field
_JUMP, _PART = 0.005, 2e-4  # of the energy: that of jumps of moments, and of parts of the highest degree


class _Table:
    """The data of `coarseness` of a model; fine: the largest indicator for which its error was found to be small."""

    def __init__(self, system: System) -> None:
        meshes, neighbours = system.model.meshes, system.table(pairs)
        elements, total = sum(mesh.elements for mesh in meshes), sum(float(mesh.vertices[-1]) for mesh in meshes)
        # one element has no neighbour to differ from, and so few cost no more to estimate than to solve
        self.fine = 0.0 if elements < _FEW and not isinstance(system.model, EnrichedModel) else 1.0
        whole, weights = np.empty((elements, ELEMENT), dtype=np.int64), np.zeros((elements, WEIGHTS))
        factors = np.empty((len(neighbours.length), FACTORS))
        factors[:, :4] = neighbours.at_rest[:, 1:].view(float)
        element = pair = 0
        for mesh, parts in zip(meshes, required_nodes(system.model), strict=True):
            kind, count = mesh.beam.element, mesh.elements
            inner, order = len(kind.field.nodes) - 1, _order(kind)
            own, own_pairs = slice(element, element + count), slice(pair, pair + count * inner)
            element, pair = own.stop, own_pairs.stop
            whole[own, 0], whole[own, 1], whole[own, 2] = inner, _joined(mesh, parts), order
            h, (start, end) = mesh.lengths, _bending(mesh)
            mean = 0.5 * (start + end)
            turn = _TURN[order - 1] if isinstance(kind.field, Lagrange) else _CUBIC_TURN
            weights[own, 0], weights[own, 1] = 1.0 / turn, h / total
            weights[own, 2] = h / (mean * (8.0 * (2 * order + 1) * _JUMP))
            if inner > 2 or order < inner > 1:
                weights[own, 3] = h * mean / ((2 * inner - 1) * _PART)
            elif order == 1 and count == 1:
                weights[own, 4] = h / (12.0 * mean * _JUMP)
            scales = np.empty((count, 1, 4))
            scales[:, 0, 0], scales[:, 0, 1], scales[:, 0, 2], scales[:, 0, 3] = start, end, mean, 1.0
            scales /= h[:, None, None]
            slopes = _differences(tuple(kind.field.nodes))
            factors[own_pairs, 4:8] = (scales * slopes).reshape(-1, 4)
            factors[own_pairs, 8] = _turned(mesh)
        self._arrays = whole, weights, np.ascontiguousarray(neighbours.numbers[:, 4:]), factors
        self._table = np.array([elements, *map(address_of, self._arrays)], dtype=np.int64)
        self.address = address_of(self._table)


def _order(element: Element) -> int:
    """Return the order with which an element converges; integrated fully, its bending has one degree less."""
    exact = element.integration == "reduced" and isinstance(element.coordinates, Rotation)
    return max(len(element.field.nodes) - 1 - (not exact), 1)


def _joined(mesh: BeamMesh, parts: list[tuple[float, str]]) -> np.ndarray:
    """Return whether each element (ne,) of a beam continues the one before, with no part that may let moments jump."""
    result = np.zeros(mesh.elements, dtype=bool)
    result[1:] = mesh.node[1:, 0] == mesh.node[:-1, -1]
    parted = np.array([at for at, name in parts if name != "PointForce" and 0.0 < at < 1.0])
    if len(parted):
        length = mesh.vertices[-1]
        result[1:] &= distances(mesh.vertices[1:-1], parted * length) > _SAME * length
    return result


def _bending(mesh: BeamMesh) -> tuple[Any, Any]:
    """Return the bending stiffness (ne,) [N m^2] at the start and the end of the elements of a beam, or of all."""
    beam, every = mesh.beam, np.arange(mesh.elements)
    if beam.prismatic:
        constant = max(beam.section_at(0.0).rigidity(beam.material).bending, _SMALLEST)
        return constant, constant
    sides = [mesh.section_arc_length(every, np.full(mesh.elements, xi)) for xi in (0.0, 1.0)]
    at = np.unique(sides)
    if not beam.jumps:
        at = at[np.linspace(0, len(at) - 1, max(len(at) // _PER_SAMPLE, _SAMPLES)).astype(int)]
    known = [max(beam.section_at(s).rigidity(beam.material).bending, _SMALLEST) for s in at.tolist()]
    return np.interp(sides[0], at, known), np.interp(sides[1], at, known)


def _turned(mesh: BeamMesh) -> Any:
    """Return the angles (m,) between the sections of neighbouring nodes in the reference."""
    if mesh.straight:
        return 0.0
    tangent = mesh.tangent[:, 0] + 1j * mesh.tangent[:, 1]
    return np.angle(tangent[mesh.node[:, 1:]] / tangent[mesh.node[:, :-1]]).ravel()


@lru_cache(maxsize=64)  # by the orders of elements, of which there are few
def _differences(nodes: tuple[float, ...]) -> np.ndarray:
    """Return what the differences of a polynomial between its nodes (m + 1,) contribute to its slope (m, 4).

    They are the slope at xi = 0 and at 1, its weight in the energy, and the part of the highest degree at xi = 1.
    """
    xi, order = np.array(nodes), len(nodes) - 1
    # a polynomial by its values at all nodes but the first, where it is zero
    coefficients = np.linalg.inv(xi[1:, None] ** np.arange(1, order + 1)) @ np.tril(np.ones((order, order)))
    # in the monomial of degree n, the Legendre polynomial of that degree has the factor 1 / binomial(2 n, n)
    highest = order * coefficients[-1] / comb(2 * (order - 1), order - 1)
    slope = np.arange(1, order + 1) @ coefficients
    return np.column_stack([coefficients[0], slope, 1.0 / np.diff(xi), highest])


def warned_of_coarse_mesh(solution: _Rows, unseen: bool = False) -> _Rows:
    """Return a static solution after a warning, which it then holds, if its displacements are off by 2 % or more.

    unseen: whether its mesh was chosen without it, so that its error is estimated in any case. Elsewhere it is where
    the indicator of its last state exceeds 1, and not again for the same mesh with an indicator that is no larger. It
    is not if there is a warning that its elements lock, which finer ones would too.
    """
    system = system_of(solution.model, static=True)
    if not len(solution):
        return solution
    table, state = system.table(_Table), np.ascontiguousarray(solution.p[-1])
    indicator = coarseness.compiled(table.address, address_of(state))
    if indicator <= table.fine and not unseen:
        return solution
    if any(finding.kind is LockingWarning for finding in solution.computed(locking)):
        return solution
    found = _found(solution)
    if found is None:
        table.fine = _MARGIN * indicator
        return solution
    return _told(solution, found)


def _found(solution: Solution) -> Finding | None:
    """Return a warning of the last row of a solution if its estimated error is large, or there is no estimate."""
    model, last = solution.model, len(solution) - 1
    try:
        finer = enriched_row_kept(solution, last)[1]
    except ConvergenceError as reason:
        return Finding(f"the mesh may be too coarse: {reason.reason}. Use more elements", CoarseMeshWarning)
    except InputError:  # a part of the user's own that takes no other mesh
        return None
    state = solution[last]
    moved = max(largest_displacement(model, p) for p in solution.p)  # the last row may be back where it began
    still = moved <= _STILL * system_of(model, static=True).extent
    error = 0.0 if still else largest_displacement_error(state, finer) / moved
    if error <= WARNED:
        return None
    places, most = _chief_elements(model, error_shares(state, finer))
    times = int(np.ceil((error / _ENOUGH) ** (1.0 / _rate(model.meshes[most]))))
    size = f"by about {100.0 * error:.2g} % of the largest one" if error < 1.0 else "by more than the largest one"
    return Finding(
        f"the mesh is too coarse: displacements are off {size}, mostly because of {places}. Elements there of "
        f"1/{times} of the length, or of a higher order, would be enough",
        CoarseMeshWarning,
    )


def warned_of_coarse_motion(solution: Solution, solve: Callable[[Model], Solution]) -> Solution:
    """Return a motion after a warning, which it then holds, if its displacements are off by 2 % or more.

    It is compared with that of the enriched model, as `solve` returns it; there is no estimate if that one fails.
    """
    model = solution.model
    try:
        with catch_warnings(action="ignore"), ends_as_a_whole():
            finer = solve(enriched(model))
    except (ConvergenceError, InputError, KeyboardInterrupt):
        return solution
    rows = range(min(len(solution), len(finer)) if np.array_equal(solution.at, finer.at) else 0)
    rows = rows[:: max(len(rows) // _ROWS, 1)]
    moved = max((largest_displacement(model, p) for p in solution.p), default=0.0)
    error = max((largest_displacement_error(solution[row], finer[row : row + 1]) for row in rows), default=0.0)
    if error <= WARNED * moved:
        return solution
    return _told(
        solution,
        kept_coarse(f"displacements are off by about {100.0 * error / moved:.2g} % of the largest one"),
    )


def kept_coarse(what: str, remedy: str = "find that state with more elements") -> Finding:
    """Return the warning that the mesh of a state to start from is too coarse; what: is off by how much."""
    return Finding(
        f"the mesh is too coarse: {what}. It is that of the state to start from, which cannot be found again on "
        f"another one; {remedy}",
        CoarseMeshWarning,
    )


def _told(solution: _Rows, found: Finding) -> _Rows:
    warn_of([found])
    return solution.with_statistics(warnings=(*solution.statistics.warnings, found.sentence))


def _rate(mesh: BeamMesh) -> int:
    """Return the order of convergence of displacements at the nodes."""
    field = mesh.beam.element.field
    return 2 * field.order if isinstance(field, Lagrange) else 2


def _chief_elements(model: Model, shares: list[np.ndarray]) -> tuple[str, int]:
    """Return in words which elements of the beam with the largest share have most of it, and the beam's number."""
    most = int(np.argmax([share.sum() for share in shares]))
    own = shares[most]
    order = np.argsort(own)[::-1]
    enough = 1 + int(np.searchsorted(np.cumsum(own[order]), _CHIEF * own.sum()))
    chief = np.sort(order[:enough])
    first, last = int(chief[0]), int(chief[-1])
    if len(own) == 1:
        which = "the one element"
    elif first == last:
        which = f"element {first}"
    elif last - first + 1 == len(own):
        which = "the elements"
    else:
        which = f"elements {first} to {last}"
    return f"{which} of {beam_in_words(model.beams, most)}", most
