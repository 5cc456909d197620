"""Linearisation of a model about an equilibrium or a state of a motion."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.equations import equations
from beamfem.equations.equations import INERTIA, STATICS
from beamfem.equations.redundant_conditions import in_words
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError
from beamfem.linalg.lapack import qr
from beamfem.linalg.tangent import UNROTATED
from beamfem.model.beam import beam_in_words
from beamfem.model.imposed_strains import ImposedStrain
from beamfem.model.load_base import Load, factor
from beamfem.model.model import Model
from beamfem.results.solution import Solution, State
from beamfem.solve.linear.linear_model import LinearModel, scale_of
from beamfem.solve.modes.modes import meshed_for_modes
from beamfem.solve.start.mechanisms import dependent
from beamfem.solve.start.start_checks import refuse_frame, require_equilibrium
from beamfem.solve.start.start_state import last_state, require_finite, resting_state
from beamfem.validation import items

_DAMPING = (0.0, 1.0, 0.0)
_ROUND_OFF = 16.0 * float(np.finfo(float).eps)


def linearise(model: Model, about: State | Solution | None = None, loads: Sequence[Load] | None = None) -> LinearModel:
    """Linearise the equations of motion about a state, M z'' + C z' + K z = B f.

    M, C and K are the derivatives of the residual by p'', p' and p, the exact tangents of the state with its loads:
    geometric stiffness, dampers, and for a moving state gyroscopic terms. Prescribed coordinates are eliminated, as are
    those that constraints with multipliers and inclined rollers determine, p = T z; K includes the curvature of the
    constraints times their multipliers. About a moving state, T changes with time: C includes 2 T^T M T' and K includes
    T^T (C T' + M T''), so that C, K and modes are those of the `coordinates` that are independent. Beams with default
    elements are refined until the 10 lowest frequencies about a state at rest are accurate to 1e-4. Raises InputError
    for an invalid argument, a state that is not in equilibrium, redundant conditions, and a load at a point that is no
    node.

    Parameters
    ----------
    model : Model
        Beams, supports, loads, joints and connectors.
    about : State or Solution, optional
        A static equilibrium, or a state of a motion, or a solution for its last state; by default the reference at
        load factor 0. About a moving state, matrices hold at its time.
    loads : sequence, optional
        The inputs f: factors of loads of the model, or of further loads that do not act in the state; by default all
        loads of the model.

    Returns
    -------
    LinearModel
        The matrices.

    Examples
    --------
    >>> linear = bf.linearise(model, about=solution, loads=[bf.PointForce(beam.end, (1.0, 0.0))])
    >>> linear.input_matrix.shape
    (36, 1)
    """
    if system_of(model, static=True).model.automatic:
        model, about = meshed_for_modes(model, about)
    return linearised(model, about, loads, np.empty(0, dtype=np.int64))


def linearised(
    model: Model, about: State | Solution | None, loads: Sequence[Load] | None, kept: np.ndarray
) -> LinearModel:
    """Return a linear model as `linearise`, among whose coordinates are those of the model with the numbers `kept`.

    Raises InputError if conditions determine them.
    """
    system, state = _state(model, about)
    inputs = tuple(model.loads if loads is None else items("loads", loads))
    loaded = _with_inputs(system, inputs)
    stiffness = _matrix(system, state, STATICS)
    independent, basis = independent_motions(system, state.p, stiffness, kept)
    free = system.free_dofs
    order = np.argsort(free[independent])
    independent, basis = independent[order], basis[:, order]
    place = csr_array(coo_array((np.ones(len(free)), (free, np.arange(len(free)))), shape=(model.size, len(free))))
    transformation = csr_array(place @ basis)
    names = _names(system)
    inertia, resistance = (_matrix(system, state, weights) for weights in (INERTIA, _DAMPING))
    by_rates, by_positions = resistance @ basis, stiffness @ basis
    if len(system.connectors.multipliers) and np.any(state.v):
        rate, second = _rates_of_basis(system, state, independent)
        by_rates, by_positions = by_rates + 2.0 * inertia @ rate, by_positions + resistance @ rate + inertia @ second
    mass, damping, stiffness = (csr_array(basis.T @ each) for each in (inertia @ basis, by_rates, by_positions))
    scale = scale_of(model, transformation)
    return LinearModel(
        model,
        state,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        input_matrix=transformation.T @ input_forces(loaded, state.p, inputs, state.at),
        loads=inputs,
        transformation=transformation,
        coordinates=free[independent],
        names=tuple(names[dof] for dof in free[independent].tolist()),
        round_off=(_round_off(stiffness, mass, scale), _round_off(damping, mass, scale)),
        static=system.static,
    )


def _state(model: Model, about: State | Solution | None) -> tuple[System, State]:
    """Return the state and the system, of dynamics for a state of a motion. Raises InputError for no equilibrium."""
    given = last_state(about, "about")
    moving = isinstance(about, Solution) and not about.static
    if given is not None and (moving or np.any(given.v) or np.any(given.a)):
        system = system_of(model, static=False)
        refuse_frame(system, "linearise about a moving state")
        require_finite("about", given)
        if given.model is not model:
            raise InputError("about must be a state of the same model if it moves")
        if system.connectors.conditions_follow_time:
            raise InputError("conditions that depend on time are linearised about a state at rest only, this one moves")
        return system, given
    system = system_of(model, static=True)
    system.forget_digits()
    p, load_factor = resting_state(system, about)
    require_equilibrium(system, p, load_factor, "linearise")
    zeros = np.zeros_like(p)
    return system, State(p, zeros, zeros, load_factor, model)


def _with_inputs(system: System, inputs: Sequence[Load]) -> System:
    """Return the system of the model with those of the inputs that are not its loads. Raises InputError."""
    model = system.model
    further = [load for load in inputs if not any(load is own for own in model.loads)]
    if not further:
        return system
    loaded = model.with_loads([*model.loads, *further])
    if loaded.size != model.size:
        raise InputError(
            "a load that is an input acts at a point that is no node of the model",
            remedy="Add a PointForce of (0, 0) there to the model",
        )
    return system_of(loaded, system.static)


def _matrix(system: System, state: State, weights: tuple[float, float, float]) -> csr_array:
    """Return the derivative (unknown, unknown) of the residual for weights of p, p' and p''."""
    at = state.p, state.v, state.a, state.at
    return equations.linearise(system, *at, weights, moving=not system.static)[1].sparse(UNROTATED)


def _round_off(matrix: csr_array, mass: csr_array, scale: np.ndarray) -> float:
    """Return the round-off of x^T A x / x^T M x for rigid motions x of the size of `scale` (m,)."""
    return _ROUND_OFF * float(scale @ (abs(matrix) @ scale)) / float(scale @ (mass @ scale))


def _names(system: System) -> dict[int, str]:
    """Return the names of the coordinates by number; shared ones have the name at the first of their beams."""
    names: dict[int, str] = {}
    for number, mesh in enumerate(system.model.meshes):
        beam = beam_in_words(system.model.beams, number)
        for node in range(mesh.nodes):
            for label, dof in mesh.coordinates_of(node).items():
                names.setdefault(dof, f"{beam}, node {node}, {label}")
    for item in system.connectors.items:
        names |= {dof: f"{item.name}, mode {number}" for number, dof in enumerate(item.amplitudes.tolist())}
    return names


_DEPENDENT = 1e-10  # of a condition of unit size: its part that is independent of all others
_NOTHING = 1e-14  # of the largest entry of a basis


def independent_motions(
    system: System, p: np.ndarray, tangent: csr_array, kept: np.ndarray
) -> tuple[np.ndarray, csr_array]:
    """Return the independent coordinates (m,) of the unknowns in a state p (n,), and a basis T (unknown, m).

    They are x = T x[independent]; kept: numbers of coordinates that are to be independent.

    The conditions G x = 0 are those of multipliers, the last rows of the tangent [K, G^T; G, 0], and of inclined
    rollers. They are solved for as many coordinates, which pivoting selects. Multipliers have zero rows. Raises
    InputError if conditions are redundant or determine a coordinate that is kept.
    """
    unknown, conditions = len(system.free_dofs), _conditions(system, tangent)
    size = conditions.shape[1]
    constrained = np.flatnonzero(conditions.any(axis=0))
    dofs = system.free_dofs[constrained]
    scale = system.scale[dofs]
    solved, free, solution = _solved_for(conditions[:, constrained] * scale, dofs, np.isin(dofs, kept), system, p)
    solution *= scale[solved][:, None] / scale[free]
    dependents, drivers = constrained[solved], constrained[free]
    independent = np.setdiff1d(np.arange(size), dependents)
    number = np.zeros(size, dtype=np.int64)
    number[independent] = np.arange(len(independent))
    row, column = np.nonzero(solution)
    entries = np.concatenate([np.ones(len(independent)), solution[row, column]])
    places = np.append(independent, dependents[row]), np.append(number[independent], number[drivers[column]])
    return independent, csr_array(coo_array((entries, places), shape=(unknown, len(independent))))


def _conditions(system: System, tangent: csr_array) -> np.ndarray:
    """Return the gradients (k, m) of conditions and inclined rollers by the unknowns that are no multipliers."""
    size = len(system.free_dofs) - len(system.connectors.multipliers)
    first, normals = system.rotated
    active = size + np.flatnonzero(tangent.diagonal()[size:] == 0.0)  # of conditions that come and go, too
    rows = tangent[active, :size].toarray() if len(active) else np.empty((0, size))
    rollers = np.zeros((len(first), size))
    rollers[np.arange(len(first)), first] = normals[:, 0]
    rollers[np.arange(len(first)), first + 1] = normals[:, 1]
    return np.vstack([rows, rollers])


_NEAR = 2.0**-7  # of the model, or rad: step of differences along a motion
_FIRST, _SECOND = (3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0), (3.0 / 2.0, -3.0 / 20.0, 1.0 / 90.0)  # of sixth order


def _rates_of_basis(system: System, state: State, independent: np.ndarray) -> tuple[csr_array, csr_array]:
    """Return T' and T'' (unknown, m) along a motion, with the same independent coordinates."""
    size = len(system.free_dofs) - len(system.connectors.multipliers)
    dependents = np.setdiff1d(np.arange(size), independent)
    speed, push = (float(np.max(np.abs(values) / system.held.scale)) for values in (state.v, state.a))
    width = min(_NEAR / speed, np.sqrt(_NEAR / push) if push else np.inf)

    def solution(time: float) -> np.ndarray:
        p = state.p + time * state.v + 0.5 * time**2 * state.a
        own = _conditions(system, _matrix(system, replace(state, p=p), STATICS))
        return -np.linalg.solve(own[:, dependents], own[:, independent])

    rate, second = np.zeros((len(dependents), len(independent))), -49.0 / 18.0 * solution(0.0)
    for number, (first, other) in enumerate(zip(_FIRST, _SECOND, strict=True), 1):
        before, after = solution(-number * width), solution(number * width)
        rate, second = rate + first * (after - before), second + other * (after + before)
    found = []
    for values in (rate / width, second / width**2):
        whole = np.zeros((len(system.free_dofs), len(independent)))
        whole[dependents] = values
        found.append(csr_array(whole))
    return found[0], found[1]


def _solved_for(
    conditions: np.ndarray, dofs: np.ndarray, kept: np.ndarray, system: System, p: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the columns that conditions (k, n) are solved for, the others, and the solution (k, n - k) X with x = X y.

    dofs (n,): numbers of their coordinates; kept (n,): columns that are among the others. Raises InputError if
    conditions are redundant or determine them.
    """
    count = len(conditions)
    sizes = np.linalg.norm(conditions, axis=1, keepdims=True)
    conditions = conditions / np.where(sizes > 0.0, sizes, 1.0)
    enough, order = _independent(conditions)
    if not enough:
        raise InputError(dependent(system, p))
    if kept.any():
        enough, order = _independent(np.where(kept, 0.0, conditions))
        if not enough:
            raise InputError(_determined(system, dofs[kept]))
    solution = -np.linalg.solve(conditions[:, order[:count]], conditions[:, order[count:]])
    solution[np.abs(solution) <= _NOTHING * np.abs(solution).max(initial=0.0)] = 0.0
    return order[:count], order[count:], solution


def _independent(conditions: np.ndarray) -> tuple[bool, np.ndarray]:
    """Return whether conditions (k, n) of unit size are independent, and the columns, first k to solve them for."""
    triangle, order = qr(conditions, mode="r", pivoting=True)
    diagonal = np.abs(np.diagonal(triangle))
    return len(diagonal) == len(conditions) and bool(np.all(diagonal > _DEPENDENT)), order


def _determined(system: System, dofs: np.ndarray) -> str:
    """Return the message that conditions determine some of the coordinates with these numbers."""
    parts = [item for item in system.connectors.items if len(item.own) and np.isin(item.dofs, dofs).any()]
    names = [in_words(parts)] if parts else []
    names += ["an inclined roller"] if np.isin(dofs, system.free_dofs[system.rotated[0]]).any() else []
    return (
        f"the coordinates of the interfaces are not independent: conditions of {' and of '.join(names)} determine some "
        "by others; leave out one of the interfaces"
    )


_LARGE = 2.0**30  # factor of a load beside which internal forces are round-off
_WIDTH = 2.0**-14  # of the factor of an imposed strain, to which laws of sections may respond nonlinearly


def input_forces(system: System, p: np.ndarray, loads: Sequence[Load], time: float) -> np.ndarray:
    """Return the external forces (n, loads) [N, N m] per unit factor of loads of the model in a state p (n,).

    The forces of follower loads have the directions of the state; those of imposed strains are -dr/d(factor). They are
    central differences, linear but for laws. A load that is listed twice is one input.
    """
    forces = np.empty((len(loads), len(p)))
    for force, load in zip(forces, loads, strict=True):
        imposed, own = isinstance(load, ImposedStrain), {id(part) for part in load.parts}
        middle, width = (factor(load, time, system.static), _WIDTH) if imposed else (0.0, _LARGE)
        alone = np.array([id(part) in own for part in system.model.acting], dtype=float)
        ends = [equations.residual_under(system, p, time, (middle + side * width) * alone) for side in (-1.0, 1.0)]
        force[:] = (ends[0] - ends[1]) / (2.0 * width * sum(each is load for each in system.model.loads))
    return forces.T
