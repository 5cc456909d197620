"""Coordinates by their names, of all nodes with like carriers."""

from functools import lru_cache

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.kernels.block import TURNED_GRADIENTS
from beamfem.model.mesh import BeamMesh

Columns = list[tuple[str, np.ndarray, np.ndarray]]
_FEW = 2000  # nodes; the columns of more are not kept


def coordinate_columns(mesh: BeamMesh) -> Columns:
    """Return name, nodes and numbers in the model of each coordinate of a beam, of all nodes with like carriers.

    A vector that is turned at a joint is that of the first of the joined nodes, and listed there only.
    """
    return columns_of(mesh.carried.node_kind, mesh.carried.dof, mesh.vectors)


def columns_of(node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Columns:
    """Return the same of nodes of some kinds (N,) with coordinates dof (N, npn)."""
    if len(node_kinds) > _FEW:
        return _columns_of(node_kinds, dof, vectors)
    return _columns_of_few(node_kinds.tobytes(), dof.tobytes(), vectors)


@lru_cache(maxsize=64)
def _columns_of_few(node_kinds: bytes, dof: bytes, vectors: tuple[str, ...]) -> Columns:
    kinds = np.frombuffer(node_kinds, dtype=np.int64)
    return _columns_of(kinds, np.frombuffer(dof, dtype=np.int64).reshape(len(kinds), -1), vectors)


def _columns_of(node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Columns:
    result = []
    for node_kind in np.unique(node_kinds).tolist():
        nodes = np.flatnonzero(node_kinds == node_kind)
        for column, label in enumerate(labels(node_kind, vectors)):
            if node_kind != TURNED_GRADIENTS or not label.startswith("r_y"):
                result.append((label, nodes, dof[nodes, column]))
    return result
