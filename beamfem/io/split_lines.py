"""Lines of a mesh that end inside another line: the straight one is divided there, so that the two are joined."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from beamfem.errors import InputError, NotJoinedWarning, warn


def merged(nodes: np.ndarray, ends: np.ndarray, near: float) -> np.ndarray:
    """Return for each node (n,) the first of the ends that are within `near` [m] of it, or itself."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree  # slow to import

    a, b = ends[cKDTree(nodes[ends]).query_pairs(near, output_type="ndarray")].reshape(-1, 2).T
    together = coo_array((np.ones(len(a)), (a, b)), shape=(len(nodes), len(nodes)))
    _, group = connected_components(together, directed=False)
    _, first = np.unique(group, return_index=True)
    return np.asarray(first[group])


def divided(nodes: np.ndarray, cells: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells (m, 3) with straight lines divided where others end on them, and which cell each is a part of.

    near [m]: how far from a line an end may be to lie on it. Raises InputError if a line ends inside a line3.
    """
    cell, node, fraction = _touches(nodes, cells, near)
    curved = np.flatnonzero(cells[cell, 2] >= 0)
    if len(curved):
        x, y = nodes[node[curved[0]]]
        raise InputError(
            f"a line ends inside line {cell[curved[0]]}, a line3, at ({x:g}, {y:g}); split the line3 there"
        )
    if not len(cell):
        return cells, np.arange(len(cells))
    rows, owner = [], []
    order = np.lexsort((fraction, cell))
    inside = np.split(node[order], np.searchsorted(cell[order], np.arange(1, len(cells))))
    for number, (row, between) in enumerate(zip(cells, inside, strict=True)):
        stops = [row[0], *between, row[1]]
        rows += [(a, b, row[2]) for a, b in pairwise(stops)]
        owner += [number] * (len(stops) - 1)
    return np.array(rows, dtype=np.int64), np.array(owner)


def parts_of(sets: Mapping[str, np.ndarray], owner: np.ndarray) -> dict[str, np.ndarray]:
    """Return sets of cells as sets of the parts that they have been divided into."""
    return {name: np.flatnonzero(np.isin(owner, cells)) for name, cells in sets.items()}


def warn_of_gaps(nodes: np.ndarray, cells: np.ndarray, reach: float) -> None:
    """Warn of ends that stand within `reach` [m] of another end or line and are not joined to it."""
    from scipy.spatial import cKDTree  # slow to import

    ends = np.unique(cells[:, :2])
    pairs = ends[cKDTree(nodes[ends]).query_pairs(reach, output_type="ndarray")]
    _, touching, _ = _touches(nodes, cells, reach)
    loose = np.unique(np.concatenate([pairs[:, 0], touching]))
    if not len(loose):
        return
    x, y = nodes[loose[0]]
    others = f" (and {len(loose) - 1} more)" if len(loose) > 1 else ""
    warn(
        f"the end at ({x:g}, {y:g}){others} is within {reach:.2g} of another line but not joined to it: nothing is "
        "carried over the gap. Where they shall be joined, let them meet",
        NotJoinedWarning,
    )


def _touches(nodes: np.ndarray, cells: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return cell, node and fraction of the way (n,) of ends that lie on a line between its own ends."""
    from scipy.spatial import cKDTree  # slow to import

    ends = np.unique(cells[:, :2])
    start, end = nodes[cells[:, 0]], nodes[cells[:, 1]]
    chord = end - start
    length = np.linalg.norm(chord, axis=1)
    # a parabola is nowhere further from its chord than its middle node
    middle = np.where(cells[:, 2] >= 0, cells[:, 2], cells[:, 0])
    rise = np.abs(_cross(chord, nodes[middle] - start)) / length
    within = cKDTree(nodes[ends]).query_ball_point(0.5 * (start + end), 0.5 * length + rise + near)
    cell = np.repeat(np.arange(len(cells)), [len(hits) for hits in within])
    node = ends[np.concatenate(within).astype(np.int64)]
    at_end = (node == cells[cell, 0]) | (node == cells[cell, 1])
    cell, node = cell[~at_end], node[~at_end]
    away = nodes[node] - start[cell]
    fraction = np.einsum("ni,ni->n", away, chord[cell]) / length[cell] ** 2
    off = _cross(chord[cell], away) / length[cell]
    bow = _cross(chord, nodes[middle] - start)[cell] / length[cell] * 4.0 * fraction * (1.0 - fraction)
    on = (np.abs(off - bow) <= near) & (fraction > 0.0) & (fraction < 1.0)
    return cell[on], node[on], fraction[on]


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
