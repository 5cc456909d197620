"""Content of mesh files read through meshio: points, cells of any type and named sets of both."""

import contextlib
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.errors import InputError
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
