"""ParaView files: the deformed body as curved quadrilaterals, centrelines as lines, supports and loads as vertices.

Source: Kitware, VTKHDF File Format 2.6 (temporal UnstructuredGrid), docs.vtk.org.
"""

import os
import re
import shutil
import signal
from collections.abc import Callable, Sequence
from math import prod
from os import PathLike
from pathlib import Path
from typing import Any
from uuid import uuid4
from xml.sax.saxutils import quoteattr

import numpy as np

from beamfem.assembly.callbacks import Deferred, uninterrupted
from beamfem.atomic_write import make_folder, path_of, whole
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
_STEPS_BETWEEN_PUBLISHING = 50


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
    suffix = path.suffix.lower()
    if suffix not in (".pvd", ".vtkhdf"):
        right = path.with_suffix(".pvd") if path.name else path / "result.pvd"
        raise InputError(f'ParaView opens a .pvd or a .vtkhdf file, got "{path}"; "{right}" would be right')
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
        (_write_series if suffix == ".pvd" else write_vtkhdf)(solution, target, cells, chunk)


def _write_series(solution: Solution, path: Path, cells: Cells | Boundary, chunk: int) -> None:
    series = _Series(path, cells, "load_factor" if solution.static else "time", times(solution.at))
    try:
        for first in range(0, len(solution), chunk):
            series.write(solution, slice(first, first + chunk))
        series.finish()
    finally:
        series.close()


class _Series:
    """A .pvd file and the folder of its steps.

    Where there is an earlier one, steps are written into a folder beside it and moved when all of them are there;
    otherwise into its own, and the .pvd lists those so far.
    """

    def __init__(self, path: Path, cells: Cells | Boundary, name: str, at: np.ndarray) -> None:
        self.path, self.cells, self.folder = path, cells, path.with_suffix("")
        self.name, self.times = name, at
        self.earlier = path.exists()
        self.steps = path.with_name(f"{path.stem[:40]}.{uuid4().hex[:8]}.part") if self.earlier else self.folder
        make_folder(self.folder)
        make_folder(self.steps)
        self.lines: list[str] = []
        table = vtkCellArray()
        table.SetData(*(numpy_to_vtkIdTypeArray(ids, deep=True) for ids in (cells.offsets, cells.connectivity)))
        self.grid = vtkUnstructuredGrid()
        self.grid.SetPoints(vtkPoints())
        self.grid.SetCells(cells.cell_type, table)
        if cells.degrees is not None:
            self.grid.GetCellData().SetHigherOrderDegrees(_named("HigherOrderDegrees", cells.degrees))
        for name_of_cells, values in cells.numbers.items():
            self.grid.GetCellData().AddArray(_named(name_of_cells, values.astype(np.int32)))
        # meshio reads no texts, and lines are what it is to read
        for name_of_legend, texts in cells.legend.items() if cells.cell_type != LINE else ():
            self.grid.GetFieldData().AddArray(_texts(name_of_legend, texts))
        self.writer = vtkXMLUnstructuredGridWriter()
        self.writer.SetInputData(self.grid)
        self.writer.EncodeAppendedDataOff()

    def write(self, solution: Solution, rows: slice) -> None:
        """Write a file a step, of some rows of a solution."""
        arrays = self.cells.arrays(solution, rows)
        for row, value in enumerate(solution.at[rows]):
            now = {name: numpy_to_vtk(values[row]) for name, values in arrays.items()}
            self.grid.GetPoints().SetData(now.pop("points"))
            for name, array in now.items():
                array.SetName(name)
                if name in UNITS:
                    array.GetInformation().Set(vtkDataArray.UNITS_LABEL(), self.cells.unit(UNITS[name]))
                self.grid.GetPointData().AddArray(array)
            self.grid.GetFieldData().AddArray(_named(self.name, np.array([value])))
            file = self.steps / f"{len(self.lines):04d}.vtu"
            partial = file.with_suffix(".part")
            self.writer.SetFileName(os.fspath(partial))
            if not self.writer.Write():
                partial.unlink(missing_ok=True)
                raise FileError(f"{file} cannot be written: the disk is full, or takes no files")
            os.replace(partial, file)
            source = quoteattr(f"{self.folder.name}/{file.name}")
            time = float(self.times[len(self.lines)])
            self.lines.append(f'    <DataSet timestep="{time!r}" part="0" file={source}/>\n')
            if not self.earlier and len(self.lines) % _STEPS_BETWEEN_PUBLISHING == 1:
                self.publish()

    @uninterrupted
    def finish(self) -> None:
        """Replace the earlier export; signals wait until all of it is replaced."""
        try:
            if self.earlier:
                for file in sorted(self.steps.iterdir()):
                    os.replace(file, self.folder / file.name)
            self.clean()
            self.publish()
        except FileError:
            raise
        except OSError as error:
            raise FileError(f"{self.path} cannot be written: {error.strerror or error}") from error

    def close(self) -> None:
        """Publish the steps so far, or leave the earlier export as it is."""
        if self.earlier:
            shutil.rmtree(self.steps, ignore_errors=True)
        else:
            self.publish()

    def clean(self) -> None:
        """Remove the steps that an earlier, longer export left behind."""
        for file in self.folder.glob("*.vtu"):
            if re.fullmatch(r"\d{4,}", file.stem) and int(file.stem) >= len(self.lines) and file.is_file():
                file.unlink()

    def publish(self) -> None:
        """Rewrite the .pvd with the steps so far; readers see the old file or the new one, never a part."""
        head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
        with whole(self.path) as partial:
            partial.write_text(head + "".join(self.lines) + "  </Collection>\n</VTKFile>\n", encoding="utf-8")


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


def write_vtkhdf(solution: Solution, path: Path, cells: Cells | Boundary, chunk: int) -> None:
    """Write the cells of a solution, `chunk` rows at a time; readers see the old file or the whole new one.

    Cells are stored once, points and point data for every step. Raises MissingPackageError without h5py.
    """

    def fill(file: Any, require_written: Callable[[], None]) -> None:
        _write(file.create_group("VTKHDF", track_order=True), solution, cells, chunk, require_written)

    write_hdf5(path, fill)


def _write(
    root: Any, solution: Solution, cells: Cells | Boundary, chunk: int, require_written: Callable[[], None]
) -> None:
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
