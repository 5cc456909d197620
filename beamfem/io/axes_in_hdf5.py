"""Axes of beams in a results file, with names and units as in netCDF, for programs without beamfem."""

from collections.abc import Callable
from typing import Any

import numpy as np

from beamfem.results.along import QUANTITIES, AxisPoints, rotation, section_forces
from beamfem.results.many_beams import VALUES, together
from beamfem.results.solution import Solution

AXES = "beams"
_MOST = 100_000  # elements times rows whose section forces are written, in a second or two
_FORCES = ("normal", "shear", "moment")


def save_axes(file: Any, solution: Solution, require_written: Callable[[], None]) -> None:
    """Write groups beams/0, beams/1, ...: positions of element ends, rotations of sections and forces in them there.

    x, y [m] and rotation [rad] (rows, stations) over the dimension scales `time` [s] or `load_factor` (rows,) and
    `arc_length` [m] (stations,); normal, shear [N] and moment [N m] (rows, 2 elements) over `element_end` [m], where
    each element has ends of its own, since forces jump at loads; long motions of large models have no forces, which
    would take longer than the solve. All have the attributes `units`, those of the model, and `long_name`; a group has
    the `name` of its beam, where it has one.
    """
    meshes = solution.model.meshes
    small = len(solution) * sum(mesh.elements for mesh in meshes) <= _MOST
    for group in together(solution.model, [AxisPoints(mesh, 1) for mesh in meshes], len(solution)):
        axes = [_Axis(file, solution, *one, small) for one in zip(group.numbers, group.single, strict=True)]
        block = max(VALUES // sum(group.counts), 1)
        for first in range(0, len(solution), block):
            rows = slice(first, min(first + block, len(solution)))
            table = _table(solution, group.points, rows, small)
            for axis, values in zip(axes, group.parted(table, 2), strict=True):
                axis.write(rows, values)
            require_written()


def _table(solution: Solution, points: AxisPoints, rows: slice, forces: bool) -> np.ndarray:
    """Return x, y and rotation, and the section forces if they are wanted (3 or 6, rows, points)."""
    r = points.positions(solution.p[rows])[0]
    values = [r[..., 0], r[..., 1], rotation(points, solution, rows)]
    if forces:
        found = section_forces(points, solution, rows)
        values += [found[name] for name in _FORCES]
    return np.stack(values)


class _Axis:
    """The group of one beam in the file."""

    def __init__(self, file: Any, solution: Solution, number: int, points: AxisPoints, forces: bool) -> None:
        unit, mesh = solution.model.unit, points.mesh
        over, of_rows = ("load_factor", "1") if solution.static else ("time", unit("s"))
        self._ends = np.append(np.arange(0, 2 * mesh.elements, 2), 2 * mesh.elements - 1)
        group = file.create_group(f"{AXES}/{number}", track_order=True)
        group.attrs["curve"] = type(mesh.beam.curve).__name__
        group.attrs["element"] = mesh.beam.element.name
        if mesh.beam.name is not None:
            group.attrs["name"] = mesh.beam.name
        rows, arc = len(solution), points.arc_length
        at = _scale(group, over, solution.at, over.replace("_", " "), of_rows)
        along = _scale(group, "arc_length", arc[self._ends], "arc length in the reference", unit("m"))
        self._forces: list[Any] = []
        if forces:
            ends = _scale(group, "element_end", arc, "arc length of the ends of each element", unit("m"))
            about = ((name, QUANTITIES[name].label, unit(QUANTITIES[name].unit)) for name in _FORCES)
            self._forces = [_variable(group, *each, (rows, len(arc)), (at, ends)) for each in about]
        moved = (
            ("x", "position x", unit("m")),
            ("y", "position y", unit("m")),
            ("rotation", "rotation of the section", "rad"),
        )
        self._moved = [_variable(group, *each, (rows, len(self._ends)), (at, along)) for each in moved]

    def write(self, rows: slice, table: np.ndarray) -> None:
        """Write some rows of a `_table`."""
        for variable, values in zip(self._moved, table, strict=False):
            variable[rows] = values[:, self._ends]
        for variable, values in zip(self._forces, table[3:], strict=True):
            variable[rows] = values


def _scale(group: Any, name: str, values: np.ndarray, meaning: str, unit: str) -> Any:
    scale = _described(group.create_dataset(name, data=values), meaning, unit)
    scale.make_scale(name)
    return scale


def _variable(group: Any, name: str, meaning: str, unit: str, shape: tuple[int, int], scales: tuple[Any, Any]) -> Any:
    variable = _described(group.create_dataset(name, shape, np.float64), meaning, unit)
    for dimension, scale in zip(variable.dims, scales, strict=True):
        dimension.attach_scale(scale)
    return variable


def _described(dataset: Any, meaning: str, unit: str) -> Any:
    dataset.attrs["long_name"], dataset.attrs["units"] = meaning, unit
    return dataset
