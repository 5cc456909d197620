"""A state to start from, found again on the meshes that an analysis is refined with."""

from dataclasses import replace

import numpy as np

from beamfem.equations.system import system_of
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.model import Model
from beamfem.results.full_turns import first_turns
from beamfem.results.solution import Solution, State
from beamfem.solve.accuracy.error_estimate import carried_coordinates, enriched_row, remeshed
from beamfem.solve.start.start_checks import left_over

_RATE = 1e-6  # of the coordinates: change that rates are found by


def tied_to_mesh(start: object) -> str:
    """Return why a state cannot be found again on another mesh; empty if it can, as all static equilibria."""
    if start is None:
        return ""
    if not isinstance(start, State | Solution) or not len(rows := _rows(start)):
        return "is one of a path"
    state = rows[-1]
    system = system_of(state.model, static=True)
    if not rows.static or np.any(state.v) or np.any(state.a):
        return "moves"
    if left_over(system, state.p, state.at) > 0.0:
        return "is not in equilibrium"
    past = state.p[system.history.numbers]
    if isinstance(start, State) and not np.array_equal(past, system.history.start):
        return "has a history, which only the whole solution tells"
    return ""


def carried(start: State | Solution | None, model: Model) -> State | None:
    """Return a state in its own model on the mesh of another one, whose elements lie within its own.

    A static one is the equilibrium next to it, of a solution with the history of its rows. What moves is interpolated.
    Raises ConvergenceError.
    """
    if start is None:
        return None
    rows = _rows(start)
    if all(_same(*each) for each in zip(rows.model.meshes, model.meshes, strict=True)):
        return rows[-1]
    target = remeshed(rows.model, model.beams)
    return _interpolated(rows[-1], target) if tied_to_mesh(start) else enriched_row(rows, len(rows) - 1, target)[0]


def _interpolated(state: State, target: Model) -> State:
    p, rest = carried_coordinates(state, target), np.zeros(target.size)
    step = _RATE * float(np.max(np.abs(state.p))) / max(float(np.max(np.abs(state.v))), np.finfo(float).tiny)
    ahead, behind = (carried_coordinates(replace(state, p=state.p + way * state.v), target) for way in (step, -step))
    turned = None if state.turned is None else first_turns(target, p, state.turned)
    return State(p, (ahead - behind) / (2.0 * step), rest, state.at, target, turned=turned)


def _rows(start: State | Solution) -> Solution:
    return start.as_row(static=True) if isinstance(start, State) else start


def _same(old: BeamMesh, new: BeamMesh) -> bool:
    return old.beam.element == new.beam.element and np.array_equal(old.vertices, new.vertices)
