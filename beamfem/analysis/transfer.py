"""A state of one model as a state of another that has the same beams and meshes, but other supports or joints."""

import numpy as np

from beamfem import postprocess
from beamfem.element.axis import cross, dot
from beamfem.element.coordinates import across
from beamfem.errors import InputError
from beamfem.model.mesh import BeamMesh
from beamfem.model.model import Model
from beamfem.model.reference import reference_angle
from beamfem.model.system import System, coordinate_columns
from beamfem.solution import State


def transferred(state: State, system: System, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates (n,) of a state in the model of a system.

    Nodes are the same; whether gradients or angles carry them depends on what holds and joins them.
    Raises InputError where the beams do not match.
    """
    source, target = state.model, system.model
    if source is target:
        return np.array(state.p), np.array(state.v)
    _require_alike(source, target, name)
    p, v = system.reference.copy(), np.zeros(target.size)
    for old, new in zip(source.meshes, target.meshes, strict=True):
        values, rates = _by_label(old, state)
        for label, nodes, dofs in coordinate_columns(new):
            p[dofs], v[dofs] = values[label][nodes], rates[label][nodes]
    return p, v


def _by_label(mesh: BeamMesh, state: State) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Every coordinate that a node could have (nodes,), and its rate, by name."""
    p, v = state.p[None], state.v[None]
    e, rate = postprocess.nodal_vectors(mesh, p)[0], postprocess.nodal_velocities(mesh, p, v)[0]
    values: dict[str, np.ndarray] = {}
    rates: dict[str, np.ndarray] = {}
    for i, vector in enumerate(mesh.vectors):
        for component, axis in enumerate("xy"):
            values[f"{vector}^{axis}"], rates[f"{vector}^{axis}"] = e[:, i, component], rate[:, i, component]
    director, turning = e[:, -1], rate[:, -1]
    normal = -across(director)
    angle = np.arctan2(normal[:, 1], normal[:, 0]) - reference_angle(mesh)
    turns = np.round((postprocess.nodal_rotations(mesh, p)[0] - angle) / (2.0 * np.pi))
    values["theta"] = angle + 2.0 * np.pi * turns
    rates["theta"] = cross(director, turning) / dot(director, director)
    if "r_x" in mesh.vectors:
        slope = e[:, mesh.vectors.index("r_x")]
        along = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
        values["s"] = dot(slope, along)
        rates["s"] = dot(rate[:, mesh.vectors.index("r_x")], along)
    return values, rates


def _require_alike(source: Model, target: Model, name: str) -> None:
    advice = "take it from a model of the same beams, elements and points with supports"
    if len(source.meshes) != len(target.meshes):
        raise InputError(
            f"{name} is of a model with {len(source.meshes)} beams, this has {len(target.meshes)}; {advice}"
        )
    for number, (old, new) in enumerate(zip(source.meshes, target.meshes, strict=True)):
        if old.vectors != new.vectors or old.nodes != new.nodes or np.abs(old.arc - new.arc).max() > 1e-9 * new.arc[-1]:
            raise InputError(
                f"{name} has {old.nodes} nodes of {old.beam.element.name} on beam {number}, this model has {new.nodes} "
                f"of {new.beam.element.name}, or elsewhere; {advice}"
            )
