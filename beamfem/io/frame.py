"""Beams along the lines of a mesh, or along chains of them, and the joints where they share nodes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from beamfem.curves import BSpline, Chain, Curve, Line, Polyline
from beamfem.errors import InputError
from beamfem.io.line_mesh import LineMesh
from beamfem.model.beam import Beam, Point
from beamfem.model.joint_base import Joint
from beamfem.parts.hinge import Hinge
from beamfem.parts.rigid import Rigid
from beamfem.reprs import brief
from beamfem.validation import count, items, one_of, require_known, shown, vector

Members = Literal["cells", "chains"]
_STRAIGHT = 1e-9  # of a chord: a smaller rise of the middle node is round-off
_COLLINEAR = 1e-9  # [rad]
_TURN = np.cos(np.radians(30.0))  # more is a corner of the frame; a circle of 13 straight cells is still smooth
Piece = tuple[int, bool]  # a cell, and whether it is run through from its end to its start


@dataclass(frozen=True, eq=False)
class Frame:
    """Beams along the lines of a mesh and the joints between them, for a `Model`.

    Parameters
    ----------
    beams : tuple of Beam
        The beams.
    joints : tuple of Joint
        The joints between beams that share a node.
    mesh : LineMesh
        The mesh.
    owner : array of int, (cells,)
        Number of the beam of each cell.
    places : tuple of tuple of Point
        Points of the beams at each node, empty at the middle of a line3.

    Examples
    --------
    >>> lines = bf.LineMesh([(0, 0), (0, 3), (4, 3)], [(0, 1, -1), (1, 2, -1)], {}, {})
    >>> frame = lines.frame(4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> len(frame.beams), len(frame.joints)
    (2, 1)
    """

    beams: tuple[Beam, ...]
    joints: tuple[Joint, ...]
    mesh: LineMesh
    owner: np.ndarray
    places: tuple[tuple[Point, ...], ...]

    __repr__ = brief

    def members(self, name: str) -> tuple[Beam, ...]:
        """Return the beams of a member set. Raises InputError for an unknown name."""
        numbers = np.unique(self.owner[_named(self.mesh.member_sets, "member", name)])
        return tuple(self.beams[number] for number in numbers)

    def points(self, name: str) -> tuple[Point, ...]:
        """Return a point at each node of a point set, on the first of the beams there.

        Raises InputError for an unknown name, or a point of the set at which no line ends.
        """
        nodes = _named(self.mesh.point_sets, "point", name)
        if np.any(nodes < 0) or not all(self.places[node] for node in nodes):
            raise InputError(f"point set {name!r} has a point at which no line ends")
        return tuple(self.places[node][0] for node in nodes)

    def at(self, x: float, y: float) -> Point:
        """Return the point at the node at a position [m], on the first of the beams there.

        Raises InputError if no line ends there.
        """
        position = np.array(vector("point", (x, y)))
        nodes = np.array([node for node, points in enumerate(self.places) if points])
        distance = np.linalg.norm(self.mesh.nodes[nodes] - position, axis=1)
        nearest = nodes[int(np.argmin(distance))]
        if distance.min() > 1e-6 * float(np.max(np.ptp(self.mesh.nodes, axis=0))):
            near = self.mesh.nodes[nearest]
            raise InputError(f"no line ends at ({x:g}, {y:g}); the nearest end is at ({near[0]:g}, {near[1]:g})")
        return self.places[nearest][0]


def build_frame(
    mesh: LineMesh,
    elements: Any,
    element: Any,
    section: Any,
    material: Any,
    members: Members,
    hinges: str | Sequence[str],
    damping: Any = None,
) -> Frame:
    """Return the frame of a mesh; see `LineMesh.frame`."""
    one_of("members", members, ("cells", "chains"))
    hinged = np.zeros(len(mesh.nodes), dtype=bool)
    for hinge in (hinges,) if isinstance(hinges, str) else items("hinges", hinges):
        nodes = _named(mesh.point_sets, "point", hinge)
        hinged[nodes[nodes >= 0]] = True
    given = {"elements": elements, "element": element, "section": section, "material": material, "damping": damping}
    by_cell = {what: _each(mesh, what, value) for what, value in given.items()}
    lines = [[(cell, False)] for cell in range(len(mesh.cells))] if members == "cells" else _chains(mesh, hinged)
    owner = np.empty(len(mesh.cells), dtype=np.int64)
    places: list[list[Point]] = [[] for _ in mesh.nodes]
    points, cells = [(x, y) for x, y in mesh.nodes.tolist()], mesh.cells.tolist()
    beams = []
    for number, line in enumerate(lines):
        first = line[0][0]
        arguments = {what: values[first] for what, values in by_cell.items()}
        curve, ends = _axis([_curve(points, cells, piece) for piece in line])
        parts = count("elements", arguments.pop("elements"))
        inner = np.linspace(ends[:-1], ends[1:], parts, endpoint=False, axis=1) if len(line) > 1 else None
        beam = Beam(curve, parts if inner is None else (*inner.ravel().tolist(), 1.0), **arguments)
        beams.append(beam)
        owner[[cell for cell, _ in line]] = number
        for (cell, backwards), fraction in zip(line, ends.tolist(), strict=False):
            places[cells[cell][1 if backwards else 0]].append(Point(beam, fraction))
        cell, backwards = line[-1]
        places[cells[cell][0 if backwards else 1]].append(Point(beam, 1.0))
    joints = tuple(
        (Hinge if hinged[node] else Rigid)(at_node[0], other)
        for node, at_node in enumerate(places)
        for other in at_node[1:]
    )
    return Frame(tuple(beams), joints, mesh, owner, tuple(tuple(at_node) for at_node in places))


def _named(sets: Mapping[str, np.ndarray], kind: str, name: str) -> np.ndarray:
    require_known(f"the mesh has no {kind} set {shown(name)}", name, sets)
    return sets[name]


def _each(mesh: LineMesh, what: str, value: Any) -> Sequence[Any]:
    """Return the value for each cell, given for all cells or by member set. Raises InputError."""
    if not isinstance(value, Mapping):
        return [value] * len(mesh.cells)
    source = np.full(len(mesh.cells), -1)
    for number, name in enumerate(value):
        cells = _named(mesh.member_sets, "member", name)
        twice = cells[source[cells] >= 0]
        if len(twice):
            other = list(value)[source[twice[0]]]
            raise InputError(f"{what}: line {twice[0]} (counted from 0) is in {other!r} and in {name!r}; give it once")
        source[cells] = number
    missing = np.flatnonzero(source < 0)
    if len(missing):
        x, y = mesh.nodes[mesh.cells[missing[0], :2]].mean(axis=0)
        raise InputError(
            f"{what}: {len(missing)} line(s) are in none of {list(value)}, such as the one at ({x:g}, {y:g})"
        )
    choices = list(value.values())
    return [choices[number] for number in source]


def _curve(points: Sequence[tuple[float, float]], cells: Sequence[Sequence[int]], piece: Piece) -> Curve:
    """Return the axis of a cell, reversed if the cell is traversed backwards."""
    cell, backwards = piece
    start, end, middle = cells[cell]
    first, last = (points[end], points[start]) if backwards else (points[start], points[end])
    if middle < 0:
        return Line(first, last)
    a, b, between = np.array([first, last, points[middle]])
    chord, inner = b - a, between - a
    fraction = inner @ chord / (chord @ chord)
    if abs(inner[0] * chord[1] - inner[1] * chord[0]) <= _STRAIGHT * (chord @ chord):
        if not 0.25 < fraction < 0.75:
            raise InputError(
                f"line {cell} (counted from 0) turns back: its middle node stands at {fraction:g} of the way between "
                "its ends and must be between 0.25 and 0.75"
            )
        return Line(first, last)
    control = 2.0 * between - 0.5 * (a + b)
    return BSpline(2, (0.0, 0.0, 0.0, 1.0, 1.0, 1.0), (first, tuple(control.tolist()), last))


def _axis(curves: list[Curve]) -> tuple[Curve, np.ndarray]:
    """Return one axis through successive curves, and the fractions of its length at which they end."""
    if len(curves) == 1:
        return curves[0], np.array([0.0, 1.0])
    reach = np.concatenate([[0.0], np.cumsum([curve.length for curve in curves])])
    ends = reach / reach[-1]
    straight = [curve for curve in curves if isinstance(curve, Line)]
    if len(straight) < len(curves):
        return Chain(tuple(curves)), ends
    points = (straight[0].start, *(line.end for line in straight))
    if points[0] == points[-1]:
        return Polyline(points), ends
    way = np.diff(np.array(points), axis=0)
    whole = way.sum(axis=0)
    off = np.abs(way[:, 0] * whole[1] - way[:, 1] * whole[0])
    if np.all(off <= _COLLINEAR * np.linalg.norm(way, axis=1) * np.linalg.norm(whole)):
        return Line(points[0], points[-1]), ends
    return Polyline(points), ends


def _chains(mesh: LineMesh, hinged: np.ndarray) -> list[list[Piece]]:
    """Return the cells of each member, in order and in the direction of most of them.

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
                    if sum(backwards for _, backwards in line) > len(line) / 2:
                        line = [(cell, not backwards) for cell, backwards in reversed(line)]
                    result.append(line)
    return sorted(result, key=lambda line: min(cell for cell, _ in line))


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
