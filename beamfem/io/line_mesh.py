"""Line meshes: members between nodes, named sets of both, from the files that mesh generators write.

A straight line on which others end is divided there, so that they are joined.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.atomic_write import readable
from beamfem.curves.curve import GAP
from beamfem.damping import Damping
from beamfem.element.element import Element
from beamfem.element.fields import cross
from beamfem.errors import InputError, NotJoinedWarning, warn
from beamfem.io.mesh_files import MeshFile, read_abaqus, read_through_meshio
from beamfem.material import Material
from beamfem.reprs import brief
from beamfem.validation import LARGEST, flag, items, number_table, shown, text

if TYPE_CHECKING:
    from beamfem.io.frame import Frame, Members


# distance from the plane z = 0 and length of a line that count as none, as a fraction of the size of the mesh
_SAME = 1e-9
_SHORT = 1e-2  # of the shortest line: nodes further apart than this are two
_GAPS = 30.0  # times the distance that is closed: wider gaps are meant

_NODES = {"vertex": 1, "line": 2, "line3": 3}


@dataclass(frozen=True, eq=False)
class LineMesh:
    """Lines that share nodes, and named sets of them.

    Raises InputError for numbers that do not fit together.

    Parameters
    ----------
    nodes : array_like, [m], (n, 2)
        Positions of the nodes.
    cells : array_like of int, (m, 3)
        Nodes at the start, at the end and, of a quadratic line3, in the middle (parameter 1/2), else -1.
    member_sets : mapping
        Cells of each set by name.
    point_sets : mapping
        Nodes of each set by name.

    Examples
    --------
    >>> lines = bf.LineMesh([(0, 0), (0, 3), (4, 3)], [(0, 1, -1), (1, 2, -1)], {"post": [0]}, {"foot": [0]})
    >>> frame = lines.frame(4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> frame.points("foot")[0].reference
    array([0., 0.])
    """

    nodes: Any
    cells: Any
    member_sets: Mapping[str, Any]
    point_sets: Mapping[str, Any]

    __repr__ = brief

    def __post_init__(self) -> None:
        nodes = number_table("nodes of LineMesh", self.nodes, 2)
        cells = number_table("cells of LineMesh", self.cells, 3)
        object.__setattr__(self, "nodes", nodes.astype(float))
        ends = _numbers_below("ends of cells of LineMesh", cells[:, :2], len(nodes), 0)
        middle = _numbers_below("middles of cells of LineMesh", cells[:, 2:], len(nodes), -1)
        object.__setattr__(self, "cells", np.hstack([ends, middle]))
        for name, size, lowest in (("member_sets", len(cells), 0), ("point_sets", len(nodes), -1)):
            sets = getattr(self, name)
            if not isinstance(sets, Mapping):
                raise InputError(f"{name} of LineMesh must be a mapping from names to numbers, got {shown(sets)}")
            checked = {}
            for key, values in sets.items():
                what = f"{name}[{text(f'a name in {name} of LineMesh', key)!r}] of LineMesh"
                numbers = np.array(items(what, values))
                if numbers.ndim != 1:
                    raise InputError(f"{what} must be a list of whole numbers, got {shown(values)}")
                checked[key] = _numbers_below(what, numbers, size, lowest)
            object.__setattr__(self, name, checked)

    def frame(
        self,
        elements: int | Mapping[str, int],
        element: Element | Mapping[str, Element],
        section: Any,
        material: Material | Mapping[str, Material] | None = None,
        members: "Members" = "cells",
        hinges: str | Sequence[str] = (),
        damping: Damping | Mapping[str, Damping] | None = None,
    ) -> "Frame":
        """Return beams along the lines and the joints between those that share a node.

        elements: finite elements per cell; element, section, material, damping: see `Beam`. Each of the five may be a
        mapping from names of member sets, which together must name each cell once. members: "cells" makes each cell a
        beam; "chains" joins cells that follow each other between branches, hinges, turns of 30 degrees or more and
        changes of their sets into one beam. Members that share a node are joined rigidly, except at the point sets
        `hinges`, where they rotate freely against each other. Raises InputError for an unknown name, or a cell that is
        named never or twice.

        Examples
        --------
        >>> lines = bf.LineMesh([(0, 0), (0, 3), (4, 3)], [(0, 1, -1), (1, 2, -1)], {}, {"corner": [1]})
        >>> frame = lines.frame(4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel, hinges="corner")
        >>> type(frame.joints[0]).__name__
        'Hinge'
        """

        from beamfem.io.frame import build_frame

        return build_frame(self, elements, element, section, material, members, hinges, damping)


def read_mesh(path: str | PathLike[str], *, merge: bool = False) -> LineMesh:
    """Return the lines of a mesh file, in its units.

    It reads Gmsh .msh (physical groups of curves and points become sets, named by number if they have no name), Abaqus
    and CalculiX .inp (beams and trusses, elsets and nsets), VTU, XDMF and every other format of meshio. Integer data on
    cells or points, as in VTU and XDMF, become sets too: `name` where they are not zero, `name=k` where they are k. The
    centrelines that `Solution.to_vtk` writes have the sets `beam=k`, `material=k` and `section=k` only.

    A line that ends inside a straight line (within 1e-5 of the size of the mesh) divides it into two cells that share
    this node.

    Parameters
    ----------
    path : path
        The mesh file.
    merge : bool, default False
        Whether ends of lines at one place become one node, as needed for the centrelines that `to_vtk` writes, whose
        elements share no points.

    Raises
    ------
    FileError
        If the system refuses to read the file; FileNotFoundError if there is none.
    InputError
        For a file that cannot be read or holds no lines, cells of another kind, nodes off the plane z = 0, lines of no
        length or given twice, lines that end inside a line3, and, without merge, nodes at one place, to 1e-5 of the
        size of the mesh and a hundredth of the shortest line.

    Warns
    -----
    NotJoinedWarning
        Names ends that are within 30 times that distance of another line and are not joined to it.
    NotReadWarning
        Names what else an .inp file holds: sections, materials, supports, loads.

    Examples
    --------
    >>> mesh = bf.read_mesh("frame.inp")  # doctest: +SKIP
    >>> frame = mesh.frame(8, bf.CRBF(order=3), bf.Tube(0.05, 0.002), steel)  # doctest: +SKIP
    """
    flag("merge", merge)
    source = readable(path)
    content = read_abaqus(source) if source.suffix.lower() == ".inp" else read_through_meshio(source)
    try:
        return line_mesh(content, merge)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def line_mesh(content: MeshFile, merge: bool) -> LineMesh:
    _refuse_other_cells(content)
    tables, numbers = [np.empty((0, 3), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    vertices: dict[int, int] = {}
    counted = 0
    for kind, table in content.blocks:
        if table.ndim != 2 or table.shape[1] != _NODES[kind]:
            columns = table.shape[1] if table.ndim == 2 else table.shape
            raise InputError(
                f"a {kind} has {_NODES[kind]} nodes, here {columns}: damaged, or an ASCII file: save it as a binary one"
            )
        if kind == "vertex":
            vertices.update(zip(range(counted, counted + len(table)), table[:, 0].tolist(), strict=True))
        else:
            middle = table[:, 2:] if kind == "line3" else np.full((len(table), 1), -1)
            tables.append(np.hstack([table[:, :2], middle]).astype(np.int64))
            numbers.append(np.arange(counted, counted + len(table)))
        counted += len(table)
    cells, number = np.concatenate(tables), np.concatenate(numbers)
    if not len(cells):
        raise InputError("there are no lines in it")
    _numbers_below("it is damaged: nodes of its lines", cells, len(content.points), -1)
    for name, chosen in content.point_sets.items():
        _numbers_below(f"it is damaged: nodes of its set {name}", chosen, len(content.points), 0)
    used = np.unique(cells[cells >= 0])
    points = content.points[used]
    node_of = np.full(len(content.points) + 1, -1)
    node_of[used] = np.arange(len(used))
    cells = node_of[cells]  # the last entry keeps -1
    size = float(np.max(np.ptp(points, axis=0)))
    _check_nodes(points, size)
    nodes = points[:, :2].copy()
    near = _distance(nodes, cells, size)
    if merge:
        first = merged(nodes, np.unique(cells[:, :2]), near)
        kept, number_of = np.unique(first, return_inverse=True)
        nodes, cells = nodes[kept], np.append(number_of, -1)[cells]
        node_of[used] = number_of
    _check_ends(nodes, cells, near)
    parts, owner = divided(nodes, cells, near)
    warn_of_gaps(nodes, parts, _GAPS * near)
    _refuse_repeated(nodes, parts, owner, size)
    member = np.full(counted, -1)
    member[number] = np.arange(len(number))
    member_sets, point_sets = {}, {}
    for name, chosen in content.cell_sets.items():
        lines = member[chosen]
        if np.any(lines >= 0):
            member_sets[name] = lines[lines >= 0]
        set_points = np.array([vertices[i] for i in chosen.tolist() if i in vertices], dtype=np.int64)
        if len(set_points):
            point_sets[name] = np.unique(node_of[set_points])
    for name, chosen in content.point_sets.items():
        point_sets[name] = np.unique(node_of[chosen])
    member_sets = {name: np.flatnonzero(np.isin(owner, lines)) for name, lines in member_sets.items()}
    return LineMesh(nodes, parts, member_sets, point_sets)


def _refuse_other_cells(content: MeshFile) -> None:
    others: dict[str, int] = {}
    for kind, table in content.blocks:
        if kind not in ("line", "line3", "vertex") and len(table):
            others[kind] = others.get(kind, 0) + len(table)
    if others:
        named = ", ".join(f"{count} {kind}" for kind, count in others.items())
        raise InputError(
            f"it holds cells that are no line or line3: {named}; save only the lines, of order 1 or 2 "
            "(in Gmsh, put only curves and points into physical groups)"
        )


def _check_nodes(points: np.ndarray, size: float) -> None:
    if not np.isfinite(points).all():
        raise InputError("it has a node whose coordinates are not finite")
    if size > LARGEST:
        raise InputError(f"its nodes are {size:g} apart, beyond what double precision can square ({LARGEST:.1g})")
    height = np.abs(points[:, 2:]).max(axis=1, initial=0.0)
    if np.any(height > _SAME * size):
        x, y, z = points[int(np.argmax(height))]
        count = int((height > _SAME * size).sum())
        raise InputError(f"beams lie in the plane z = 0, but {count} node(s) do not, such as ({x:g}, {y:g}, {z:g})")


def _distance(nodes: np.ndarray, cells: np.ndarray, size: float) -> float:
    """Return the distance [m] below which places are the same. Raises InputError for lines of no length."""
    chord = np.linalg.norm(nodes[cells[:, 1]] - nodes[cells[:, 0]], axis=1)
    short = np.flatnonzero(chord <= _SAME * size)
    if len(short):
        raise InputError(
            f"line {short[0]} (counted from 0) has no length, both ends are at {_at(nodes, cells[short[0], 0])}"
        )
    return min(GAP * size, _SHORT * float(chord.min()))


def _check_ends(nodes: np.ndarray, cells: np.ndarray, near: float) -> None:
    """Raise InputError for ends that are within a distance `near` [m] and are not one node."""
    ends = np.unique(cells[:, :2])
    pairs = _pairs(nodes, ends, near)
    if len(pairs):
        one, other = pairs[0]
        distance = np.linalg.norm(nodes[one] - nodes[other])
        raise InputError(
            f"two nodes are at {_at(nodes, one)}, {distance:.1g} apart, so that lines which meet there are not joined "
            f"(and {len(pairs) - 1} more pair(s) elsewhere); merge them, by `merge` or in Gmsh by Coherence; for "
            "a hinge, name it"
        )
    middle = cells[:, 2][cells[:, 2] >= 0]
    crossed = np.intersect1d(middle, ends)
    if len(crossed):
        raise InputError(f"a line ends in the middle of a line3 at {_at(nodes, crossed[0])}; split the line3 there")


def _pairs(nodes: np.ndarray, ends: np.ndarray, near: float) -> np.ndarray:
    """Return the pairs (n, 2) of ends that are within `near` [m] of each other."""
    from scipy.spatial import cKDTree  # slow to import

    return np.asarray(ends[cKDTree(nodes[ends]).query_pairs(near, output_type="ndarray")].reshape(-1, 2))


def _refuse_repeated(nodes: np.ndarray, cells: np.ndarray, owner: np.ndarray, size: float) -> None:
    """Raise InputError for two lines at one place; owner: number of the line that each cell is a part of."""
    curved = cells[:, 2] >= 0
    half = nodes[cells[:, :2]].mean(axis=1)
    half[curved] = nodes[cells[curved, 2]]
    key = np.column_stack([np.sort(cells[:, :2], axis=1), np.round(half / (1e3 * _SAME * size))])
    _, first, inverse = np.unique(key, axis=0, return_index=True, return_inverse=True)
    again = np.flatnonzero(first[inverse.ravel()] != np.arange(len(cells)))
    if len(again):
        other = first[inverse.ravel()[again[0]]]
        where = f"{_at(nodes, cells[other, 0])} to {_at(nodes, cells[other, 1])}"
        raise InputError(
            f"lines {owner[other]} and {owner[again[0]]} (counted from 0) are the same line from {where}; remove one"
        )


def _numbers_below(name: str, numbers: np.ndarray, size: int, lowest: int) -> np.ndarray:
    """Return whole numbers from `lowest` to size - 1. Raises InputError for others."""
    if numbers.size and numbers.dtype.kind not in "iu":
        raise InputError(f"{name} must be whole numbers, got {shown(numbers)}")
    wrong = numbers[(numbers < lowest) | (numbers >= size)]
    if wrong.size:
        raise InputError(f"{name} must be between {lowest} and {size - 1}, got {wrong[0]}")
    return numbers.astype(np.int64)


def _at(nodes: np.ndarray, node: int) -> str:
    return f"({nodes[node, 0]:g}, {nodes[node, 1]:g})"


def merged(nodes: np.ndarray, ends: np.ndarray, near: float) -> np.ndarray:
    """Return for each node (n,) the first of the ends that are within `near` [m] of it, or itself."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    a, b = _pairs(nodes, ends, near).T
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


def warn_of_gaps(nodes: np.ndarray, cells: np.ndarray, reach: float) -> None:
    """Warn of ends that stand within `reach` [m] of another end or line and are not joined to it."""
    pairs = _pairs(nodes, np.unique(cells[:, :2]), reach)
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
    rise = np.abs(cross(chord, nodes[middle] - start)) / length
    within = cKDTree(nodes[ends]).query_ball_point(0.5 * (start + end), 0.5 * length + rise + near)
    cell = np.repeat(np.arange(len(cells)), [len(hits) for hits in within])
    node = ends[np.concatenate(within).astype(np.int64)]
    at_end = (node == cells[cell, 0]) | (node == cells[cell, 1])
    cell, node = cell[~at_end], node[~at_end]
    away = nodes[node] - start[cell]
    fraction = np.einsum("ni,ni->n", away, chord[cell]) / length[cell] ** 2
    off = cross(chord[cell], away) / length[cell]
    bow = cross(chord, nodes[middle] - start)[cell] / length[cell] * 4.0 * fraction * (1.0 - fraction)
    on = (np.abs(off - bow) <= near) & (fraction > 0.0) & (fraction < 1.0)
    return cell[on], node[on], fraction[on]
