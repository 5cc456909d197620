"""Orders of coordinates: for a narrow band, towards a support, and for low fill-in of a sparse matrix."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, eye_array
from scipy.sparse.csgraph import laplacian, reverse_cuthill_mckee
from scipy.sparse.linalg import spilu


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
