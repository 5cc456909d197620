"""Numbering of coordinates: kinematics and numbers of every node, shared at joints."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from beamfem.element.coordinates import labels
from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS, ROTATION, STRETCH
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.reference import reference_angle

Pairs = Sequence[tuple[int, ...]]
_FEW = 2000  # nodes; the numbering of larger models is not cached


class Nodes(NamedTuple):
    """Nodes of a beam: kind (nodes,), coordinates (nodes, npn), -1 where there is none, and frame (nodes, 3).

    frame: cosine and sine of the reference angle, and |r_x|; see `kernels.block.Block`.
    """

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

    angled (m, 2): (grid, node) whose rotation is prescribed, has a spring or is that of a connector; such a node has an
    angle as a coordinate.
    moving, turning (n, 4): pairs (grid, node, grid, node) with a common position, and with a common rotation.
    """
    kinds = tuple(
        NodeKinds(element.coordinates.code, element.forces.turns_with == "r_x", element.field.vectors, grid.nodes)
        for element, grid in ((grid.beam.element, grid) for grid in grids)
    )
    pairs = tuple(map(tuple, moving.tolist())), tuple(map(tuple, turning.tolist()))
    number = _number if sum(kind.nodes for kind in kinds) > _FEW else _cached_number
    numbered = number(kinds, tuple(map(tuple, angled.tolist())), *pairs)
    frame = _frames(grids, numbered)
    nodes = [
        Nodes(numbered.node_kind[begin:end], numbered.dof[begin:end, :columns], frame[begin:end])
        for begin, end, columns in numbered.parts
    ]
    return nodes, numbered.size


class NodeKinds(NamedTuple):
    """Data of a grid that determine its numbering.

    code: kind of the nodal coordinates; follows_slope: whether sections rotate with r_x; vectors: names of the nodal
    vectors; nodes: number of nodes.
    """

    code: int
    follows_slope: bool
    vectors: tuple[str, ...]
    nodes: int


@dataclass(frozen=True)
class Numbered:
    """Nodes of all grids: kind (total,), coordinates (total, npn), and the node (total,) that each rotates with.

    turned (k,): the nodes whose r_y is that of another one, rotated by the angle between them; parts: begin and end of
    the nodes of each grid, and its number of columns; size: number of coordinates.
    """

    node_kind: np.ndarray
    dof: np.ndarray
    turns_with: np.ndarray
    turned: np.ndarray
    parts: tuple[tuple[int, int, int], ...]
    size: int


def _number(kinds: Sequence[NodeKinds], angled: Pairs, moving: Pairs, turning: Pairs) -> Numbered:
    """Number the coordinates of grids; see `number_nodes`."""
    first = np.concatenate([[0], np.cumsum([kind.nodes for kind in kinds])])
    owner = np.repeat(np.arange(len(kinds)), np.diff(first))
    total = first[-1]
    own_code = np.array([kind.code for kind in kinds])
    follows_slope = np.array([kind.follows_slope for kind in kinds])
    node_kind = own_code[owner]
    moves = groups(total, first, np.array(moving, dtype=np.int64).reshape(-1, 4))
    turns = groups(total, first, np.array(turning, dtype=np.int64).reshape(-1, 4))

    as_angle = np.zeros(total, dtype=bool)
    grid_of, node_of = np.array(angled, dtype=np.int64).reshape(-1, 2).T
    as_angle[first[grid_of] + node_of] = True
    joined = np.bincount(turns, minlength=total)[turns] > 1
    # if all joined nodes have gradients, they share the vector r_y; otherwise they share an angle
    plain = (node_kind == GRADIENTS) & ~follows_slope[owner] & ~as_angle
    all_plain = np.bincount(turns, weights=~plain, minlength=total)[turns] == 0
    angle = as_angle | (joined & ~all_plain)
    angle = np.bincount(turns, weights=angle, minlength=total)[turns] > 0
    sloped = angle & follows_slope[owner] & ((node_kind == GRADIENTS) | (node_kind == ROTATION))
    node_kind = np.where(sloped, STRETCH, np.where(angle & (node_kind == GRADIENTS), ROTATION, node_kind))

    leader_moves, leader_turns = first_of_group(moves), first_of_group(turns)
    turned = joined & all_plain & (leader_turns != np.arange(total))
    node_kind = np.where(turned, ROTATED_GRADIENTS, node_kind)

    owned, last, turn_size = _ownership(kinds, owner, node_kind)
    follower_moves, follower_turns = leader_moves != np.arange(total), leader_turns != np.arange(total)
    owned[follower_moves, :2] = False
    for offset in (1, 2):
        rows = np.flatnonzero(follower_turns & (turn_size >= offset))
        owned[rows, last[rows] - offset + 1] = False
    dof = np.where(owned, np.cumsum(owned).reshape(owned.shape) - 1, -1)
    dof[follower_moves, :2] = dof[leader_moves[follower_moves], :2]
    for offset in (1, 2):
        rows = np.flatnonzero(follower_turns & (turn_size >= offset))
        leaders = leader_turns[rows]
        dof[rows, last[rows] - offset + 1] = dof[leaders, last[leaders] - offset + 1]

    dof = np.ascontiguousarray(dof[:, : last.max() + 1])
    widest = (np.maximum.reduceat(last, first[:-1]) + 1).tolist()
    parts = tuple((*ends, columns) for ends, columns in zip(pairwise(first.tolist()), widest, strict=True))
    for values in (node_kind, dof, leader_turns):
        values.setflags(write=False)  # models with the same numbering share them
    turned_nodes = np.flatnonzero(node_kind == ROTATED_GRADIENTS)
    return Numbered(node_kind, dof, leader_turns, turned_nodes, parts, int(owned.sum()))


_cached_number = lru_cache(maxsize=64)(_number)  # studies repeatedly make models with the same numbering


def groups(total: int, first: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Return the number of the group (total,) that each node belongs to."""
    if not len(pairs):
        return np.arange(total)
    a, b = first[pairs[:, 0]] + pairs[:, 1], first[pairs[:, 2]] + pairs[:, 3]
    return connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(total, total)), directed=False)[1]


def first_of_group(group: np.ndarray) -> np.ndarray:
    """Return the first node (total,) of the group of each node."""
    leader = np.full(group.max() + 1, len(group))
    np.minimum.at(leader, group, np.arange(len(group)))
    return leader[group]


def _ownership(
    kinds: Sequence[NodeKinds], owner: np.ndarray, node_kind: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the mask of the columns of each node (total, width), its last column, and the number for its rotation."""
    owned = np.zeros((len(owner), max(2 * len(kind.vectors) for kind in kinds)), dtype=bool)
    last, turn_size = np.empty(len(owner), dtype=np.int64), np.empty(len(owner), dtype=np.int64)
    has_slope = np.array([len(kind.vectors) == 3 for kind in kinds])[owner]
    for slope, names in ((False, ("r", "r_y")), (True, ("r", "r_x", "r_y"))):
        for code in range(ROTATED_GRADIENTS + 1):
            rows = (has_slope == slope) & (node_kind == code)
            if not rows.any():
                continue
            own_names = labels(code, names)
            owned[rows, : len(own_names)] = True
            last[rows] = len(own_names) - 1
            turn_size[rows] = 1 if own_names[-1] == "theta" else 2
    return owned, last, turn_size


def _frames(grids: Sequence[Grid], numbered: Numbered) -> np.ndarray:
    """Return cosine and sine of the reference angle, and |r_x|, of each node (total, 3).

    For rotated gradients, the angle is relative to that of the node whose r_y they share.
    """
    turned, leader = numbered.turned, numbered.turns_with
    frame = np.empty((len(leader), 3))
    frame[:, :2] = np.concatenate([grid.tangent for grid in grids])
    frame[:, 2] = np.concatenate([grid.speed for grid in grids])
    if not len(turned):
        return frame
    angle = np.concatenate([reference_angle(grid) for grid in grids])
    between = angle[turned] - angle[leader[turned]]
    frame[turned, 0], frame[turned, 1] = np.cos(between), np.sin(between)
    return frame
