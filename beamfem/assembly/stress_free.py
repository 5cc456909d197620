"""The coordinates of the stress-free state of a model."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from beamfem.assembly.columns import columns_of
from beamfem.element.coordinates import across
from beamfem.kernels.block import Block
from beamfem.model.model import Model

Places = tuple[np.ndarray, np.ndarray, np.ndarray]
_FEW = 2000  # nodes; the places of larger blocks are not cached
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
    if len(block.node_kind) > _FEW:
        return _places_of(block.node_kind, block.dof, vectors)
    return _cached_places(block.node_kind.tobytes(), block.dof.tobytes(), vectors)


def _places_of(node_kind: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Places:
    columns = [column for column in columns_of(node_kind, dof, vectors) if column[0] != "theta"]
    sources = [np.full(len(nodes), _SOURCES.index(label)) for label, nodes, _ in columns]
    return (
        np.concatenate([column[2] for column in columns]),
        np.concatenate([column[1] for column in columns]),
        np.concatenate(sources),
    )


@lru_cache(maxsize=64)
def _cached_places(node_kind: bytes, dof: bytes, vectors: tuple[str, ...]) -> Places:
    kinds = np.frombuffer(node_kind, dtype=np.int64)
    return _places_of(kinds, np.frombuffer(dof, dtype=np.int64).reshape(len(kinds), -1), vectors)
