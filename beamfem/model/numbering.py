"""Numbering of coordinates: kinematics and numbers of every node, shared at joints."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from beamfem.element.coordinates import labels
from beamfem.kernels.block import GRADIENTS, ROTATION, STRETCH, TURNED_GRADIENTS
from beamfem.model.grid import Grid
from beamfem.model.reference import reference_angle


@dataclass(frozen=True)
class Nodes:
    """Nodes of a beam: kinematics (nodes,), coordinates (nodes, npn), -1 for columns without one, frame (nodes, 3)."""

    node_kind: np.ndarray
    dof: np.ndarray
    frame: np.ndarray


def number_nodes(
    grids: Sequence[Grid],
    angled: np.ndarray,
    moving: np.ndarray,
    turning: np.ndarray,
) -> tuple[list[Nodes], int]:
    """Return the nodes of each grid and the total number of coordinates.

    angled (m, 2): (grid, node) whose rotation is prescribed or has a spring; such a node has an angle as a coordinate.
    moving, turning (n, 4): pairs (grid, node, grid, node) with a common position, and with a common rotation.
    """
    first = np.concatenate([[0], np.cumsum([grid.nodes for grid in grids])])
    owner = np.repeat(np.arange(len(grids)), np.diff(first))
    total = first[-1]
    own_code = np.array([grid.beam.element.coordinates.code for grid in grids])
    follows_slope = np.array([grid.beam.element.forces.turns_with == "r_x" for grid in grids])
    node_kind = own_code[owner]
    moves = groups(total, first, moving)
    turns = groups(total, first, turning)

    as_angle = np.zeros(total, dtype=bool)
    as_angle[first[angled[:, 0]] + angled[:, 1]] = True
    joined = np.bincount(turns, minlength=total)[turns] > 1
    # gradients that are joined with gradients only share r_y as a vector; all others share an angle
    plain = (node_kind == GRADIENTS) & ~follows_slope[owner] & ~as_angle
    all_plain = np.bincount(turns, weights=~plain, minlength=total)[turns] == 0
    angle = as_angle | (joined & ~all_plain)
    angle = np.bincount(turns, weights=angle, minlength=total)[turns] > 0
    sloped = angle & follows_slope[owner] & ((node_kind == GRADIENTS) | (node_kind == ROTATION))
    node_kind = np.where(sloped, STRETCH, np.where(angle & (node_kind == GRADIENTS), ROTATION, node_kind))

    leader_moves, leader_turns = first_of_group(moves), first_of_group(turns)
    turned = joined & all_plain & (leader_turns != np.arange(total))
    node_kind = np.where(turned, TURNED_GRADIENTS, node_kind)

    width = max(2 * len(grid.beam.element.field.vectors) for grid in grids)
    own, last, turn_size = _ownership(grids, owner, node_kind, width)
    follower_moves, follower_turns = leader_moves != np.arange(total), leader_turns != np.arange(total)
    own[follower_moves, :2] = False
    for offset in (1, 2):
        rows = np.flatnonzero(follower_turns & (turn_size >= offset))
        own[rows, last[rows] - offset + 1] = False
    dof = np.where(own, np.cumsum(own).reshape(own.shape) - 1, -1)
    dof[follower_moves, :2] = dof[leader_moves[follower_moves], :2]
    for offset in (1, 2):
        rows = np.flatnonzero(follower_turns & (turn_size >= offset))
        leaders = leader_turns[rows]
        dof[rows, last[rows] - offset + 1] = dof[leaders, last[leaders] - offset + 1]

    frame = _frames(grids, node_kind, leader_turns)
    dof = np.ascontiguousarray(dof[:, : last.max() + 1])
    widest = (np.maximum.reduceat(last, first[:-1]) + 1).tolist()
    nodes = [
        Nodes(node_kind[begin:end], dof[begin:end, :columns], frame[begin:end])
        for (begin, end), columns in zip(pairwise(first.tolist()), widest, strict=True)
    ]
    return nodes, int(own.sum())


def groups(total: int, first: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Number of the group (total,) that each node belongs to."""
    if not len(pairs):
        return np.arange(total)
    a, b = first[pairs[:, 0]] + pairs[:, 1], first[pairs[:, 2]] + pairs[:, 3]
    return connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(total, total)), directed=False)[1]


def first_of_group(group: np.ndarray) -> np.ndarray:
    """First node (total,) of the group of each node."""
    leader = np.full(group.max() + 1, len(group))
    np.minimum.at(leader, group, np.arange(len(group)))
    return leader[group]


def _ownership(
    grids: Sequence[Grid], owner: np.ndarray, node_kind: np.ndarray, width: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return which columns a node has (total, width), its last column and how many columns its rotation takes."""
    own = np.zeros((len(owner), width), dtype=bool)
    last, turn_size = np.empty(len(owner), dtype=np.int64), np.empty(len(owner), dtype=np.int64)
    vectors = [grid.beam.element.field.vectors for grid in grids]
    has_slope = np.array([len(names) == 3 for names in vectors])[owner]
    for slope, names in ((False, ("r", "r_y")), (True, ("r", "r_x", "r_y"))):
        for code in range(TURNED_GRADIENTS + 1):
            rows = (has_slope == slope) & (node_kind == code)
            if not rows.any():
                continue
            own_names = labels(code, names)
            own[rows, : len(own_names)] = True
            last[rows] = len(own_names) - 1
            turn_size[rows] = 1 if own_names[-1] == "theta" else 2
    return own, last, turn_size


def _frames(grids: Sequence[Grid], node_kind: np.ndarray, leader: np.ndarray) -> np.ndarray:
    """Cosine and sine of each node's reference angle, for turned gradients relative to their leader's; and |r_x|."""
    angle = np.concatenate([reference_angle(grid) for grid in grids])
    tangent = np.concatenate([grid.tangent for grid in grids])
    frame = np.ones((len(angle), 3))
    frame[:, :2] = tangent
    frame[:, 2] = np.concatenate([grid.speed for grid in grids])
    turned = node_kind == TURNED_GRADIENTS
    between = angle[turned] - angle[leader[turned]]
    frame[turned, 0], frame[turned, 1] = np.cos(between), np.sin(between)
    return frame
