"""Content of mesh files: points, cells of any type and named sets of both.

Input files of Abaqus and CalculiX are read here, others through meshio: meshio 5.3.5 assigns element sets to the wrong
cells if an element block has no set or two blocks share one, drops node sets composed of other sets, and keeps only the
last of several node blocks, all without a message.
Source: Abaqus keywords reference (*NODE, *ELEMENT, *NSET, *ELSET, *INCLUDE); node order of B32: end, middle, end.
"""

import contextlib
import io
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import readable
from beamfem.errors import InputError, NotReadWarning, warn
from beamfem.extras import needed_for

_DIMENSION = {"vertex": 0, "line": 1, "line3": 1}
_NUMBERINGS = {"beam", "material", "section"}  # of the cells of centre lines that `Solution.to_vtk` wrote


@dataclass(frozen=True, eq=False)
class MeshFile:
    """Points (n, 2 or 3) [m], blocks (type, nodes (m, k)) of cells, cell sets numbered over all blocks, and point sets.

    A line3 lists its ends first and its middle last.
    """

    points: np.ndarray
    blocks: tuple[tuple[str, np.ndarray], ...]
    cell_sets: dict[str, np.ndarray]
    point_sets: dict[str, np.ndarray]


def read_through_meshio(path: Path) -> MeshFile:
    """Return the content of a file. Raises InputError if meshio cannot read it."""
    with needed_for("reading mesh files"):
        import meshio  # slow to import, and seldom needed

    formats = {
        ending: "gmsh" if ending == ".msh" else kinds[0] for ending, kinds in meshio.extension_to_filetypes.items()
    }
    kind = formats.get(path.suffix.lower())
    if kind is None:
        raise InputError(f"{path}: mesh files end in {', '.join(sorted(formats))}")
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            mesh = meshio.read(path, file_format=kind)
    except (Exception, SystemExit) as error:  # meshio raises anything for a bad file, and exits for some
        words = printed.getvalue().strip() if isinstance(error, SystemExit) else str(error)
        reason = " ".join(words.split()) or type(error).__name__
        raise InputError(f"{path} cannot be read as {kind}: {reason}{_advice(path)}") from error
    blocks = tuple((block.type, np.asarray(block.data)) for block in mesh.cells)
    if any(nodes.shape[1:] == (0,) for _, nodes in blocks):
        raise InputError(f"{path}: it is damaged: it holds cells without nodes, as a file that ends early does")
    sizes = [len(nodes) for _, nodes in blocks]
    cell_sets, first = _groups(mesh), np.concatenate([[0], np.cumsum(sizes)])
    for name, parts in mesh.cell_sets.items():  # cells by blocks
        if not name.startswith("gmsh:"):
            numbers = [first[i] + np.asarray(part, dtype=np.int64) for i, part in enumerate(parts) if part is not None]
            cell_sets[name] = np.concatenate([np.empty(0, dtype=np.int64), *numbers])
    point_sets = {name: np.asarray(nodes, dtype=np.int64) for name, nodes in mesh.point_sets.items()}
    counted = _NUMBERINGS if set(mesh.cell_data) >= _NUMBERINGS else set()
    for name, values in mesh.cell_data.items():
        if values:
            cell_sets |= _by_value(name, np.concatenate(values), name in counted)
    for name, values in mesh.point_data.items():
        point_sets |= _by_value(name, np.asarray(values))
    return MeshFile(np.asarray(mesh.points, dtype=float), blocks, cell_sets, point_sets)


def _groups(mesh: Any) -> dict[str, np.ndarray]:
    """Return the cells of the physical groups of a Gmsh file, by number for groups without a name."""
    if "gmsh:physical" not in mesh.cell_data:
        return {}
    tags = np.concatenate(mesh.cell_data["gmsh:physical"])
    dimension = np.concatenate([np.full(len(block.data), _DIMENSION.get(block.type, 2)) for block in mesh.cells])
    names = {(int(tag), int(size)): name for name, (tag, size) in mesh.field_data.items()}
    result: dict[str, np.ndarray] = {}
    for tag, size in sorted(set(zip(tags.tolist(), dimension.tolist(), strict=True))):
        if tag != 0:
            # a group of curves and one of points may have the same number
            name = names.get((tag, size), str(tag))
            cells = np.flatnonzero((tags == tag) & (dimension == size))
            result[name] = np.concatenate([result.get(name, cells[:0]), cells])
    return result


def _by_value(name: str, values: np.ndarray, counted: bool = False) -> dict[str, np.ndarray]:
    """Return the sets that whole numbers on cells or points define: `name` if nonzero, `name=k` for the value k.

    counted: the numbers count from 0, so that zero is one of them and `name` is no set.
    """
    if name.startswith("gmsh:") or values.ndim != 1 or not np.issubdtype(values.dtype, np.integer):
        return {}
    sets = {f"{name}={value}": np.flatnonzero(values == value) for value in np.unique(values)}
    return sets if counted else {name: np.flatnonzero(values), **sets}


def _advice(path: Path) -> str:
    """Return advice for an ASCII file of Gmsh, which meshio reads only in part."""
    with path.open("rb") as file:
        head = file.read(64).split()
    if len(head) > 2 and head[0] == b"$MeshFormat" and head[2] == b"0":
        return "; it is an ASCII file: save it as a binary one (gmsh -bin, or Mesh.Binary = 1)"
    return ""


_STRAIGHT = re.compile(r"(T[23]D2|B[23][13]|PIPE[23]1|FRAME[23]D)")
_QUADRATIC = re.compile(r"(T[23]D3|B[23]2|PIPE[23]2)")
# What belongs to the mesh, or says nothing; *INCLUDE is followed where it stands.
OF_THE_MESH = {"NODE", "ELEMENT", "NSET", "ELSET", "HEADING", "PREPRINT", "INSTANCE", "PART", "ASSEMBLY"}
OF_THE_MESH |= {"END INSTANCE", "END PART", "END ASSEMBLY", "END STEP"}
_NAMED = 8
_GENERATORS = ("NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "SYSTEM")


class Rows(list[list[str]]):
    """Data lines with their numbers in the file; `read` is that of the line which is being read."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[int] = []
        self.read: int | None = None

    def __iter__(self) -> Iterator[list[str]]:
        for number, row in zip(self.lines, super().__iter__(), strict=True):
            self.read = number
            yield row
        self.read = None

    def __getitem__(self, index: Any) -> Any:
        self.read = self.lines[index]
        return super().__getitem__(index)


@dataclass
class Keyword:
    """A keyword line with its parameters and data lines."""

    keyword: str
    parameters: dict[str, str]
    path: Path
    line: int
    rows: Rows = field(default_factory=Rows)

    @property
    def place(self) -> str:
        """Return file and line for messages: of the data line that is being read, else of the keyword."""
        return f"{self.path}, line {self.rows.read or self.line}"


@dataclass
class _Sets:
    """Named sets of numbers, stored as different ranges, in order of appearance; names are case-insensitive."""

    kind: str
    names: dict[str, str] = field(default_factory=dict)
    numbers: dict[str, dict[range, None]] = field(default_factory=dict)

    def add(self, name: str, numbers: Iterable[range]) -> None:
        self.names.setdefault(name.upper(), name)
        self.numbers.setdefault(name.upper(), {}).update(dict.fromkeys(numbers))

    def define(self, section: Keyword) -> None:
        """Add the content of a *NSET or *ELSET: numbers, ranges or other sets. Raises InputError."""
        numbers: dict[range, None] = {}  # sets of sets may name the same one time and again
        for row in section.rows:
            if "GENERATE" in section.parameters:
                first, last, *step = (int(value) for value in row)
                numbers[range(first, last + 1, *step)] = None
                continue
            for value in row:
                if value.upper() in self.numbers:
                    numbers |= self.numbers[value.upper()]
                elif value.lstrip("-").isdigit():
                    numbers[_one(int(value))] = None
                else:
                    known = ", ".join(self.names.values()) or "none"
                    raise InputError(f"{section.place}: there is no {self.kind} {value!r} so far; known: {known}")
        self.add(section.parameters[self.kind.upper()], numbers)

    def placed(self, place: dict[int, int]) -> dict[str, np.ndarray]:
        """Return the sets as positions in the tables. Raises InputError for numbers that the file does not define."""
        for key, numbers in self.numbers.items():
            # one after the other: a range may be far longer than the file
            missing = next((number for number in chain(*numbers) if number not in place), None)
            if missing is not None:
                raise InputError(f"{self.kind} {self.names[key]} lists {missing}, which the file does not give")
        return {
            self.names[key]: np.array(sorted({place[number] for number in chain(*numbers)}), dtype=np.int64)
            for key, numbers in self.numbers.items()
        }


def _one(number: int) -> range:
    return range(number, number + 1)


def read_abaqus(path: Path) -> MeshFile:
    """Return the mesh in an input file. Raises InputError, with the line, for anything that cannot be read."""
    keywords = list(keywords_of(path))
    content = content_of(path, keywords)
    others: dict[str, None] = {}
    for keyword in keywords:
        if keyword.keyword not in OF_THE_MESH:
            name = keyword.parameters.get("NAME") or keyword.parameters.get("ELSET", "")
            others[f"*{keyword.keyword} {name}".rstrip()] = None
    if others:
        warn(
            f"{path}: nodes, elements and sets are read, and nothing else; left out: {listed(others)}. Give section "
            "and material to mesh.frame(...), supports and loads to Model(...), or use read_abaqus_model",
            NotReadWarning,
        )
    return content


def listed(names: Iterable[str]) -> str:
    """Return the first names of what is left out, and the number of the others."""
    every = list(names)
    return f"{', '.join(every[:_NAMED])}{f' and {len(every) - _NAMED} more' if len(every) > _NAMED else ''}"


def content_of(path: Path, keywords: list[Keyword], trusses: str = "") -> MeshFile:
    """Return the mesh of keywords. Raises InputError, with the line, for anything that cannot be read.

    trusses: name of an element set of all trusses; with it, nodes and elements that supports and loads number become
    sets that are named by their number.
    """
    _tell_parts_apart(keywords)
    nodes: dict[int, tuple[float, ...]] = {}
    cells: dict[int, tuple[str, list[int]]] = {}
    node_sets, element_sets = _Sets("nset"), _Sets("elset")
    for section in keywords:
        try:
            if section.keyword == "NODE":
                _add_nodes(section, nodes, node_sets)
            elif section.keyword == "ELEMENT":
                _add_elements(section, cells, element_sets)
                if trusses and section.parameters["TYPE"].upper().startswith("T"):
                    element_sets.add(trusses, [_one(int(row[0])) for row in section.rows])
            elif section.keyword == "NSET":
                node_sets.define(section)
            elif section.keyword == "ELSET":
                element_sets.define(section)
            elif trusses and section.keyword in ("BOUNDARY", "CLOAD", "DLOAD"):
                sets = element_sets if section.keyword == "DLOAD" else node_sets
                for number in (row[0].rpartition(".")[2] for row in section.rows):
                    if number.isdigit():
                        sets.add(number, [_one(int(number))])
            elif section.keyword in _GENERATORS or (section.keyword == "INSTANCE" and section.rows):
                raise InputError(f"{section.place}: *{section.keyword} cannot be read; write out all nodes in place")
        except (ValueError, KeyError, IndexError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"{section.place}: this line below *{section.keyword} cannot be read: {error}") from error
    return _assembled(path, nodes, cells, node_sets, element_sets)


def _tell_parts_apart(keywords: list[Keyword]) -> None:
    """Put its name before sets of a part which have the name of a set of the assembly, as Abaqus/CAE writes them."""
    kinds = ("NSET", "ELSET")
    of_assembly = {
        (kind, keyword.parameters.get(kind, "").upper())
        for keyword in keywords
        for kind in kinds
        if keyword.keyword == kind and "INSTANCE" in keyword.parameters
    }
    part = ""
    for keyword in keywords:
        if keyword.keyword in ("PART", "END PART"):
            part = keyword.parameters.get("NAME", "")
        for kind in kinds:
            if part and (kind, keyword.parameters.get(kind, "").upper()) in of_assembly:
                keyword.parameters[kind] = f"{part}.{keyword.parameters[kind]}"


def number(word: str) -> float:
    """Return a number, which may have a Fortran exponent; an empty word is zero."""
    return float(word.upper().replace("D", "E") or 0.0)


def _add_nodes(section: Keyword, nodes: dict[int, tuple[float, ...]], sets: _Sets) -> None:
    for row in section.rows:
        point = (*map(number, row[1:4]), 0.0, 0.0, 0.0)[:3]
        if nodes.setdefault(int(row[0]), point) != point:
            raise InputError(
                f"{section.place}: node {row[0]} is given twice at different places; files of several parts "
                "must be written flat, without parts and assemblies"
            )
    if "NSET" in section.parameters:
        sets.add(section.parameters["NSET"], [_one(int(row[0])) for row in section.rows])


def _add_elements(section: Keyword, cells: dict[int, tuple[str, list[int]]], sets: _Sets) -> None:
    kind = section.parameters["TYPE"].upper()
    size = 2 if _STRAIGHT.match(kind) else 3 if _QUADRATIC.match(kind) else None
    name = {2: "line", 3: "line3", None: kind}[size]
    for row in section.rows:
        corners = [int(value) for value in row[1:]][:size]  # beams may name one more node for their orientation
        if size is not None and len(corners) < size:
            raise InputError(f"{section.place}: element {row[0]} of type {kind} needs {size} nodes")
        if size == 2 and len(row) > 3 and kind.startswith("B33"):  # meshio writes quadratic lines under this name
            raise InputError(
                f"{section.place}: element {row[0]} of type {kind} has 2 nodes; a quadratic line is a B32, and a node "
                "for the orientation must be left out"
            )
        if int(row[0]) in cells:
            raise InputError(f"{section.place}: element {row[0]} is given twice")
        cells[int(row[0])] = name, corners
    if "ELSET" in section.parameters:
        sets.add(section.parameters["ELSET"], [_one(int(row[0])) for row in section.rows])


def _assembled(
    path: Path,
    nodes: dict[int, tuple[float, ...]],
    cells: dict[int, tuple[str, list[int]]],
    node_sets: _Sets,
    element_sets: _Sets,
) -> MeshFile:
    points = np.array(list(nodes.values()), dtype=float).reshape(-1, 3)
    node_index = {number: i for i, number in enumerate(nodes)}
    blocks, order = [], []
    for kind in dict.fromkeys(name for name, _ in cells.values()):
        elements = {number: corners for number, (name, corners) in cells.items() if name == kind}
        order += list(elements)
        for number, corners in elements.items():
            if any(corner not in node_index for corner in corners):
                raise InputError(f"{path}: element {number} has nodes that the file does not give: {corners}")
        if kind in ("line", "line3"):
            table = np.array([[node_index[corner] for corner in corners] for corners in elements.values()])
            blocks.append((kind, _middle_last(table, points) if kind == "line3" else table))
        else:
            blocks.append((kind, np.empty((len(elements), 0), dtype=np.int64)))
    cell_index = {number: i for i, number in enumerate(order)}
    return MeshFile(points, tuple(blocks), element_sets.placed(cell_index), node_sets.placed(node_index))


def _middle_last(table: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Order the nodes of quadratic cells (m, 3) as ends, middle; the middle node is opposite the longest side.

    Abaqus, CalculiX and Gmsh write the middle node second, meshio writes it last.
    """
    corner = points[table]
    opposite = [np.linalg.norm(corner[:, i - 2] - corner[:, i - 1], axis=1) for i in range(3)]
    middle = np.argmax(opposite, axis=0)
    order = np.array([[1, 2, 0], [0, 2, 1], [0, 1, 2]])[middle]
    return np.take_along_axis(table, order, axis=1)


def keywords_of(path: Path, depth: int = 0) -> Iterator[Keyword]:
    """Yield the keywords of a file and of those it includes."""
    if depth > 10:
        raise InputError(f"{path}: files include each other without end")
    try:
        lines = readable(path).read_text(errors="replace").splitlines()
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error}") from error
    section: Keyword | None = None
    number = 0
    while number < len(lines):
        line = lines[number].strip()
        begun = number = number + 1
        if not line or line.startswith("**"):
            continue
        if not line.startswith("*"):
            if section is not None:
                section.rows.append([value.strip() for value in line.rstrip(",").split(",")])
                section.rows.lines.append(number)
            continue
        while line.endswith(",") and number < len(lines):
            line += lines[number].strip()
            number += 1
        if section is not None:
            yield section
        keyword, *words = line[1:].split(",")
        pairs = (word.partition("=") for word in words)
        parameters = {name.strip().upper(): value.strip().strip('"') for name, _, value in pairs}
        section = Keyword(keyword.strip().upper(), parameters, path, begun)
        if section.keyword == "INCLUDE":
            yield from keywords_of(path.parent / parameters.get("INPUT", ""), depth + 1)
            section = None
    if section is not None:
        yield section
