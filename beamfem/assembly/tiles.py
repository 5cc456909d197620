"""A long chain in tiles: groups of elements that are small enough for their node data to stay in the cache.

The two halves of the chain share no coordinate, so that two threads can process them; one element lies between.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.assembly.assembler import Assembler, Equations
from beamfem.assembly.chain_parts import block_of, is_chain, loads_of
from beamfem.assembly.element_group import make_group
from beamfem.assembly.group_structure import storage_order
from beamfem.assembly.rotating_vectors import runs_of
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.band import KNOWN
from beamfem.kernels.block import Block, Layout, PointLoads, Springs
from beamfem.kernels.pointers import address_of
from beamfem.kernels.two_sided_parts import whole_blocks

LONG = 20_000  # elements; the node data of longer chains does not fit into the cache
_FEWEST = 4  # unknowns in half widths: two are left in the middle
_NODES = 2048  # of a tile: about 400 kB, and half as much again for tables


@dataclass(frozen=True, eq=False)
class Tiles:
    """The tiles of a long chain.

    assembler: its equations, with a workspace for each half; loads: indices of the loads of each group among those of
    the chain; bounds (3, fields): of both halves and of the element between them; table (tiles, fields): of the tiles
    of all three, each in the order from its end of the chain, see `kernels.record`; pairs: tables to which it points;
    rows_down: equations eliminated from the start of the chain.
    """

    assembler: Assembler
    loads: tuple[np.ndarray, ...]
    bounds: np.ndarray
    table: np.ndarray
    pairs: tuple[np.ndarray, ...]
    rows_down: int


def is_long(system: System) -> bool:
    """Return whether a model is a chain whose motion is worth dividing into tiles."""
    return is_chain(system) and len(system.blocks[0].node) >= LONG


def tiles_of(system: System) -> Tiles | None:
    """Return the tiles of a model, None unless it is a long chain with a compiled band width."""
    if not is_long(system):
        return None
    (block,), (loads,), (layout,) = system.blocks, system.point_loads, system.layouts
    suitable = layout.half_width in KNOWN and len(system.free_dofs) >= _FEWEST * layout.half_width
    middle = _middle(block, system.free_dofs) if suitable else None
    if middle is None:
        return None
    size = max(_NODES // (block.node.shape[1] - 1), 1)
    halves = _cut(0, middle - 1, size), _cut(middle, len(block.node), size)
    slices = (*halves[0], *halves[1], slice(middle - 1, middle))
    tiles = [_Tile(block, part, layout, loads) for part in slices]
    first = len(halves[0])
    position, stored = np.empty(len(block.dof), dtype=np.int64), np.cumsum([0, *(len(part.nodes) for part in tiles)])
    # of nodes that two tiles share, the one that completes their equations comes last
    for number in (*range(first), *range(len(tiles) - 2, first - 1, -1), len(tiles) - 1):
        position[tiles[number].nodes] = stored[number] + np.arange(len(tiles[number].nodes))
    springs = Springs(*(values[np.argsort(system.springs.dof, kind="stable")] for values in system.springs))
    spaces = [*[0] * len(halves[0]), *[1] * len(halves[1]), 0]
    groups = [part.group for part in tiles]
    assembler = Assembler(Equations(groups, springs, system.model.size), spaces=spaces)
    rotating, order = system.rotating.copy(), storage_order(block.node, len(block.node_kind))
    rotating[:, 2] = position[rotating[:, 2] if order is None else order[rotating[:, 2]]]
    ranges = _nested(np.array([part.range for part in tiles]), first)
    # what one half needs to solve for its unknowns, the other must not have rotated: half of it lies between them
    rows_down = int(np.searchsorted(system.free_dofs, ranges[-1]).sum()) // 2 - layout.half_width
    bounds, table = _tables(system, springs.dof, ranges, first, rows_down)
    table[:, record.TILE_NODE] = stored[table[:, record.TILE_GROUP]]
    pairs = _pairs(rotating, table)
    return Tiles(assembler, tuple(part.loaded for part in tiles), bounds, table, pairs, rows_down)


class _Tile:
    """Some elements of a chain: their group, nodes in storage order, range of coordinates, and indices of loads.

    Coordinates and equations are counted from its first ones, so that tiles of like elements share their tables.
    """

    def __init__(self, block: Block, elements: slice, layout: Layout, loads: PointLoads) -> None:
        nodes = np.arange(int(block.node[elements.start, 0]), int(block.node[elements.stop - 1, -1]) + 1)
        dof = block.dof[nodes]
        begin, end = int(dof[dof >= 0].min()), int(dof.max()) + 1
        free = layout.free[begin:end]
        number = int(free[free >= 0].min(initial=len(layout.free)))
        points, self.loaded = loads_of(loads, elements)
        tile_layout = layout._replace(free=np.where(free >= 0, free - number, -1))
        self.group, self.range = make_group(block_of(block, elements, begin), tile_layout, points), (begin, end)
        self.group.table[record.FIRST_OF_STATE] = begin
        self.group.table[record.FIRST_OF_MATRIX] = number * (2 * layout.half_width + 1)
        self.nodes = nodes if self.group.order is None else nodes[self.group.order]


def _pairs(rotating: np.ndarray, table: np.ndarray) -> tuple[np.ndarray, ...]:
    """Fill the pairs of vectors that rotate into the table of tiles, and return their tables, which tiles share."""
    shared: dict[bytes, np.ndarray] = {}
    for tile in table:
        unknown, end, node = tile[[record.DONE_UNKNOWN, record.END_DONE_UNKNOWN, record.TILE_NODE]]
        first, last = np.searchsorted(rotating[:, 0], (unknown, end))
        pairs = runs_of(rotating[first:last] - [unknown, unknown, node, 0])
        pairs = shared.setdefault(pairs.tobytes(), pairs)
        tile[record.TILE_RUNS_OF_PAIRS], tile[record.TILE_PAIR_TABLE] = len(pairs), address_of(pairs)
    return tuple(shared.values())


def _nested(ranges: np.ndarray, first: int) -> np.ndarray:
    """Return the ranges (tiles, 2) of coordinates, widened so that bounds increase along both halves."""
    for half in (slice(0, first), slice(first, len(ranges) - 1)):
        ranges[half, 1] = np.maximum.accumulate(ranges[half, 1])
        ranges[half, 0] = np.minimum.accumulate(ranges[half][::-1, 0])[::-1]
    return ranges


def _tables(
    system: System, springs: np.ndarray, ranges: np.ndarray, first: int, rows_down: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the bounds (3, fields) of the parts, and the table (tiles, fields) of their tiles.

    springs: coordinates; ranges (tiles, 2) of the coordinates of each group; first: number of tiles of the first half.
    """
    free, size, half = system.free_dofs, system.model.size, system.layouts[0].half_width
    tiles, (begin, end), middle = len(ranges), ranges[-1], int(ranges[first, 0])
    # bounds between what one tile has and the next, as coordinates: where it is new, and where it is complete
    new = [[0, *ranges[: first - 1, 1], middle], [size, *ranges[tiles - 2 : first : -1, 0], middle], [middle, middle]]
    done = [[0, *ranges[1:first, 0], begin], [size, *ranges[tiles - 3 : first - 1 : -1, 1], end], [begin, end]]
    order = [np.arange(first), np.arange(tiles - 2, first - 1, -1), np.array([tiles - 1])]
    parts, bounds, reached = [], np.zeros((3, record.BOUND_FIELDS), dtype=np.int64), 0
    for part in range(3):
        table = np.zeros((len(order[part]), record.TILE_FIELDS), dtype=np.int64)
        table[:, record.TILE_GROUP] = order[part]
        done_unknowns = np.searchsorted(free, done[part])
        for field, limits in (
            (record.NEW_COORDINATE, new[part]),
            (record.NEW_UNKNOWN, np.searchsorted(free, new[part])),
            (record.DONE_COORDINATE, done[part]),
            (record.DONE_UNKNOWN, done_unknowns),
            (record.DONE_SPRING, np.searchsorted(springs, done[part])),
        ):
            table[:, field : field + 2] = _ranges(limits)
        if part < 2:
            row_count = rows_down if part == 0 else len(free) - 2 * half - rows_down
            rows = [whole_blocks(abs(int(row - done_unknowns[0])), row_count, half) for row in done_unknowns]
            table[:, record.ROWS_BEFORE], table[:, record.ROWS_WITH] = rows[:-1], rows[1:]
        parts.append(table)
        limits = [0, middle] if part == 0 else [middle, size] if part == 1 else [size, size]
        bounds[part, record.FIRST_COORDINATE : record.END_COORDINATE + 1] = limits
        bounds[part, record.FIRST_UNKNOWN : record.END_UNKNOWN + 1] = np.searchsorted(free, limits)
        bounds[part, record.FIRST_TILE], bounds[part, record.END_TILE] = reached, reached + len(table)
        reached += len(table)
    return bounds, np.concatenate(parts)


def _ranges(limits: Iterable[int] | Sequence[int]) -> np.ndarray:
    """Return the ranges (k, 2) between limits (k + 1,) that increase or decrease."""
    values = np.asarray(limits)
    return np.sort(np.column_stack([values[:-1], values[1:]]), axis=1)


def _cut(first: int, end: int, size: int) -> list[slice]:
    return [slice(begin, min(begin + size, end)) for begin in range(first, end, size)]


def _middle(block: Block, free: np.ndarray) -> int | None:
    """Return the first element of the second half, about half of the unknowns (nu,) on, None if halves share some."""
    dof = np.where(block.dof < 0, block.dof.max(), block.dof)
    half = int(np.searchsorted(dof[block.node[:, 0]].min(axis=1), free[len(free) // 2]))
    for element in range(max(half, 2), len(block.node)):
        node = block.node[element, 0]
        first = dof[node].min()
        # at a corner of the curve, adjacent elements have separate nodes
        joined = node == block.node[element - 1, -1]
        if joined:
            return element if block.dof[:node].max() < first <= dof[node:].min() else None
    return None
