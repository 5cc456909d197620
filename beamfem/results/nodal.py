"""Nodal vectors, angles and the interpolated axis in states of a beam, at all nodes or only where they are needed."""

from collections.abc import Sequence

import numpy as np

from beamfem.element import coordinates
from beamfem.element.fields import Axis
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import interpolate


def nodal_vectors(
    mesh: BeamMesh, p: np.ndarray, some: np.ndarray | None = None, v: np.ndarray | None = None
) -> np.ndarray:
    """Return the nodal vectors e (steps, nodes, vectors per node, 2) of states p (steps, n), of some nodes or all.

    v (steps, n): rates p', for the rates e' = B p' in place of e.
    """
    dof, frame, kinds = _nodes(mesh, some)
    table = p[:, dof]
    result = np.empty((*table.shape[:2], len(mesh.vectors), 2))
    for node_kind, nodes in kinds:
        own = node_kind, mesh.vectors, table[:, nodes]
        if v is None:
            result[:, nodes] = coordinates.nodal_vectors(*own, frame[nodes])
        else:
            result[:, nodes] = coordinates.nodal_rates(*own, v[:, dof[nodes]], frame[nodes])
    return result


def nodal_velocities(mesh: BeamMesh, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the rates e' = B p' (steps, nodes, vectors per node, 2) of the nodal vectors."""
    return nodal_vectors(mesh, p, None, v)


def _nodes(mesh: BeamMesh, some: np.ndarray | None) -> tuple[np.ndarray, np.ndarray, Sequence[tuple[int, np.ndarray]]]:
    """Return coordinates (k, npn) and frames (k, 3) of some nodes (k,) or all, and each kind with its nodes."""
    nodes = mesh.kinematics
    if some is None:
        return nodes.dof, nodes.frame, mesh.node_kinds
    kind = nodes.node_kind[some]
    return nodes.dof[some], nodes.frame[some], [(own, np.flatnonzero(kind == own)) for own in set(kind.tolist())]


def axis(mesh: BeamMesh, vectors: np.ndarray, element: np.ndarray, xi: np.ndarray) -> Axis:
    """Interpolate nodal vectors (steps, nodes, vectors, 2) at points (element, xi), both (points,)."""
    own = mesh.node[element]
    local = vectors[:, own].reshape(len(vectors), len(element), own.shape[1] * vectors.shape[2], 2)
    return interpolate(mesh, local, element, xi)


def axis_at(mesh: BeamMesh, p: np.ndarray, element: np.ndarray, xi: np.ndarray, v: np.ndarray | None = None) -> Axis:
    """Return the axis in states p (steps, n), or its rate for v, at points (element, xi), both (points,)."""
    some = mesh.node[element].ravel()
    if len(some) >= mesh.nodes:
        return axis(mesh, nodal_vectors(mesh, p, None, v), element, xi)
    vectors = nodal_vectors(mesh, p, some, v)
    return interpolate(mesh, vectors.reshape(len(vectors), len(element), -1, 2), element, xi)


def rate_at(mesh: BeamMesh, p: np.ndarray, v: np.ndarray, element: np.ndarray, xi: np.ndarray) -> Axis:
    """Return the rate of the axis at points (element, xi), likewise."""
    return axis_at(mesh, p, element, xi, v)


def has_angles(mesh: BeamMesh) -> bool:
    """Return whether the rotation of every node's section is a coordinate."""
    if mesh.beam.element.forces.turns_with == "r_x":
        return False
    return all(coordinates.labels(node_kind, mesh.vectors)[-1] == "theta" for node_kind, _ in mesh.node_kinds)


def nodal_angles(mesh: BeamMesh, p: np.ndarray, some: np.ndarray) -> np.ndarray:
    """Return the rotations (steps, k) [rad] of some nodes (k,) of a beam that has them as coordinates."""
    last = {node_kind: len(coordinates.labels(node_kind, mesh.vectors)) - 1 for node_kind, _ in mesh.node_kinds}
    column = [last[node_kind] for node_kind in mesh.kinematics.node_kind[some].tolist()]
    return np.asarray(p[:, mesh.kinematics.dof[some, column]])
