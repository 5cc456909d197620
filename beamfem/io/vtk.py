"""ParaView files: the deformed body as curved quadrilaterals, centrelines as lines, supports and loads as vertices."""

import os
import re
import shutil
import signal
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from uuid import uuid4
from xml.sax.saxutils import quoteattr

import numpy as np

from beamfem.assembly.callbacks import Deferred, uninterrupted
from beamfem.atomic_write import make_folder, path_of, whole
from beamfem.errors import FileError, InputError
from beamfem.extras import needed_for
from beamfem.io.vtk_boundary import Boundary
from beamfem.io.vtk_cells import LINE, UNITS, Cells, Content, Geometry, times
from beamfem.io.vtkhdf import write_vtkhdf
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
