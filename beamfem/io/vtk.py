"""ParaView files: the deformed body as curved quadrilaterals, centrelines as lines, supports and loads as vertices.

Source: Kitware, VTKHDF File Format 2.6 (temporal UnstructuredGrid), docs.vtk.org.
"""

import os
import re
import shutil
import signal
from collections.abc import Callable, Sequence
from functools import partial
from math import prod
from os import PathLike
from pathlib import Path
from typing import Any
from uuid import uuid4
from xml.sax.saxutils import quoteattr

import numpy as np

from beamfem.atomic_write import make_folder, path_ending, path_of, whole
from beamfem.equations.callbacks import Deferred, uninterrupted
from beamfem.errors import FileError, InputError
from beamfem.extras import needed_for
from beamfem.io.hdf5 import write_hdf5
from beamfem.io.vtk_boundary import Boundary
from beamfem.io.vtk_cells import LINE, UNITS, Cells, Content, Geometry, times
from beamfem.results.solution import Solution
from beamfem.validation import items

_deferred = Deferred(signal.valid_signals())  # a process that is interrupted while it loads VTK may crash
with _deferred, needed_for("to_vtk"):
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkDataArray, vtkPoints, vtkStringArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
_deferred.deliver()

VALUES_IN_MEMORY = 100_000


def write_vtk(
    solution: Solution,
    path: str | PathLike[str],
    *,
    geometry: Geometry = "deformed",
    fields: Sequence[str] | None = None,
    single: bool = False,
) -> None:
    """Write body, centrelines, and supports and loads into `path` and files beside it, see `Solution.to_vtk`."""
    path = path_of(path)
    if path.name and not path.suffix:
        path = path.with_suffix(".vtkhdf")
    suffix = path_ending(path, "a file for ParaView", ".pvd", ".vtkhdf", example="result.pvd").suffix.lower()
    if len(solution) == 0:
        raise InputError("the solution has no rows, so there is nothing to write")
    chosen = None if fields is None else tuple(items("fields", fields))
    content = Content(geometry, chosen, single)
    bodies = Cells(solution.model, True, suffix == ".vtkhdf", content)
    bodies.warn_of_unknown_stress()
    boundary = Boundary(solution.model, content)
    if chosen is not None:
        content.require_known([*Cells(solution.model, True).names(solution), *boundary.names])
    grids: dict[str, Cells | Boundary] = {"": bodies, "_centreline": Cells(solution.model, False, content=content)}
    if boundary.points:
        grids["_boundary"] = boundary
    for name, cells in grids.items():
        target, chunk = path.with_stem(path.stem + name), max(1, VALUES_IN_MEMORY // cells.points)
        if suffix == ".pvd":
            _write_series(solution, target, cells, chunk)
        else:
            write_hdf5(target, partial(_fill, solution, cells, chunk))


def _write_series(solution: Solution, path: Path, cells: Cells | Boundary, chunk: int) -> None:
    """Write a .pvd file and a folder of its steps, both at the end in place of earlier ones."""
    folder, at = path.with_suffix(""), times(solution.at)
    steps = path.with_name(f"{path.stem[:40]}.{uuid4().hex[:8]}.part")
    make_folder(folder)
    make_folder(steps)
    try:
        _write_steps(solution, steps, cells, chunk)
        lines = [
            f'    <DataSet timestep="{float(time)!r}" part="0" file={quoteattr(f"{folder.name}/{row:04d}.vtu")}/>\n'
            for row, time in enumerate(at)
        ]
        _replace_series(path, folder, steps, lines)
    finally:
        shutil.rmtree(steps, ignore_errors=True)


def _write_steps(solution: Solution, folder: Path, cells: Cells | Boundary, chunk: int) -> None:
    """Write a .vtu file for each row of a solution."""
    table = vtkCellArray()
    table.SetData(*(numpy_to_vtkIdTypeArray(ids, deep=True) for ids in (cells.offsets, cells.connectivity)))
    grid = vtkUnstructuredGrid()
    grid.SetPoints(vtkPoints())
    grid.SetCells(cells.cell_type, table)
    if cells.degrees is not None:
        grid.GetCellData().SetHigherOrderDegrees(_named("HigherOrderDegrees", cells.degrees))
    for name, values in cells.numbers.items():
        grid.GetCellData().AddArray(_named(name, values.astype(np.int32)))
    # meshio reads no texts, and lines are what it is to read
    for name, texts in cells.legend.items() if cells.cell_type != LINE else ():
        grid.GetFieldData().AddArray(_texts(name, texts))
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.EncodeAppendedDataOff()
    for first in range(0, len(solution), chunk):
        arrays = cells.arrays(solution, slice(first, first + chunk))
        for row, value in enumerate(solution.at[first : first + chunk]):
            now = {name: numpy_to_vtk(values[row]) for name, values in arrays.items()}
            grid.GetPoints().SetData(now.pop("points"))
            for name, array in now.items():
                array.SetName(name)
                if name in UNITS:
                    array.GetInformation().Set(vtkDataArray.UNITS_LABEL(), cells.unit(UNITS[name]))
                grid.GetPointData().AddArray(array)
            grid.GetFieldData().AddArray(_named("load_factor" if solution.static else "time", np.array([value])))
            file = folder / f"{first + row:04d}.vtu"
            writer.SetFileName(os.fspath(file))
            if not writer.Write():
                raise FileError(f"{file} cannot be written: the disk is full, or takes no files")


@uninterrupted
def _replace_series(path: Path, folder: Path, steps: Path, lines: list[str]) -> None:
    """Move the steps to their folder in place of those of an earlier export, and write the .pvd file."""
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
    try:
        for file in sorted(steps.iterdir()):
            os.replace(file, folder / file.name)
        for file in folder.glob("*.vtu"):
            if re.fullmatch(r"\d{4,}", file.stem) and int(file.stem) >= len(lines):
                file.unlink()
        with whole(path) as beside:
            beside.write_text(head + "".join(lines) + "  </Collection>\n</VTKFile>\n", encoding="utf-8")
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"{path} cannot be written: {error.strerror or error}") from error


def _named(name: str, values: np.ndarray) -> object:
    array = numpy_to_vtk(values, deep=True)
    array.SetName(name)
    return array


def _texts(name: str, texts: Sequence[str]) -> vtkStringArray:
    array = vtkStringArray()
    array.SetName(name)
    for text in texts:
        array.InsertNextValue(text)
    return array


_CHUNK_BYTES = 2**16


def _fill(
    solution: Solution, cells: Cells | Boundary, chunk: int, file: Any, require_written: Callable[[], None]
) -> None:
    """Write the cells, which are stored once, and points and point data of every step, `chunk` rows at a time."""
    root = file.create_group("VTKHDF", track_order=True)
    root.attrs["Version"] = np.array([2, 6])
    # a string of fixed length, as the format demands
    root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
    steps, number = len(solution), len(cells.offsets) - 1
    root["NumberOfPoints"] = np.array([cells.points])
    root["NumberOfCells"] = np.array([number])
    root["NumberOfConnectivityIds"] = np.array([len(cells.connectivity)])
    root["Connectivity"] = cells.connectivity
    root["Offsets"] = cells.offsets
    root["Types"] = np.full(number, cells.cell_type, dtype=np.uint8)
    cell_data = root.create_group("CellData")
    for numbers, values in cells.numbers.items():
        cell_data[numbers] = values.astype(np.int32)
        if numbers + "s" in cells.legend:
            # readers of VTK 9.7 crash on texts among the field data
            cell_data[numbers].attrs[numbers + "s"] = cells.legend[numbers + "s"]
    name = "load_factor" if solution.static else "time"
    root.create_group("FieldData")[name] = solution.at
    point_data = root.create_group("PointData")
    for first in range(0, steps, chunk):
        rows = slice(first, min(first + chunk, steps))
        for array, values in cells.arrays(solution, rows).items():
            group = root if array == "points" else point_data
            key = "Points" if array == "points" else array
            if key not in group:
                tail, count = values.shape[2:], steps * cells.points
                size = max(1, min(_CHUNK_BYTES // (values.itemsize * prod(tail)), count))
                options = {"chunks": (size, *tail), "compression": "gzip", "shuffle": True}
                group.create_dataset(key, (count, *tail), values.dtype, **options)
                if array in UNITS:
                    group[key].attrs["units"] = cells.unit(UNITS[array])
            flat = values.reshape(-1, *values.shape[2:])
            group[key][first * cells.points : first * cells.points + len(flat)] = flat
        root.file.flush()
        require_written()
    # where in the arrays each step begins; one part and one set of cells for all
    group, begin = root.create_group("Steps"), np.arange(steps) * cells.points
    same = np.zeros(steps, dtype=np.int64)
    group.attrs["NSteps"] = steps
    group["Values"] = times(solution.at)
    group["PartOffsets"] = same
    group["NumberOfParts"] = same + 1
    group["PointOffsets"] = begin
    group["CellOffsets"] = same[:, None]
    group["ConnectivityIdOffsets"] = same[:, None]
    for array in point_data:
        group[f"PointDataOffsets/{array}"] = begin
    for array in cell_data:
        group[f"CellDataOffsets/{array}"] = same
    group[f"FieldDataOffsets/{name}"] = np.arange(steps)
    group[f"FieldDataSizes/{name}"] = np.tile([1, 1], (steps, 1))
