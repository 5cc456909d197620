"""All steps in one VTKHDF file, for ParaView 5.12 or newer.

Source: Kitware, VTKHDF File Format 2.6 (temporal UnstructuredGrid), docs.vtk.org.
"""

from collections.abc import Callable
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.io.hdf5 import write_hdf5
from beamfem.io.vtk_boundary import Boundary
from beamfem.io.vtk_cells import UNITS, Cells, times
from beamfem.results.solution import Solution

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
