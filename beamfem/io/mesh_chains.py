"""Chains of mesh cells, as the members of a frame that has been divided into many cells."""

import numpy as np

from beamfem.io.line_mesh import LineMesh

# a cell, and whether it is run through from its end to its start
Piece = tuple[int, bool]

_TURN = np.cos(np.radians(30.0))  # more is a corner of the frame; a circle of 13 straight cells is still smooth


def chains(mesh: LineMesh, hinged: np.ndarray) -> list[list[Piece]]:
    """Return the cells of each member, in order.

    A member continues through a node if exactly two cells meet there, both in the same sets, at an angle below 30
    degrees, and the node is not hinged (n,).
    """
    follower = _followers(mesh, hinged)
    seen = np.zeros(len(mesh.cells), dtype=bool)
    result = []
    # open chains begin at a cell that nothing leads to; what is left then are rings
    for rings in (False, True):
        for cell in range(len(mesh.cells)):
            for backwards in (False, True):
                # what precedes a piece is what follows it the other way round
                if not seen[cell] and (rings or (cell, not backwards) not in follower):
                    line = [(cell, backwards)]
                    seen[cell] = True
                    while (following := follower.get(line[-1])) is not None and not seen[following[0]]:
                        line.append(following)
                        seen[following[0]] = True
                    result.append(_forwards(line))
    return sorted(result, key=lambda line: min(cell for cell, _ in line))


def _forwards(line: list[Piece]) -> list[Piece]:
    """Return a member in the direction of most of its cells."""
    if sum(backwards for _, backwards in line) <= len(line) / 2:
        return line
    return [(cell, not backwards) for cell, backwards in reversed(line)]


def _followers(mesh: LineMesh, hinged: np.ndarray) -> dict[Piece, Piece]:
    """Return the piece that follows a piece, if any."""
    ends = mesh.cells[:, :2]
    node = ends.ravel()
    order = np.argsort(node, kind="stable")
    count = np.bincount(node, minlength=len(mesh.nodes))
    first = np.concatenate([[0], np.cumsum(count)])
    passed = np.flatnonzero((count == 2) & ~hinged)
    one, other = order[first[passed]], order[first[passed] + 1]
    outward = _outward(mesh)
    turn = -np.einsum("ni,ni->n", outward[one], outward[other])
    alike = np.ones(len(passed), dtype=bool)
    for cells in mesh.member_sets.values():
        inside = np.zeros(len(ends), dtype=bool)
        inside[cells] = True
        alike &= inside[one // 2] == inside[other // 2]
    result: dict[Piece, Piece] = {}
    for a, b in zip(one[alike & (turn > _TURN)].tolist(), other[alike & (turn > _TURN)].tolist(), strict=True):
        # a cell is left at its end if it is run forwards, and entered at its end if backwards
        result[a // 2, a % 2 == 0] = b // 2, b % 2 == 1
        result[b // 2, b % 2 == 0] = a // 2, a % 2 == 1
    return result


def _outward(mesh: LineMesh) -> np.ndarray:
    """Unit tangents (2 m, 2) out of each cell at its start and at its end."""
    start, end, middle = mesh.cells.T
    a, b = mesh.nodes[start], mesh.nodes[end]
    half = np.where((middle >= 0)[:, None], mesh.nodes[middle], 0.5 * (a + b))
    # derivatives of the parabola through the three nodes
    vectors = np.stack([3.0 * a + b - 4.0 * half, a + 3.0 * b - 4.0 * half], axis=1).reshape(-1, 2)
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
