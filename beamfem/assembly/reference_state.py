"""The coordinates of the stress-free state of a model."""

from collections.abc import Sequence

import numpy as np

from beamfem.assembly.coordinate_columns import columns_of
from beamfem.element.coordinates import across
from beamfem.kernels.block import Block
from beamfem.model.model import Model

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
