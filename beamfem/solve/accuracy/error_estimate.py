"""Discretisation error of a static result, estimated by the equilibrium on an enriched space; shares of elements."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import predicted_stresses
from beamfem.assembly.system import System, system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.model.beam import Point
from beamfem.results.full_turns import first_turns
from beamfem.results.nodal import axis_at
from beamfem.results.postprocess import position
from beamfem.results.solution import Solution, State
from beamfem.results.status import Statistics
from beamfem.solve.accuracy.enriched_model import carried_coordinates, carried_stresses, enriched, places
from beamfem.solve.newton.newton import Newton, NewtonResult, PivotedProblem, PrescribedStep, find_equilibrium
from beamfem.validation import number_below, shown

Quantity = Callable[[Solution], Any] | Point | None


def error(solution: Solution, quantity: Quantity, row: int) -> Any:
    """Return the estimated change of a quantity with an infinitely fine mesh, see `Solution.error`."""
    if not solution.static:
        raise InputError("errors are estimated for static solutions only; this one is a motion")
    if not (quantity is None or isinstance(quantity, Point) or callable(quantity)):
        raise InputError(
            "quantity is a function of a solution, such as lambda s: s.rotation(beam.end)[-1], or a point, got "
            f"{shown(quantity)}"
        )
    number = number_below("row", row, len(solution), -len(solution)) % len(solution)
    finer = solution.computed(_Enriched).row(number)
    if quantity is None:
        return largest_displacement_error(solution[number], finer)
    evaluate = (lambda s: s.displacement(quantity)[-1]) if isinstance(quantity, Point) else quantity
    before, after = evaluate(solution[number : number + 1]), evaluate(finer)
    try:
        change = np.asarray(after, dtype=float) - np.asarray(before, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"quantity must return a number, or numbers of which there are as many on every mesh, got {shown(before)} "
            f"and {shown(after)}"
        ) from None
    return float(change) if change.ndim == 0 else change


class _Enriched:
    """Rows of a solution on the enriched space, each found once."""

    def __init__(self, solution: Solution) -> None:
        self._solution, self._rows = solution, dict[int, Solution]()

    def row(self, number: int) -> Solution:
        if number not in self._rows:
            self._rows[number] = enriched_row(self._solution, number)
        return self._rows[number]


def enriched_row(solution: Solution, number: int) -> Solution:
    """Return the equilibrium next to a row of a solution on the enriched space, as a solution of one row.

    What remembers is led through the rows before, with a load step each. Raises ConvergenceError if the tangent is
    singular or there is no equilibrium nearby.
    """
    model = enriched(solution.model)
    system = system_of(model, static=True)
    memory, iterations = system.history.numbers, 0
    state, p, past = solution[number], system.reference, system.history.start
    for row in range(number + 1) if len(memory) else (number,):
        state = solution[row]
        p = carried_coordinates(state, model)
        p[memory] = past
        result = _equilibrium(system, p, state)
        p = system.history.in_equilibrium(result.state, state.at, system.imposing(state.at))
        past, iterations = p[memory], iterations + result.iterations
    turned = None if state.turned is None else first_turns(model, p, state.turned)[None]
    none = np.zeros((1, model.size))
    statistics = Statistics(iterations, 1, 0, "an equilibrium on the enriched space")
    return Solution(model, True, np.array([state.at]), p[None], none, none.copy(), statistics, turned=turned)


def enriched_state(state: State) -> State:
    """Return the equilibrium next to a state on the enriched space; that of a state without stress is the reference.

    Raises ConvergenceError.
    """
    if np.array_equal(state.p, system_of(state.model, static=True).reference):
        model = enriched(state.model)
        p, rest = system_of(model, static=True).reference, np.zeros(model.size)
        return State(p, rest, rest.copy(), state.at, model)
    rows = np.array([state.at]), state.p[None], state.v[None], state.a[None]
    turned = None if state.turned is None else state.turned[None]
    return enriched_row(Solution(state.model, True, *rows, Statistics(0, 0, 0, "one state"), turned=turned), 0)[0]


def _equilibrium(system: System, p: np.ndarray, state: State) -> NewtonResult:
    """Return the equilibrium next to a state carried over to p (n,), with its stress resultants as independent ones.

    The first iteration is the linear estimate. Raises ConvergenceError.
    """
    step, newton = PrescribedStep(system, p, state.at), Newton()
    problem = PivotedProblem(system, p, state.at, newton, step, carried_stresses(state, system.model))
    try:
        result = find_equilibrium(problem, newton)
    except LinAlgError as reason:
        raise _without_estimate(str(reason)) from reason
    if not result.ended.good:
        raise _without_estimate(result.ended.value)
    return result


def _without_estimate(reason: str) -> ConvergenceError:
    return ConvergenceError(
        f"the error cannot be estimated: on finer elements there is no equilibrium near this one, {reason}",
        remedy="The mesh is too coarse, or the state is close to a limit point; solve on a finer mesh",
    )


def largest_displacement_error(state: State, finer: Solution, between_nodes: bool = False) -> float:
    """Return the largest change [m] of the position of a node of the state's model, or of a node of the finer one."""
    largest = 0.0
    for old, new in zip(state.model.meshes, finer.model.meshes, strict=True):
        if between_nodes:
            element, xi = (each.ravel() for each in places(old, new, new.beam.element.field.nodes))
            before = axis_at(old, state.p[None], element, xi).r[0]
            after = finer.p[0][new.kinematics.dof[new.node.ravel(), :2]]
        else:
            before = state.p[old.kinematics.dof[:, :2]]
            fractions = np.minimum(old.arc / old.vertices[-1], 1.0).tolist()
            after = np.array([position(new, finer.p, fraction)[0] for fraction in fractions])
        largest = max(largest, float(np.linalg.norm(after - before, axis=1).max()))
    return largest


def error_shares(state: State, finer: Solution) -> list[np.ndarray]:
    """Return the share (ne,) [-] of each element of each beam in the error of a state; their sum is 1, or 0.

    finer: the equilibrium on the enriched space. The error is measured by the complementary energy of the stress
    resultants in which the two differ, 1/2 int dS C^-1 dS ds, with the diagonal of the section stiffness C.
    """
    system = system_of(finer.model, static=True)
    now = predicted_stresses(system, finer.p[0], np.zeros(finer.model.size), state.at)
    energies = []
    for block, before, after in zip(system.blocks, carried_stresses(state, finer.model), now, strict=True):
        stiffness = np.einsum("cqii->cqi", block.stiffness)
        flexibility = np.divide(1.0, stiffness, out=np.zeros_like(stiffness), where=stiffness > 0.0)
        change = (after - before) ** 2 * flexibility[block.kind]
        energies.append((change.sum(axis=-1) * block.weight[block.kind]).sum(axis=-1))
    shares = []
    for old, new in zip(state.model.meshes, finer.model.meshes, strict=True):
        own = energies[new.block][new.first_element : new.first_element + new.elements]
        parent = places(old, new, np.array([0.5]))[0][:, 0]
        shares.append(np.bincount(parent, own, minlength=old.elements))
    total = sum(float(share.sum()) for share in shares)
    return [share / total if total > 0.0 else share for share in shares]
