"""The order of the unknown coordinates, and where element matrices go: into a band, or a sparse matrix."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from beamfem.kernels.block import Block, Layout

_WIDEST_BAND = 64  # half width; wider models are solved faster by a sparse factorisation


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Order of the unknown coordinates.

    free (n,): number of a coordinate among the unknown ones, -1 where it is held; dofs (unknown,): the coordinates in
    that order; layouts: one a block; pattern: the sparse matrix with places for its data, None for a band.
    """

    free: np.ndarray
    dofs: np.ndarray
    layouts: tuple[Layout, ...]
    pattern: csc_array | None
    diagonal: np.ndarray


def order_unknowns(blocks: Sequence[Block], size: int, held: np.ndarray, joined: bool) -> Unknowns:
    """Return the order of the coordinates (size,) that are not held; a chain keeps its own, joined beams get a new."""
    mask = np.ones(size, dtype=bool)
    mask[held] = False
    dofs = np.flatnonzero(mask)
    if joined:
        reordered = _narrow(blocks, size)
        reordered = reordered[mask[reordered]]
        if _half_width(blocks, _numbers(reordered, size)) < _half_width(blocks, _numbers(dofs, size)):
            dofs = reordered
    free = _numbers(dofs, size)
    half_width = _half_width(blocks, free)
    none = np.empty((0, 0, 0), dtype=np.int64)
    if half_width <= _WIDEST_BAND:
        layouts = tuple(Layout(free, half_width, none) for _ in blocks)
        diagonal = np.arange(len(dofs)) * (2 * half_width + 1) + half_width
        return Unknowns(free, dofs, layouts, None, diagonal)
    pattern, slots = _pattern(blocks, free, len(dofs))
    layouts = tuple(Layout(free, -1, slot) for slot in slots)
    diagonal = _places(pattern, np.arange(len(dofs)), np.arange(len(dofs)))
    return Unknowns(free, dofs, layouts, pattern, diagonal)


def _numbers(dofs: np.ndarray, size: int) -> np.ndarray:
    free = np.full(size, -1, dtype=np.int64)
    free[dofs] = np.arange(len(dofs))
    return free


def _numbers_of(block: Block, free: np.ndarray) -> np.ndarray:
    """Numbers among the unknown (ne, nn npn) of each element's coordinates, -1 where there is none."""
    numbers = np.where(block.dof >= 0, free[block.dof], -1)
    return np.asarray(numbers[block.node].reshape(len(block.node), -1))


def _half_width(blocks: Sequence[Block], free: np.ndarray) -> int:
    """Largest distance between two unknowns of an element."""
    widest = 0
    for block in blocks:
        number = _numbers_of(block, free)
        low = np.where(number >= 0, number, len(free)).min(axis=1)
        widest = max(widest, int((number.max(axis=1) - low).max(initial=0)))
    return widest


def _narrow(blocks: Sequence[Block], size: int) -> np.ndarray:
    """Order the coordinates (size,) by reverse Cuthill-McKee on pairs (x, y) and the rest of a node together."""
    rows, columns = [], []
    for block in blocks:
        first = block.dof[block.node, 0]
        # neighbours along an element, and its ends, which join it to others
        rows += [first[:, :-1].ravel(), first[:, 0]]
        columns += [first[:, 1:].ravel(), first[:, -1]]
    row, column = np.concatenate(rows), np.concatenate(columns)
    # x and y of a node stay neighbours: collapse each coordinate onto the first of its node
    owner = np.arange(size)
    for block in blocks:
        for own in block.dof.T[1:]:
            known = own >= 0
            owner[own[known]] = np.minimum(owner[own[known]], block.dof[known, 0])
    owner = owner[owner]
    graph = coo_array((np.ones(len(row)), (owner[row], owner[column])), shape=(size, size)).tocsr()
    order = reverse_cuthill_mckee(graph + graph.T, symmetric_mode=True)
    rank = np.empty(size, dtype=np.int64)
    rank[order] = np.arange(size)
    return np.lexsort((np.arange(size), rank[owner]))


def _pattern(blocks: Sequence[Block], free: np.ndarray, unknown: int) -> tuple[csc_array, list[np.ndarray]]:
    """Return the sparse pattern of all element matrices and the place of each of their entries."""
    numbers = [_numbers_of(block, free) for block in blocks]
    rows, columns = [np.arange(unknown)], [np.arange(unknown)]
    for number in numbers:
        i, j = np.broadcast_arrays(number[:, :, None], number[:, None, :])
        known = (i >= 0) & (j >= 0)
        rows.append(i[known])
        columns.append(j[known])
    row, column = np.concatenate(rows), np.concatenate(columns)
    pattern = coo_array((np.ones(len(row)), (row, column)), shape=(unknown, unknown)).tocsc()
    pattern.sum_duplicates()
    pattern.sort_indices()
    slots = []
    for number in numbers:
        i, j = np.broadcast_arrays(number[:, :, None], number[:, None, :])
        known = (i >= 0) & (j >= 0)
        slot = np.full(i.shape, -1, dtype=np.int64)
        slot[known] = _places(pattern, i[known], j[known])
        slots.append(slot)
    return pattern, slots


def _places(pattern: csc_array, row: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Place in the data of each entry (row, column)."""
    n = pattern.shape[0]
    keys = np.repeat(np.arange(n), np.diff(pattern.indptr)) * n + pattern.indices
    return np.searchsorted(keys, column * n + row)
