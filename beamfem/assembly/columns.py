"""Coordinates of a beam, grouped by name and kind of node."""

from functools import lru_cache

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.kernels.block import ROTATED_GRADIENTS
from beamfem.model.mesh import BeamMesh

Columns = list[tuple[str, np.ndarray, np.ndarray]]
_FEW = 2000  # nodes; the columns of larger meshes are not cached


def coordinate_columns(mesh: BeamMesh) -> Columns:
    """Return name, nodes and numbers in the model of each coordinate of a beam, for each kind of node.

    Joined nodes with gradients share r_y, rotated by the angle between them; it is listed at the first of them only.
    """
    return columns_of(mesh.kinematics.node_kind, mesh.kinematics.dof, mesh.vectors)


def columns_of(node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Columns:
    """Return `coordinate_columns` for nodes of the given kinds (N,) with coordinates dof (N, npn)."""
    if len(node_kinds) > _FEW:
        return _columns_of(node_kinds, dof, vectors)
    return _cached_columns(node_kinds.tobytes(), dof.tobytes(), vectors)


@lru_cache(maxsize=64)
def _cached_columns(node_kinds: bytes, dof: bytes, vectors: tuple[str, ...]) -> Columns:
    kinds = np.frombuffer(node_kinds, dtype=np.int64)
    return _columns_of(kinds, np.frombuffer(dof, dtype=np.int64).reshape(len(kinds), -1), vectors)


def _columns_of(node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Columns:
    result = []
    for node_kind in np.unique(node_kinds).tolist():
        nodes = np.flatnonzero(node_kinds == node_kind)
        for column, label in enumerate(labels(node_kind, vectors)):
            if node_kind != ROTATED_GRADIENTS or not label.startswith("r_y"):
                result.append((label, nodes, dof[nodes, column]))
    return result
