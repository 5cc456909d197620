"""The coordinates of the stress-free state of a model, grouped by beam, name and kind of node."""

from collections.abc import Sequence

import numpy as np

from beamfem.element.coordinates import across, labels
from beamfem.kernels.block import ROTATED_GRADIENTS, Block
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.model import Model

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


Places = tuple[np.ndarray, np.ndarray, np.ndarray]
_SOURCES = ("r^x", "r^y", "r_x^x", "r_x^y", "r_y^x", "r_y^y", "s")


def stress_free(model: Model, blocks: Sequence[Block]) -> np.ndarray:
    """Return the coordinates (n,) of a model in its reference; multipliers and history variables are zero."""
    p = np.zeros(model.size)
    for number, (element, block) in enumerate(zip(model.groups, blocks, strict=True)):
        meshes = [mesh for mesh in model.meshes if mesh.block == number]
        position, tangent, speed = (
            np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in ("position", "tangent", "speed")
        )
        speed = speed[:, None]
        table = np.concatenate((position, tangent * speed, across(tangent), speed), axis=1)
        dofs, nodes, sources = _places(block, element.field.vectors)
        p[dofs] = table[nodes, sources]
    return p


def _places(block: Block, vectors: tuple[str, ...]) -> Places:
    """Return the coordinates (k,) that are not angles, with the node and the number in `_SOURCES` of each."""
    columns = [column for column in columns_of(block.node_kind, block.dof, vectors) if column[0] != "theta"]
    sources = [np.full(len(nodes), _SOURCES.index(label)) for label, nodes, _ in columns]
    return (
        np.concatenate([column[2] for column in columns]),
        np.concatenate([column[1] for column in columns]),
        np.concatenate(sources),
    )
