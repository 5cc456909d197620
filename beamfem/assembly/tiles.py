"""A long chain in tiles: groups of elements that are small enough for their node data to stay in the cache.

The two halves of the chain share no coordinate, so that two threads can process them; one element lies between.
"""

from dataclasses import dataclass

import numpy as np

from beamfem.assembly.assembler import Assembler, Equations
from beamfem.assembly.chain_parts import block_of, is_chain, loads_of
from beamfem.assembly.sheet import make_sheet
from beamfem.assembly.sheet_structure import storage_order
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.band import KNOWN
from beamfem.kernels.block import Block

LONG = 20_000  # elements; the node data of longer chains does not fit into the cache
_NODES = 2048  # of a tile: about 400 kB, and half as much again for tables


@dataclass(frozen=True, eq=False)
class Tiles:
    """The groups of a long chain.

    assembler: its equations, with a workspace for each half; loads: indices of the loads of each group among those of
    the chain; turning (np, 3): see `System.turning`, with nodes in the storage order of the groups; bounds (3, fields):
    of both halves and of the element between them, see `kernels.record`.
    """

    assembler: Assembler
    loads: tuple[np.ndarray, ...]
    turning: np.ndarray
    bounds: np.ndarray


def tiles_of(system: System) -> Tiles | None:
    """Return the tiles of a model, None unless it is a long chain with a compiled band width."""
    if not is_chain(system) or len(system.blocks[0].node) < LONG:
        return None
    (block,), (loads,), (layout,) = system.blocks, system.point_loads, system.layouts
    middle = _middle(block)
    if middle is None or layout.half_width not in KNOWN:
        return None
    size = max(_NODES // (block.node.shape[1] - 1), 1)
    halves = _cut(0, middle - 1, size), _cut(middle, len(block.node), size)
    slices = [*halves[0], *halves[1], slice(middle - 1, middle)]
    sheets, loaded, place, stored = [], [], np.empty(len(block.dof), dtype=np.int64), 0
    for own in slices:
        part, (points, which) = block_of(block, own), loads_of(loads, own)
        sheets.append(make_sheet(part, layout, points))
        loaded.append(which)
        order, nodes = sheets[-1].order, len(part.dof)
        first = int(block.node[own.start, 0])
        place[first + (np.arange(nodes) if order is None else order)] = stored + np.arange(nodes)
        stored += nodes
    spaces = [*[0] * len(halves[0]), *[1] * len(halves[1]), 0]
    assembler = Assembler(Equations(sheets, system.springs, system.model.size), spaces=spaces)
    turning, order = system.turning.copy(), storage_order(block.node, len(block.node_kind))
    turning[:, 2] = place[turning[:, 2] if order is None else order[turning[:, 2]]]
    return Tiles(assembler, tuple(loaded), turning, _bounds(system, turning, block.dof[block.node[middle, 0]], spaces))


def _bounds(system: System, turning: np.ndarray, dof: np.ndarray, spaces: list[int]) -> np.ndarray:
    """Return the bounds (3, fields) of both halves and of the element between them.

    dof: coordinates of the first node of the second half; spaces: workspace number of each group.
    """
    size, unknown, groups = system.model.size, len(system.free_dofs), len(spaces)
    coordinate = int(dof[dof >= 0].min())
    number = int(np.searchsorted(system.free_dofs, coordinate))
    pair = int(np.searchsorted(turning[:, 0], number))
    ends = np.zeros((3, 4), dtype=np.int64)
    ends[1:] = (spaces.index(1), coordinate, number, pair), (groups - 1, size, unknown, len(turning))
    bounds = np.empty((3, record.BOUND_FIELDS), dtype=np.int64)
    bounds[:, ::2] = ends
    bounds[:2, 1::2], bounds[2, 1::2] = ends[1:], (groups, size, unknown, len(turning))
    return bounds


def _cut(first: int, end: int, size: int) -> list[slice]:
    return [slice(begin, min(begin + size, end)) for begin in range(first, end, size)]


def _middle(block: Block) -> int | None:
    """Return the first element of the second half, None if the halves share coordinates."""
    dof = np.where(block.dof < 0, block.dof.max(), block.dof)
    half = len(block.node) // 2
    for element in range(half, len(block.node)):
        node = block.node[element, 0]
        first = dof[node].min()
        # at a corner of the curve, adjacent elements have separate nodes
        joined = node == block.node[element - 1, -1]
        if joined:
            return element if block.dof[:node].max() < first <= dof[node:].min() else None
    return None
