"""Coordinates of a beam, grouped by name and kind of node."""

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.kernels.block import ROTATED_GRADIENTS
from beamfem.model.beam_mesh import BeamMesh

Columns = list[tuple[str, np.ndarray, np.ndarray]]


def coordinate_columns(mesh: BeamMesh) -> Columns:
    """Return name, nodes and numbers in the model of each coordinate of a beam, for each kind of node.

    Joined nodes with gradients share r_y, rotated by the angle between them; it is listed at the first of them only.
    """
    return columns_of(mesh.kinematics.node_kind, mesh.kinematics.dof, mesh.vectors)


def columns_of(node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Columns:
    """Return `coordinate_columns` for nodes of the given kinds (N,) with coordinates dof (N, npn)."""
    result = []
    for node_kind in np.unique(node_kinds).tolist():
        nodes = np.flatnonzero(node_kinds == node_kind)
        for column, label in enumerate(labels(node_kind, vectors)):
            if node_kind != ROTATED_GRADIENTS or not label.startswith("r_y"):
                result.append((label, nodes, dof[nodes, column]))
    return result
