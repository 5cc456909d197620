"""Coordinates by their names, of all nodes with like carriers."""

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.kernels.block import TURNED_GRADIENTS
from beamfem.model.mesh import BeamMesh


def coordinate_columns(mesh: BeamMesh) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Return name, nodes and numbers in the model of each coordinate of a beam, of all nodes with like carriers.

    A vector that is turned at a joint is that of the first of the joined nodes, and listed there only.
    """
    return columns_of(mesh.carried.node_kind, mesh.carried.dof, mesh.vectors)


def columns_of(
    node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]
) -> list[tuple[str, np.ndarray, np.ndarray]]:
    result = []
    for node_kind in np.unique(node_kinds).tolist():
        nodes = np.flatnonzero(node_kinds == node_kind)
        for column, label in enumerate(labels(node_kind, vectors)):
            if node_kind != TURNED_GRADIENTS or not label.startswith("r_y"):
                result.append((label, nodes, dof[nodes, column]))
    return result
