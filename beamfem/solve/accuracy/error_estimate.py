"""Discretisation error of a static result, estimated by the equilibrium on an enriched space; shares of elements."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from itertools import chain
from typing import Any, cast

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.element.element import Element
from beamfem.element.fields import Lagrange
from beamfem.equations.connectors import same_connectors
from beamfem.equations.equations import predicted_stresses
from beamfem.equations.model_coordinates import set_coordinates
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.linalg.tangent import Stresses
from beamfem.mesh.beam_mesh import BeamMesh, join
from beamfem.mesh.model_meshes import required_nodes
from beamfem.mesh.reference import reference_axis, reference_position
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.precision.roundoff import FEW_DIGITS
from beamfem.quadrature import interpolation_weights
from beamfem.results import postprocess
from beamfem.results.axis_points import axis_at
from beamfem.results.full_turns import first_turns
from beamfem.results.solution import Solution, State
from beamfem.results.status import Statistics, Status
from beamfem.solve.accuracy.quantity_change import Quantity, evaluated, require_quantity
from beamfem.solve.newton.newton import (
    Newton,
    PivotedProblem,
    PrescribedStep,
    Termination,
    largest_change,
    solve_banded,
    solve_equilibrium,
)
from beamfem.validation import number_below, shown

# halved elements of order k have an error of about 2^-2k of the others, for the same cost as those of order k + 1
_RAISED = 2  # orders up to this one are raised
_CLOSE = 0.01  # of the size of the model, or rad: how far an iteration may go from a state whose strains are off
_INSIDE = 1e-6  # of the way to the middle of an element: where points are seen from


@dataclass(frozen=True, eq=False, repr=False)
class EnrichedModel(Model):
    """A model with other meshes than its original, which takes points and beams of either of them.

    Parameters
    ----------
    original : tuple of Beam
        The beam that each of `beams` stands for; supports, loads, joints and connectors are on these.
    """

    original: tuple[Beam, ...] = ()

    @cached_property
    def _numbers(self) -> dict[int, int]:
        numbered = chain(enumerate(self.beams), enumerate(self.original))
        return {id(beam): number for number, beam in numbered}


def enriched(model: Model) -> EnrichedModel:
    """Return a model whose elements are of order k + 1 instead of k = 1 or 2, and halves or thirds of other ones.

    A mesh found by refinement may have the finer one of the mesh before. Those of models that `Model.with_loads` has
    made share their meshes and tables as these do.
    """
    known: EnrichedModel | None = model.tables.get("enriched")
    if known is None:
        asked = zip(model.meshes, required_nodes(model), strict=True)
        known = model.tables["enriched"] = remeshed(model, [_enriched(*each) for each in asked])
    return known if known.loads == model.loads else cast(EnrichedModel, known.with_loads(model.loads))


def remeshed(model: Model, beams: Sequence[Beam]) -> EnrichedModel:
    """Return a model with other elements on the same curves.

    The parts at points and along beams are those of the model itself, so that results are found by them.
    """
    result = object.__new__(EnrichedModel)
    # valid, as the model is; beams on the same curves need nodes at the same places
    values = {field.name: getattr(model, field.name) for field in fields(Model)}
    original = getattr(model, "original", ()) or tuple(model.beams)
    vars(result).update(values, beams=tuple(beams), original=original)
    if not any(isinstance(beam.elements, int) for beam in model.beams):
        vars(result)["nodes_needed"] = model.nodes_needed
    return result


def with_elements(beam: Beam, ends: np.ndarray | tuple[float, ...], element: Element | None = None) -> Beam:
    """Return a beam with elements between some fractions [-] of its length, which are not checked."""
    result = copy(beam)
    vars(result).update(elements=tuple(np.asarray(ends).tolist()), element=element or beam.element)
    vars(result).pop("mesh", None)
    return result


def meshed(model: Model, like: State | Solution | str) -> Model:
    """Return a model with the elements of a result, or with elements to be chosen, see `Model.meshed`."""
    if isinstance(like, str) and like == "auto":
        return remeshed(model, [replace(beam, elements="auto") for beam in model.beams])
    if not isinstance(like, State | Solution):
        raise InputError(f'meshed takes a state or a solution of the model, or "auto", got {shown(like)}')
    own, others = model.beams, like.model.beams
    if len(own) != len(others) or any(a.curve is not b.curve for a, b in zip(own, others, strict=True)):
        raise InputError("meshed takes a result of this model, whose beams are on the same curves")
    return remeshed(
        model, [replace(a, elements=b.elements, element=b.element) for a, b in zip(own, others, strict=True)]
    )


def _enriched(mesh: BeamMesh, required: Iterable[tuple[float, Any]]) -> Beam:
    """Return the beam of a mesh on the enriched space; required: fractions at which other parts need nodes.

    One or two elements between such nodes may be symmetric, so that what an order adds is zero in their middle, or
    halves bend as little as they do.
    """
    ends = mesh.vertices / mesh.vertices[-1]
    between = np.diff(np.flatnonzero(np.isin(ends, [0.0, 1.0, *(fraction for fraction, _ in required)])))
    if _raised(mesh.beam):
        return finer_beam(mesh.beam, ends, raised=2 if (between == 1).any() else 1)
    few = np.repeat(between <= 2, between)
    parts = np.where(few & (len(mesh.beam.element.field.nodes) == 2), 3, 2)
    inside = [(number, part / of) for number, of in enumerate(parts) for part in range(1, of)]
    number, xi = np.array(inside).T
    return finer_beam(mesh.beam, ends, mesh.arc_length(number.astype(int), xi) / mesh.vertices[-1])


def _raised(beam: Beam) -> bool:
    field = beam.element.field
    return type(field) is Lagrange and field.order <= _RAISED


def finer_beam(beam: Beam, ends: np.ndarray, inside: np.ndarray | None = None, raised: int = 1) -> Beam:
    """Return a beam on the enriched space.

    ends (ne + 1,): fractions at which elements end, inside (m,): at which they are divided, by default in halves;
    raised: by how much orders are raised that are low.
    """
    if _raised(beam):
        return with_elements(beam, ends, of_order(beam.element, beam.element.field.degree + raised))
    between = 0.5 * (ends[1:] + ends[:-1]) if inside is None else inside
    return with_elements(beam, np.sort(np.concatenate([ends, between])))


def of_order(element: Element, order: int) -> Element:
    """Return an element with a Lagrange field of another order, and the name of a `CRBF` of this order if it is one."""
    named = element.label == f"CRBF-{element.field.degree}"
    return replace(element, field=Lagrange(order), label=f"CRBF-{order}" if named else None)


def carried_coordinates(state: State, target: Model) -> np.ndarray:
    """Return the coordinates (n,) of a state in a model whose elements lie within those of the state's model.

    Where both interpolate the reference differently, the offset between them turns with the section. History variables
    are those of the reference.
    """
    source, system = state.model, system_of(target, static=True)
    p = system.reference.copy()
    for old, new in _joined(source, target):
        set_coordinates(new, _values_at_nodes(old, new, state), p)
    for item, same in same_connectors(system.connectors, system_of(source, True).connectors, {}).items():
        p[item.own], p[item.amplitudes] = state.p[same.own], state.p[same.amplitudes]
    return p


def carried_stresses(state: State, target: Model, step: np.ndarray | None = None, *, static: bool = True) -> Stresses:
    """Return the stress resultants (ne, nq, ns) of each block of a model: polynomials through those of a state.

    step (n,): a linearised change of the state that they are taken after; static: whether the state is one of statics.

    The carried coordinates alone strain the finer elements between the points where the old ones had no strain, which
    would spoil the first tangent.
    """
    source = state.model
    acting = _stresses_after(state, step, static)
    blocks = system_of(target, static).blocks
    result = tuple(np.zeros((len(block.kind), *block.stiffness.shape[1:3])) for block in blocks)
    for old, new in zip(source.meshes, target.meshes, strict=True):
        known, own = (each[mesh.block][_elements(mesh)] for each, mesh in ((acting, old), (result, new)))
        counted, wanted = (_counted(mesh) for mesh in (old, new))
        at, to = (mesh.beam.element.energy_points()[0] for mesh in (old, new))
        for measure in range(own.shape[2]):
            some, others = counted[:, measure], wanted[:, measure]
            if some.any() and others.any():
                own[:, others, measure] = _interpolated(old, new, at[some], to[others], known[:, some, measure, None])[
                    ..., 0
                ]
    return result


def _elements(mesh: BeamMesh) -> slice:
    """Return the elements of a beam in its block."""
    return slice(mesh.first_element, mesh.first_element + mesh.elements)


def _counted(mesh: BeamMesh) -> np.ndarray:
    """Return whether each strain measure (nq, ns) enters the energy at the points of an element."""
    return np.einsum("qii->qi", mesh.beam.element.coupled_fractions) != 0.0


def _interpolated(old: BeamMesh, new: BeamMesh, at: np.ndarray, wanted: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return polynomials (new elements, m, k) at xi `wanted` (m,), through values (elements, l, k) at xi `at` (l,)."""
    element, xi = places(old, new, wanted)
    return np.asarray(np.einsum("epi,epik->epk", interpolation_weights(at, xi), values[element]))


def places(old: BeamMesh, new: BeamMesh, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return element and xi (new elements, m) in the old mesh of points xi (m,) of every new element.

    At ends of old elements, it is the one towards the middle of the new element.
    """
    every = np.arange(new.elements)
    along = new.arc_length(np.repeat(every, len(xi)), np.tile(xi, new.elements)).reshape(new.elements, -1)
    middle = 0.5 * np.add(*new.ends(every))
    inside = along + _INSIDE * (middle[:, None] - along)
    element, first, row = np.empty(along.shape, dtype=np.int64), 0, 0
    for part, finer in zip(old.parts, new.parts, strict=True):
        rows = slice(row, row + finer.elements)
        element[rows] = first + np.searchsorted(part.vertices[1:-1], inside[rows], side="right")
        first, row = first + part.elements, row + finer.elements
    start, end = old.ends(element)
    if old.beam.elements == "knots":
        curve: Any = old.beam.curve
        along = curve.parameter(along.ravel()).reshape(along.shape)
        start, end = old.parameter[element], old.parameter[element + 1]
    return element, np.clip((along - start) / (end - start), 0.0, 1.0)


def _joined(source: Model, target: Model) -> Iterator[tuple[BeamMesh, BeamMesh]]:
    """Yield the meshes of like beams of a model, and of the same beams with other elements, as one each."""
    like = {number: group for group, numbers in enumerate(source.numbered.joinable) for number in numbers}
    beams: defaultdict[tuple[int, int], list[int]] = defaultdict(list)
    for group, numbers in enumerate(target.numbered.joinable):
        for number in numbers:
            beams[like[number], group].append(number)
    for numbers in beams.values():
        yield join([source.meshes[number] for number in numbers]), join([target.meshes[number] for number in numbers])


def _values_at_nodes(old: BeamMesh, new: BeamMesh, state: State) -> dict[str, np.ndarray]:
    """Return every coordinate (nodes,) that a node of the new mesh could have in a state of the old one, by name."""
    element, xi = (each.ravel() for each in places(old, new, new.beam.element.field.nodes))
    now, rest = axis_at(old, state.p[None], element, xi), reference_axis(old, element, xi)
    node = new.node.ravel()
    turned = _complex(now.d[0]) / _complex(rest.d)
    offset = _complex(new.position[node] - reference_position(old, element, xi))
    tangent = _complex(new.tangent[node])
    r_x = _complex(now.r_s[0]) / _complex(rest.r_s) * tangent * new.speed[node]
    vectors = {"r": _complex(now.r[0]) + turned * offset, "r_x": r_x, "r_y": 1j * tangent * turned}
    # theta is the rotation of the director, whatever the section turns with
    angle = np.angle(turned)
    indices = [number for part, number in state.model.numbered.numbers_uncounted.items() if part in old.parts]
    counted = None if not indices or state.turned is None else state.turned[None, indices]
    near = postprocess.section_rotation(old, state.p[None], now, element, xi, counted)[0]
    values = {"theta": angle + 2.0 * np.pi * np.round((near - angle) / (2.0 * np.pi))}
    values["s"] = np.real(r_x * np.conj(tangent * turned / np.abs(turned)))
    for name, vector in vectors.items():
        values[f"{name}^x"], values[f"{name}^y"] = vector.real, vector.imag
    result = {name: np.empty(new.nodes) for name in values}
    for name, found in values.items():
        result[name][node] = found
    return result


def _complex(vectors: np.ndarray) -> np.ndarray:
    """Return vectors (n, 2) as complex numbers."""
    return np.asarray(vectors[..., 0] + 1j * vectors[..., 1])


def error(solution: Solution, quantity: Quantity, row: int) -> Any:
    """Return the estimated change of a quantity with an infinitely fine mesh, see `Solution.error`."""
    require_quantity(quantity)
    number, finer = enriched_row_kept(solution, row)
    if quantity is None:
        return largest_position_error(solution[number], finer)
    before, after = evaluated(quantity, solution[number : number + 1], finer)
    change = (after - before)[-1] if isinstance(quantity, Point) else after - before
    return float(change) if change.ndim == 0 else change


def beam_shares(solution: Solution, beam: Beam, row: int) -> np.ndarray:
    """Return the share of each element of a beam in the error of a row, see `Solution.error_shares`."""
    of_beam = solution.model.number_of(beam)
    number, finer = enriched_row_kept(solution, row)
    known = solution.computed(_Enriched).shares
    if number not in known:
        known[number] = error_shares(solution[number], finer)
    return known[number][of_beam]


def enriched_row_kept(solution: Solution, row: int) -> tuple[int, Solution]:
    """Return the number of a row from 0, and its equilibrium on the enriched space."""
    if not solution.static:
        raise InputError("errors are estimated for static solutions only; this one is a motion")
    number = number_below("row", row, len(solution), -len(solution)) % len(solution)
    known = solution.computed(_Enriched).rows
    if number not in known:
        known[number] = enriched_row(solution, number)
    return number, known[number]


class _Enriched:
    """Rows of a solution on the enriched space by their numbers, and shares in their errors, each found once."""

    def __init__(self, solution: Solution) -> None:
        self.rows, self.shares = dict[int, Solution](), dict[int, list[np.ndarray]]()


def keep_enriched_row(solution: Solution, finer: Solution) -> None:
    """Keep the last row of a solution on the enriched space, which has been found before."""
    solution.computed(_Enriched).rows[len(solution) - 1] = finer


def enriched_row(solution: Solution, number: int, model: Model | None = None) -> Solution:
    """Return the equilibrium next to a row of a solution on the enriched space, as a solution of one row.

    What remembers is led through the rows before, with a load step each. model: one with any other elements, instead of
    the enriched one. Raises ConvergenceError if the tangent is singular or there is no equilibrium nearby.
    """
    model = model or enriched(solution.model)
    system = system_of(model, static=True)
    memory, past = system.history.numbers, system.history.start
    state, p = solution[number], system.reference
    for row in range(number + 1) if len(memory) else (number,):
        state = solution[row]
        p = carried_coordinates(state, model)
        p[memory] = past
        p = system.history.in_equilibrium(_equilibrium(system, p, state), state.at)
        past = p[memory]
    turned = None if state.turned is None else first_turns(model, p, state.turned)
    none = np.zeros(model.size)
    return State(p, none, none.copy(), state.at, model, turned=turned).as_row(static=True)


NEAR = 0.05  # of the size of the model, or rad: how far a state may move to become one of another mesh


def carried_path(path: Solution, finer: Solution | None, model: Model) -> Solution | None:
    """Return the rows of a static solution as equilibria of a model with other elements, next to those that it has.

    finer: its last row on the enriched space, if it is known. None if they may be those of another path: if some are
    unstable or beyond a jump, far from the ones before, or the count of negative pivots is not zero; the rows of models
    with history depend on the way to them.
    """
    system, known = system_of(model, static=True), system_of(path.model, static=True)
    plain = path.statistics.ended in (Termination.CONVERGED.value, Termination.ROUND_OFF.value)
    if not plain or len(system.history.numbers) or not (np.diff(path.at) > 0.0).all():
        return None
    rows, iterations, ended, digits = list[np.ndarray](), 0, Termination.CONVERGED, path.statistics.digits
    for number in range(len(path)):
        state = finer[0] if finer is not None and number == len(path) - 1 else path[number]
        if np.array_equal(state.p, known.reference):
            rows.append(system.reference)
            continue
        p = state.p if state.model is model else carried_coordinates(state, model)
        result = solve_equilibrium(system, p, state.at, Newton(), keep=0)
        ended, digits = result.ended, result.digits
        if not ended.good or digits < FEW_DIGITS or largest_change(system, result.state - p) > NEAR:
            return None
        iterations += result.iterations
        rows.append(result.state)
    turned = path.turned
    if turned is not None:
        turned = np.array([first_turns(model, *each) for each in zip(rows, turned, strict=True)])
    none = np.zeros((len(rows), model.size))
    status = Status.COMPLETED if ended is Termination.CONVERGED else Status.ROUND_OFF
    statistics = Statistics(iterations, len(rows) - 1, 0, ended.value, status, digits=digits)
    return Solution(model, True, path.at, np.array(rows), none, none, statistics, path.stability, turned)


def enriched_state(state: State) -> State:
    """Return the equilibrium next to a state on the enriched space; that of a state without stress is the reference.

    Raises ConvergenceError.
    """
    if np.array_equal(state.p, system_of(state.model, static=True).reference):
        model = enriched(state.model)
        p, rest = system_of(model, static=True).reference, np.zeros(model.size)
        return State(p, rest, rest.copy(), state.at, model)
    return enriched_row(state.as_row(static=True), 0)[0]


def _equilibrium(system: System, p: np.ndarray, state: State) -> np.ndarray:
    """Return the equilibrium (n,) next to a state carried over to p (n,). Raises ConvergenceError.

    If it is not near, as p strains finer elements where the old ones had no strain, stress resultants are carried over
    as well; the first iteration is then the linear estimate.
    """
    step, newton = PrescribedStep(system, p, state.at), Newton()
    result = solve_banded(system, p, state.at, newton, step)
    if result is not None and result.ended.good and largest_change(system, result.state - p) <= _CLOSE:
        return result.state
    problem = PivotedProblem(system, p, state.at, newton, step, stresses=carried_stresses(state, system.model))
    try:
        result = problem.find()
    except LinAlgError as reason:
        raise _without_estimate(str(reason)) from reason
    if not result.ended.good:
        raise _without_estimate(result.ended.value)
    return result.state


def _without_estimate(reason: str) -> ConvergenceError:
    return ConvergenceError(
        f"the error cannot be estimated: on finer elements there is no equilibrium near this one, {reason}",
        remedy="The mesh is too coarse, or the state is close to a limit point; solve on a finer mesh",
    )


def largest_displacement(model: Model, p: np.ndarray) -> float:
    """Return the largest displacement [m] of a node in a state p (n,)."""
    return max(
        float(np.linalg.norm(p[mesh.kinematics.dof[:, :2]] - mesh.position, axis=1).max()) for mesh in model.meshes
    )


def largest_position_error(coarse: State | Solution, finer: Solution) -> float:
    """Return the largest change [m] of a position along beams, of a state or any row, at the nodes of the finer one."""
    pairs = _joined(coarse.model, finer.model)
    return max(float(np.abs(_position_changes(*pair, coarse, finer)[2]).max()) for pair in pairs)


def _position_changes(
    old: BeamMesh, new: BeamMesh, coarse: State | Solution, finer: Solution
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return old element (ne,), xi (ne, m) and changes (rows, ne, m) [m], as complex numbers, of the nodes of a mesh.

    Elements have their own ends, so that nodes between two of them are there twice.
    """
    element, xi = places(old, new, new.beam.element.field.nodes)
    before = axis_at(old, np.atleast_2d(coarse.p), element.ravel(), xi.ravel()).r
    change = _complex(finer.p[:, new.kinematics.dof[new.node.ravel(), :2]] - before)
    return element[:, 0], xi, change.reshape(-1, *xi.shape)


def largest_displacement_error(state: State, finer: Solution) -> float:
    """Return the largest change [m] of the displacement of a node, without what curved axes are off between nodes."""
    largest = 0.0
    for old, new in zip(state.model.meshes, finer.model.meshes, strict=True):
        element, xi = (each.ravel() for each in places(new, old, old.beam.element.field.nodes))
        node = old.node.ravel()
        before = state.p[old.kinematics.dof[node, :2]] - old.position[node]
        after = axis_at(new, finer.p, element, xi).r[0] - reference_position(new, element, xi)
        largest = max(largest, float(np.linalg.norm(after - before, axis=1).max()))
    return largest


def error_shares(state: State, finer: Solution) -> list[np.ndarray]:
    """Return the share (ne,) [-] of each element of each beam in the error of a state; their sum is 1, or 0.

    finer: the equilibrium on the enriched space, or the row of a motion. The error is measured by the complementary
    energy of the stress resultants in which the two differ, 1/2 int dS C^-1 dS ds, with the diagonal of the section
    stiffness C.
    """
    static = finer.static
    now = _stresses_after(finer[0], static=static)
    carried = carried_stresses(state, finer.model, static=static)
    changes = tuple(after - before for after, before in zip(now, carried, strict=True))
    return _shares(state.model, finer.model, _energies(finer.model, changes))


def position_shares(state: State, finer: Solution) -> list[np.ndarray]:
    """Return the share (ne,) [-] of each element of each beam in the largest error of positions along beams.

    Elements are off between their ends by their own interpolation, such as that of a curved axis, and at their ends by
    the errors of all elements, in which they have `error_shares`. Their sum may exceed 1, as each is the larger of two.
    """
    within, at_ends = [], 0.0
    for old, new in zip(state.model.meshes, finer.model.meshes, strict=True):
        parent, xi, (change,) = _position_changes(old, new, state, finer)
        every = np.arange(old.elements)
        start = change[np.searchsorted(parent, every), 0]
        end = change[np.searchsorted(parent, every, side="right") - 1, -1]
        bent = np.abs(change - start[parent, None] * (1.0 - xi) - end[parent, None] * xi).max(axis=1)
        within.append(np.zeros(old.elements))
        np.maximum.at(within[-1], parent, bent)
        at_ends = max(at_ends, float(np.abs(start).max()), float(np.abs(end).max()))
    largest = max(at_ends, *(float(each.max()) for each in within))
    if largest == 0.0:
        return within
    elements = sum(map(len, within))
    pairs = zip(error_shares(state, finer), within, strict=True)
    return [np.maximum(at_ends / largest * share, own / (largest * elements)) for share, own in pairs]


def shares_of_rows(
    rows: Iterable[tuple[State, Solution]], errors: np.ndarray, shares_of: Callable[[State, Solution], list[np.ndarray]]
) -> list[np.ndarray]:
    """Return the largest share (ne,) [-] of each element of each beam in the errors (m,) of some rows.

    rows: of each its state and its row on the enriched space; shares_of: `error_shares` or `position_shares`. The
    shares of a row count as much as its error does beside the largest one, so that elements are short enough for all.
    """
    largest = float(errors.max()) or 1.0
    weighed = [
        [weight * share for share in shares_of(*row)] for row, weight in zip(rows, errors / largest, strict=True)
    ]
    return [np.max(beam, axis=0) for beam in zip(*weighed, strict=True)]


_LOWEST = 3  # order of the axis whose coefficients tell its error
_ROUND_OFF = 100.0 * np.finfo(float).eps  # coefficients [-] that are no more than this


def errors_of_orders(solution: Solution) -> list[np.ndarray] | None:
    """Return the errors (rows, ne, k) [-] of the axis in each element of order k, if it were of order 1, 2, ..., k.

    They are relative to the size of the model, and those of the interpolation: the sizes of all Legendre coefficients
    a_n that an order lacks. Those of analytic functions fall as rho^-n, beside the largest of degree 2 or more; the
    first that is not known follows from the last two, as symmetric functions have none of odd degree. Errors are at
    least those of the angle between the ends of an element, by which a short one turns the model: it is stationary in
    the energy, so that it is off by the square of the relative error of the slopes. None for elements whose nodes do
    not tell it.
    """
    extent, result = system_of(solution.model, static=True).extent, []
    for mesh in solution.model.meshes:
        field = mesh.beam.element.field
        if type(field) is not Lagrange or field.order < _LOWEST:
            return None
        order = field.order
        coefficients = _to_coefficients(order) @ solution.p[:, mesh.kinematics.dof[mesh.node][..., :2]]
        sizes = np.linalg.norm(coefficients, axis=-1)[..., 2:] / extent
        bent = np.maximum(sizes.max(axis=-1, keepdims=True), np.finfo(float).tiny)
        beyond = bent * (sizes[..., -2:] / bent) ** ((order + 1) / np.array([order - 1, order]))
        first = beyond.max(axis=-1, keepdims=True)
        errors = np.cumsum(np.concatenate([sizes, first], axis=-1)[..., ::-1], axis=-1)[..., ::-1]
        # twice the degree over the length is the slope of a polynomial of Legendre beside its size
        turn = np.maximum((np.arange(2, order + 1) * sizes).max(axis=-1, keepdims=True), np.finfo(float).tiny)
        slope = np.where(first > _ROUND_OFF, (order + 1) * first, 0.0)
        result.append(np.maximum(errors, 2.0 * extent / mesh.lengths[:, None] * slope**2 / turn))
    return result


@lru_cache
def _to_coefficients(order: int) -> np.ndarray:
    """Return the Legendre coefficients (order + 1, order + 1) of the polynomials of an order through its nodes."""
    return np.linalg.inv(legvander(2.0 * Lagrange(order).nodes - 1.0, order))


def mode_shares(
    modes: Iterable[tuple[State, np.ndarray, State, np.ndarray]], errors: np.ndarray, stiffness: np.ndarray
) -> list[np.ndarray]:
    """Return the share (ne,) [-] of each element of each beam in the relative errors of eigenvalues; their sum is 1.

    modes: state and shape (n,) of each, and both on the enriched space; errors (m,): relative ones of the eigenvalues;
    stiffness (m,): of the shapes on the enriched space. The elastic stiffness of a shape is the energy of its stress
    resultants, and the rest is geometric. This is linear in the stress resultants of the state, so that it is off by
    what these are; whatever this does not explain of the error is due to the shape.
    """
    total = list[np.ndarray]()
    for (state, shape, finer, finer_shape), error, all_stiffness in zip(modes, errors, stiffness, strict=True):
        still, finer_still = carried_stresses(state, finer.model), _stresses_after(finer)
        moved, finer_moved = carried_stresses(state, finer.model, shape), _stresses_after(finer, finer_shape)
        before, after = (
            tuple(a - b for a, b in zip(*pair, strict=True)) for pair in ((moved, still), (finer_moved, finer_still))
        )
        off, elastic, by_shape = _difference(state.model, finer.model, before, after)
        if not elastic > 0.0:
            continue
        of_state, by_state = 0.0, by_shape
        if not np.array_equal(state.p, system_of(state.model, static=True).reference):
            state_off, _, by_state = _difference(state.model, finer.model, still, finer_still)
            geometric = abs(all_stiffness / elastic - 1.0)
            of_state = min(max(error - off, 0.0), geometric * state_off**0.5)
        parts = [(error - of_state) * a + of_state * b for a, b in zip(by_shape, by_state, strict=True)]
        total = parts if not total else [a + b for a, b in zip(total, parts, strict=True)]
    whole = sum(float(each.sum()) for each in total)
    return [each / whole if whole > 0.0 else each for each in total]


def _difference(model: Model, finer: Model, before: Stresses, after: Stresses) -> tuple[float, float, list[np.ndarray]]:
    """Return the energy of the difference of stress resultants over that of those after, the latter, and shares in it.

    Those before are scaled so that it is least, as shapes have no scale, and states belong to other load factors.
    """
    joint, own, size = (
        sum(float(each.sum()) for each in _energies(finer, *pair))
        for pair in ((before, after), (before, before), (after, after))
    )
    scale = joint / own if own > 0.0 else 0.0
    off = _energies(finer, tuple(scale * a - b for a, b in zip(before, after, strict=True)))
    return (sum(float(each.sum()) for each in off) / size if size > 0.0 else 0.0), size, _shares(model, finer, off)


def _stresses_after(state: State, step: np.ndarray | None = None, static: bool = True) -> Stresses:
    return predicted_stresses(
        system_of(state.model, static), state.p, np.zeros(len(state.p)) if step is None else step, state.at
    )


def _energies(model: Model, stresses: Stresses, others: Stresses | None = None) -> list[np.ndarray]:
    """Return the complementary work (ne,) of stress resultants on the strains of others, their own by default."""
    result = []
    blocks = system_of(model, static=True).blocks
    for block, values, other in zip(blocks, stresses, others or stresses, strict=True):
        stiffness = np.einsum("cqii->cqi", block.stiffness)
        flexibility = np.divide(1.0, stiffness, out=np.zeros_like(stiffness), where=stiffness > 0.0)
        result.append(((values * other * flexibility[block.kind]).sum(axis=-1) * block.weight[block.kind]).sum(axis=-1))
    return result


def _shares(model: Model, finer: Model, energies: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return the shares of the elements of each beam in energies of the elements of the blocks of a finer model."""
    shares = []
    for old, new in zip(model.meshes, finer.meshes, strict=True):
        parent = places(old, new, np.array([0.5]))[0][:, 0]
        shares.append(np.bincount(parent, energies[new.block][_elements(new)], minlength=old.elements))
    total = sum(float(share.sum()) for share in shares)
    return [share / total if total > 0.0 else share for share in shares]
