"""Linearisation of a model about an equilibrium or a state of a motion."""

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.equations import equations
from beamfem.equations.equations import INERTIA, STATICS
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError
from beamfem.linalg.tangent import UNROTATED
from beamfem.model.beam import beam_in_words
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.results.solution import Solution, State
from beamfem.solve.linear.input_forces import input_forces
from beamfem.solve.linear.linear_model import LinearModel, scale_of
from beamfem.solve.linear.null_space import independent_motions
from beamfem.solve.start.start_checks import refuse_frame, require_equilibrium
from beamfem.solve.start.start_state import last_state, require_finite, resting_state
from beamfem.validation import items

_DAMPING = (0.0, 1.0, 0.0)
_ROUND_OFF = 16.0 * float(np.finfo(float).eps)


def linearise(model: Model, about: State | Solution | None = None, loads: Sequence[Load] | None = None) -> LinearModel:
    """Linearise the equations of motion about a state, M z'' + C z' + K z = B f.

    M, C and K are the derivatives of the residual by p'', p' and p, the exact tangents of the state with its loads:
    geometric stiffness, dampers, and for a moving state gyroscopic terms. Prescribed coordinates are eliminated, and
    so are those that conditions determine, of multipliers and inclined rollers; K has the curvature of the conditions
    times their multipliers.

    Parameters
    ----------
    model : Model
        Beams, supports, loads, joints and connectors.
    about : State or Solution, optional
        A static equilibrium, or a state of a motion, or a solution for its last state; by default the reference at
        load factor 0. About a moving state, matrices hold at its time; with multipliers it must be at rest.
    loads : sequence, optional
        The inputs f: factors of loads of the model, or of further loads that do not act in the state; by default all
        loads of the model.

    Returns
    -------
    LinearModel
        The matrices.

    Raises
    ------
    InputError
        For an invalid argument, a state that is not in equilibrium, redundant conditions, and a load at a point that is
        no node.

    Examples
    --------
    >>> linear = bf.linearise(model, about=solution, loads=[bf.PointForce(beam.end, (1.0, 0.0))])
    >>> linear.input_matrix.shape
    (36, 1)
    """
    system, state = _state(model, about)
    inputs = tuple(model.loads if loads is None else items("loads", loads))
    loaded = _with_inputs(system, inputs)
    stiffness = _matrix(system, state, STATICS)
    independent, basis = independent_motions(system, state.p, stiffness)
    free = system.free_dofs
    order = np.argsort(free[independent])
    independent, basis = independent[order], basis[:, order]
    place = csr_array(coo_array((np.ones(len(free)), (free, np.arange(len(free)))), shape=(model.size, len(free))))
    transformation = csr_array(place @ basis)
    names = _names(system)
    mass, damping, stiffness = (
        csr_array(basis.T @ matrix @ basis)
        for matrix in (_matrix(system, state, INERTIA), _matrix(system, state, _DAMPING), stiffness)
    )
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
        if len(system.connectors.multipliers):
            raise InputError("a model with multipliers is linearised about a state at rest only, this one moves")
        return system, given
    system = system_of(model, static=True)
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
    return names
