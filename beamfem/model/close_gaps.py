"""Joined nodes: gaps due to rounding are closed in the stress-free reference."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from beamfem.model.beam_grid import Grid
from beamfem.model.numbering import first_of_group, groups

_ROUND_OFF = 16 * np.finfo(float).eps


def close_gaps(grids: Sequence[Grid], moving: np.ndarray) -> list[Grid]:
    """Return the grids with joined nodes moved to the position of the first of them.

    moving (n, 4): pairs (grid, node, grid, node). Otherwise a solve would strain the element at a gap.
    """
    if not len(moving):
        return list(grids)
    first = np.concatenate([[0], np.cumsum([grid.nodes for grid in grids])])
    position = np.concatenate([grid.position for grid in grids])
    one, other = first[moving[:, 0]] + moving[:, 1], first[moving[:, 2]] + moving[:, 3]
    apart = np.abs(position[one] - position[other]).max(axis=1)
    if not (apart > _ROUND_OFF * np.abs(position).max()).any():
        return list(grids)
    leader = first_of_group(groups(first[-1], first, moving))
    off = np.abs(position - position[leader]).max(axis=1) > _ROUND_OFF * np.abs(position).max()
    closed = np.where(off[:, None], position[leader], position)
    return [
        replace(grid, position=closed[begin:end], moved=True) if off[begin:end].any() else grid
        for grid, begin, end in zip(grids, first[:-1], first[1:], strict=True)
    ]
