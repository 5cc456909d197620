"""Equation numbers of the unknown coordinates, and positions of element matrices in a band or sparse matrix."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, eye_array
from scipy.sparse.csgraph import laplacian, reverse_cuthill_mckee
from scipy.sparse.linalg import spilu

from beamfem.cached_properties import cached_property
from beamfem.kernels.block import Block, Layout


class Mesh(NamedTuple):
    """Nodes (ne, nn) of the elements of a block, and coordinates (N, npn) of its nodes."""

    node: np.ndarray
    dof: np.ndarray


def narrow_order(blocks: Sequence[Mesh], size: int) -> np.ndarray:
    """Order the coordinates (size,) by reverse Cuthill-McKee on the nodes, whose coordinates stay together."""
    owner = _owners(blocks, size)
    rows, columns = [], []
    for block in blocks:
        first = owner[block.dof[block.node, 0]]
        # adjacent nodes of an element, and its ends, which connect it to other elements
        rows += [first[:, :-1].ravel(), first[:, 0]]
        columns += [first[:, 1:].ravel(), first[:, -1]]
    row, column = np.concatenate(rows), np.concatenate(columns)
    graph = coo_array((np.ones(len(row)), (row, column)), shape=(size, size)).tocsr()
    order = reverse_cuthill_mckee(graph + graph.T, symmetric_mode=True)
    rank = np.empty(size, dtype=np.int64)
    rank[order] = np.arange(size)
    return np.lexsort((np.arange(size), rank[owner]))


def towards_support(
    blocks: Sequence[Mesh], order: np.ndarray, unknown: np.ndarray, constrained: np.ndarray
) -> np.ndarray | None:
    """Return the unknown coordinates with the nodes reversed if the order begins closer to a support than it ends.

    None if it does not. Elimination from a free end meets the stiffness of single elements only. In the other
    direction the last pivots are the stiffness of the whole cantilever, a difference of much larger numbers that has no
    digits in long ones. order (size,): all coordinates; unknown (size,): mask of the unknown ones.
    """
    if not len(constrained):
        return None
    owner = _owners(blocks, len(order))
    supported = np.zeros(len(order), dtype=bool)
    supported[owner[constrained]] = True
    places = np.flatnonzero(supported[owner[order]])
    left = unknown[order]
    if np.count_nonzero(left[: places[0]]) >= np.count_nonzero(left[places[-1] + 1 :]):
        return None
    own = owner[order]
    starts = np.flatnonzero(np.append(True, own[1:] != own[:-1]))
    counts = np.diff(np.append(starts, len(order)))[::-1]
    turned = order[np.repeat(starts[::-1] - np.cumsum(counts) + counts, counts) + np.arange(len(order))]
    return np.asarray(turned[unknown[turned]])


def scattered_order(blocks: Sequence[Mesh], size: int, coupled: Sequence[np.ndarray] = ()) -> np.ndarray:
    """Order the coordinates (size,) by multiple minimum degree on the nodes, for low fill-in."""
    owner = _owners(blocks, size)
    nodes, number = np.unique(owner, return_inverse=True)
    pairs = []
    for block in blocks:
        node = number[block.dof[block.node, 0]]
        i, j = np.triu_indices(node.shape[1], 1)
        pairs.append((node[:, i].ravel(), node[:, j].ravel()))
    for dofs in coupled:
        node = number[dofs]
        i, j = np.triu_indices(len(node), 1)
        apart = node[i] != node[j]
        pairs.append((node[i[apart]], node[j[apart]]))
    ends = np.concatenate(pairs, axis=1)
    shape = len(nodes), len(nodes)
    graph = coo_array((np.ones(ends.shape[1]), tuple(ends)), shape=shape)
    # SuperLU has no ordering without factorisation: one that drops all entries costs little more
    dominant = csc_array(laplacian(graph + graph.T) + eye_array(len(nodes)))
    options = {"SymmetricMode": True}
    order = spilu(dominant, drop_tol=1.0, fill_factor=1.0, permc_spec="MMD_AT_PLUS_A", options=options).perm_c
    return np.lexsort((np.arange(size), order[number]))


def _owners(blocks: Sequence[Mesh], size: int) -> np.ndarray:
    """Return the first coordinate (size,) of the node of each coordinate, by which those of a node stay together."""
    owner = np.arange(size)
    for block in blocks:
        for dof in block.dof.T[1:]:
            mask = dof >= 0
            owner[dof[mask]] = np.minimum(owner[dof[mask]], block.dof[mask, 0])
    return np.asarray(owner[owner])


def sparsity_pattern(numbers: Sequence[np.ndarray], unknown: int) -> tuple[csc_array, list[np.ndarray]]:
    """Return the sparsity pattern of matrices with equation numbers (ne, k), and the positions of their entries.

    It includes the diagonal.
    """
    rows, columns, masks = [], [], []
    for number in (table.astype(np.int32) for table in numbers):
        i, j = np.broadcast_arrays(number[:, :, None], number[:, None, :])
        mask = (i >= 0) & (j >= 0)
        rows.append(i[mask])
        columns.append(j[mask])
        masks.append(mask)
    diagonal = np.arange(unknown, dtype=np.int32)
    row, column = np.concatenate([*rows, diagonal]), np.concatenate([*columns, diagonal])
    order = _sorted_by(row, unknown)
    order = order[_sorted_by(column[order], unknown)]
    row, column = row[order], column[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (row[1:] != row[:-1]) | (column[1:] != column[:-1])
    position = np.empty(len(order), dtype=np.int32)
    position[order] = np.cumsum(new, dtype=np.int32) - 1
    starts = np.concatenate([[0], np.cumsum(np.bincount(column[new], minlength=unknown))])
    entries = np.ones(int(new.sum()), dtype=np.int8), row[new], starts.astype(np.int32)
    slots, begin = [], 0
    for mask in masks:
        end = begin + int(mask.sum())
        slot = np.full(mask.shape, -1, dtype=np.int32)
        slot[mask] = position[begin:end]
        slots.append(slot)
        begin = end
    return csc_array(entries, shape=(unknown, unknown)), slots


def _sorted_by(keys: np.ndarray, count: int) -> np.ndarray:
    """Return the stable sorting order of keys (n,) below a count, in linear time."""
    single = np.arange(len(keys) + 1, dtype=np.int32)
    # with one column per key, the conversion from CSC to CSR is a counting sort
    return csc_array((np.ones(len(keys), dtype=np.int8), keys, single), shape=(count, len(keys))).tocsr().indices


_FEW = 20_000  # coordinates; the order of larger models is not cached
_NONE = np.empty(0, dtype=np.int64)
_WIDEST_BAND = 64  # half width; wider models are solved faster by a sparse factorisation
WIDEST_BORDER = 64  # unknowns coupled beyond a band; with more, a sparse factorisation is faster


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Equation numbers of the unknown coordinates and positions of matrix entries.

    free (n,): equation number of each coordinate, -1 if it is prescribed; dofs (unknown,): the coordinates in the
    order of the equations; layouts: one per block; pattern: the sparse matrix with room for its data, None for a band;
    coupled: positions of the entries (k, k) of each coupling that is not an element, -1 for entries without one;
    border: equation numbers (t,) of those that couplings reach beyond a band, whose entries (t + k, t + k), with k
    multipliers, follow those of the band; reach (2, banded): see `reaches`, empty for a sparse matrix.
    """

    free: np.ndarray
    dofs: np.ndarray
    layouts: tuple[Layout, ...]
    pattern: csc_array | None
    coupled: tuple[np.ndarray, ...] = ()
    border: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    reach: np.ndarray = field(default_factory=lambda: np.empty((2, 0), dtype=np.int32))

    @property
    def banded(self) -> int:
        """Number of the equations of a band; those of multipliers follow."""
        return self.reach.shape[1]

    @property
    def border_size(self) -> int:
        """Number t + k of the equations of a border: those coupled beyond the band, and multipliers."""
        return len(self.border) + len(self.dofs) - self.banded if self.pattern is None else 0

    @property
    def entries(self) -> int:
        """Number of the entries of a matrix: of a sparse one, or of a band and its border."""
        if self.pattern is not None:
            return len(self.pattern.data)
        return len(self.dofs) * (2 * self.layouts[0].half_width + 1) + self.border_size**2

    @cached_property
    def first(self) -> int:
        """The first of the unknown coordinates if they follow one another, else -1."""
        in_a_row = len(self.dofs) > 0 and (self.dofs[1:] - self.dofs[:-1] == 1).all()
        return int(self.dofs[0]) if in_a_row else -1

    @cached_property
    def chosen(self) -> slice | np.ndarray:
        """Index of the unknown coordinates among all."""
        return slice(self.first, self.first + len(self.dofs)) if self.first >= 0 else self.dofs

    def diagonal(self, numbers: np.ndarray) -> np.ndarray:
        """Return the positions of the diagonal entries of unknowns (k,) in the matrix data."""
        if self.pattern is None:
            half = self.layouts[0].half_width
            return numbers * (2 * half + 1) + half
        starts, rows = self.pattern.indptr, self.pattern.indices
        positions = [starts[i] + np.searchsorted(rows[starts[i] : starts[i + 1]], i) for i in numbers.tolist()]
        return np.array(positions, dtype=np.int64)


class Couplings(NamedTuple):
    """Couplings of coordinates that are not elements.

    coordinates: those (k,) of each; multipliers: coordinates that come last, since they have no stiffness; border: how
    many unknowns they may couple beyond a band before the matrix is sparse, None if any coupling makes it sparse;
    bodies: those that a band has to contain, as it is singular without them, as meshes of one element.
    """

    coordinates: Sequence[np.ndarray] = ()
    multipliers: Sequence[int] = ()
    border: int | None = None
    bodies: Sequence[Mesh] = ()


def order_unknowns(
    blocks: Sequence[Block], size: int, known: np.ndarray, joined: bool, couplings: Couplings, supported: np.ndarray
) -> Unknowns:
    """Return the order of the unknown coordinates: that of the nodes for a single chain, renumbered for joined beams.

    known: coordinates that are no unknowns; joined: whether beams are joined; supported: coordinates that supports
    prescribe, at which a band of statics ends.
    """
    if len(blocks) == 1 and not joined and not couplings.coordinates and size <= _FEW:
        node, dof = blocks[0].node, blocks[0].dof
        numbers = node.tobytes(), node.shape, dof.tobytes(), dof.shape
        return _cached_order(*numbers, size, known.tobytes(), supported.tobytes())
    mesh = [Mesh(block.node, block.dof) for block in blocks]
    return _order(mesh, size, known, joined, couplings, supported)


@lru_cache(maxsize=64)  # studies repeatedly make models with the same numbering
def _cached_order(
    node: bytes, nodes: tuple[int, int], dof: bytes, dofs: tuple[int, int], size: int, *prescribed: bytes
) -> Unknowns:
    whole = np.frombuffer(node, dtype=np.int64).reshape(nodes), np.frombuffer(dof, dtype=np.int64).reshape(dofs)
    known, supported = (np.frombuffer(each, dtype=np.int64) for each in prescribed)
    return _order([Mesh(*whole)], size, known, False, Couplings(), supported)


def _order(
    blocks: Sequence[Mesh], size: int, known: np.ndarray, joined: bool, couplings: Couplings, supported: np.ndarray
) -> Unknowns:
    mask, every = np.ones(size, dtype=bool), [*blocks, *couplings.bodies]
    mask[known] = False
    order = np.arange(size)
    if joined or couplings.bodies:
        narrow = narrow_order(every, size)
        widths = [_half_width(every, _numbers(each[mask[each]], size)) for each in (narrow, order)]
        order = narrow if widths[0] < widths[1] else order
    half_width = _half_width(every, _numbers(order[mask[order]], size))
    if not joined:
        # short beams get the band width of long ones, for which there is compiled code
        half_width = max(half_width, *(int((block.dof[block.node[0]] >= 0).sum()) - 1 for block in blocks))
    if half_width > _WIDEST_BAND:
        return _sparse(blocks, size, mask, couplings)
    dofs = order[mask[order]]
    turned = towards_support(every, order, mask, supported)
    # joined nodes that share some coordinates only may be further apart then
    if turned is not None and _half_width(every, _numbers(turned, size)) <= half_width:
        dofs = turned
    banded = _banded(blocks, size, _multipliers_last(dofs, couplings.multipliers), half_width, couplings)
    return banded or _sparse(blocks, size, mask, couplings)


def _banded(
    blocks: Sequence[Mesh], size: int, dofs: np.ndarray, half_width: int, couplings: Couplings
) -> Unknowns | None:
    """Return the unknowns of a band in the order of `dofs`, None if too many are coupled beyond it."""
    free, rows = _numbers(dofs, size), len(dofs) - len(couplings.multipliers)
    coupled = [free[coordinates] for coordinates in couplings.coordinates]
    if coupled and couplings.border is None:
        return None
    fits = [_fits(numbers, half_width, rows) for numbers in coupled]
    inside = [own for own, fit in zip(coupled, fits, strict=True) if fit]
    beyond = np.unique(np.concatenate([_NONE, *(own for own, fit in zip(coupled, fits, strict=True) if not fit)]))
    if len(beyond) > (couplings.border or 0):
        return None
    none = np.empty((0, 0, 0), dtype=np.int32)
    edge = beyond[(beyond >= 0) & (beyond < rows)]
    bordering = np.concatenate([edge, np.arange(rows, len(dofs))])
    behind = len(dofs) * (2 * half_width + 1)
    places = (
        _places(own, half_width, 2 * half_width)
        if fit
        else _places(np.where(own >= 0, np.searchsorted(bordering, own), -1), behind, len(bordering))
        for own, fit in zip(coupled, fits, strict=True)
    )
    layouts = tuple(Layout(free, half_width, none) for _ in blocks)
    return Unknowns(free, dofs, layouts, None, tuple(places), edge, reaches(blocks, free, rows, inside))


def _sparse(blocks: Sequence[Mesh], size: int, unknown: np.ndarray, couplings: Couplings) -> Unknowns:
    """Return the unknowns of a sparse matrix; unknown (size,): mask of the coordinates."""
    dofs = scattered_order(blocks, size, couplings.coordinates)
    dofs = _multipliers_last(dofs[unknown[dofs]], couplings.multipliers)
    free = _numbers(dofs, size)
    coupled = [free[coordinates][None] for coordinates in couplings.coordinates]
    pattern, slots = sparsity_pattern([*(_numbers_of(block, free) for block in blocks), *coupled], len(dofs))
    layouts = tuple(Layout(free, -1, slot) for slot in slots[: len(blocks)])
    return Unknowns(free, dofs, layouts, pattern, tuple(slot[0] for slot in slots[len(blocks) :]))


def _multipliers_last(dofs: np.ndarray, multipliers: Sequence[int]) -> np.ndarray:
    last = np.isin(dofs, multipliers)
    return np.concatenate([dofs[~last], dofs[last]])


def _numbers(dofs: np.ndarray, size: int) -> np.ndarray:
    free = np.full(size, -1, dtype=np.int64)
    free[dofs] = np.arange(len(dofs))
    return free


def _numbers_of(block: Mesh, free: np.ndarray) -> np.ndarray:
    """Return the equation numbers (ne, nn npn) of each element's coordinates, -1 where there is none."""
    numbers = np.where(block.dof >= 0, free[block.dof], -1)
    return np.asarray(numbers[block.node].reshape(len(block.node), -1))


def _half_width(blocks: Sequence[Mesh], free: np.ndarray) -> int:
    """Return the largest difference between two equation numbers of an element."""
    widest = 0
    for block in blocks:
        numbers, size = np.where(block.dof >= 0, free[block.dof], -1), len(free)
        high, low = numbers.max(axis=1), np.where(numbers >= 0, numbers, size).min(axis=1)
        widths = high[block.node].max(axis=1) - low[block.node].min(axis=1)
        widest = max(widest, int(widths.max(initial=0)))
    return widest


def _fits(numbers: np.ndarray, half_width: int, rows: int) -> bool:
    """Return whether a coupling of equations (k,) fits into a band of `rows` equations."""
    unknown = numbers[numbers >= 0]
    return not len(unknown) or (int(np.ptp(unknown)) <= half_width and int(unknown.max()) < rows)


def _places(numbers: np.ndarray, first: int, width: int) -> np.ndarray:
    """Return the positions (k, k) of the entries of a coupling, the first one and a row apart, -1 where it has none."""
    row, column = numbers[:, None], numbers[None, :]
    return np.where((row >= 0) & (column >= 0), first + row * width + column, -1)


def reaches(blocks: Sequence[Mesh], free: np.ndarray, unknown: int, coupled: Sequence[np.ndarray] = ()) -> np.ndarray:
    """Return the envelope (2, unknown) of a band: the end of what an equation and those before it are coupled to.

    The second row is the same with the equations counted from the last one, in the order of the first. coupled:
    equation numbers (k,) of each coupling that is not an element, -1 for what is no unknown.
    """
    numbers = np.arange(unknown, dtype=np.int32)
    end, begin = numbers + 1, numbers.copy()
    for block in blocks:
        equations = _numbers_of(block, free)
        high, low = equations.max(axis=1), np.where(equations >= 0, equations, unknown).min(axis=1)
        mask = high >= 0
        np.maximum.at(end, low[mask], (high[mask] + 1).astype(np.int32))
        np.minimum.at(begin, high[mask], low[mask].astype(np.int32))
    for own in (each[each >= 0] for each in coupled):
        if len(own):
            end[own.min()] = max(int(end[own.min()]), int(own.max()) + 1)
            begin[own.max()] = min(int(begin[own.max()]), int(own.min()))
    first = np.minimum.accumulate(begin[::-1])[::-1]
    return np.stack([np.maximum.accumulate(end), unknown - first])
