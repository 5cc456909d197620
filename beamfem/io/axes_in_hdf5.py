"""Axes of beams in a results file, with names and units as in netCDF, for programs without beamfem."""

from collections.abc import Callable
from typing import Any

import numpy as np

from beamfem.results.along import QUANTITIES, AxisPoints, rotation, section_forces
from beamfem.results.solution import Solution

AXES = "beams"
_BLOCK_BYTES = 2**20
_MOST = 100_000  # elements times rows whose section forces are written, in a second or two


def save_axes(file: Any, solution: Solution, require_written: Callable[[], None]) -> None:
    """Write groups beams/0, beams/1, ...: positions of element ends, rotations of sections and forces in them there.

    x, y [m] and rotation [rad] (rows, stations) over the dimension scales `time` [s] or `load_factor` (rows,) and
    `arc_length` [m] (stations,); normal, shear [N] and moment [N m] (rows, 2 elements) over `element_end` [m], where
    each element has ends of its own, since forces jump at loads; long motions of large models have no forces, which
    would take longer than the solve. All have the attributes `units`, those of the model, and `long_name`; a group has
    the `name` of its beam, where it has one.
    """
    unit = solution.model.unit
    over, of_rows = ("load_factor", "1") if solution.static else ("time", unit("s"))
    small = len(solution) * sum(mesh.elements for mesh in solution.model.meshes) <= _MOST
    for number, mesh in enumerate(solution.model.meshes):
        points = AxisPoints(mesh, 1)
        ends = np.append(np.arange(0, 2 * mesh.elements, 2), 2 * mesh.elements - 1)
        group = file.create_group(f"{AXES}/{number}", track_order=True)
        group.attrs["curve"] = type(mesh.beam.curve).__name__
        group.attrs["element"] = mesh.beam.element.name
        if mesh.beam.name is not None:
            group.attrs["name"] = mesh.beam.name
        scales = (
            _scale(group, over, solution.at, over.replace("_", " "), of_rows),
            _scale(group, "arc_length", points.arc_length[ends], "arc length in the reference", unit("m")),
        )
        forces = _forces(group, points, solution, scales[0]) if small else {}
        shape = len(solution), len(ends)
        x, y, turned = (
            _variable(group, *about, shape, scales)
            for about in (
                ("x", "position x", unit("m")),
                ("y", "position y", unit("m")),
                ("rotation", "rotation of the section", "rad"),
            )
        )
        block = max(_BLOCK_BYTES // (16 * len(points.xi)), 1)
        for first in range(0, len(solution), block):
            rows = slice(first, min(first + block, len(solution)))
            r = points.positions(solution.p[rows])[0][:, ends]
            x[rows], y[rows] = r[..., 0], r[..., 1]
            turned[rows] = rotation(points, solution, rows)[:, ends]
            for name, values in section_forces(points, solution, rows).items() if forces else ():
                forces[name][rows] = values
            require_written()


def _forces(group: Any, points: AxisPoints, solution: Solution, over: Any) -> dict[str, Any]:
    """Return the empty variables of the section forces."""
    unit, shape = solution.model.unit, (len(solution), len(points.xi))
    ends = _scale(group, "element_end", points.arc_length, "arc length of the ends of each element", unit("m"))
    about = {name: (QUANTITIES[name].label, unit(QUANTITIES[name].unit)) for name in ("normal", "shear", "moment")}
    return {name: _variable(group, name, *texts, shape, (over, ends)) for name, texts in about.items()}


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
