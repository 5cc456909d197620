"""Labelled arrays in HDF5 files, with names and units as in netCDF: axes of beams, limit points and bifurcations."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from beamfem.io.hdf5 import read_checked, write_checked
from beamfem.results.axis_fields import QUANTITIES, section_forces
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import VALUES, LikeBeams, equal_beams
from beamfem.results.full_turns import rotation
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.results.solution import Solution


def scale(group: Any, name: str, values: np.ndarray, meaning: str, unit: str) -> Any:
    """Return a new dimension scale."""
    result = _array(group, name, values.shape, meaning, unit)
    result[...] = values
    result.make_scale(name)
    return result


def variable(group: Any, name: str, meaning: str, unit: str, scales: tuple[Any, ...]) -> Any:
    """Return a new array over dimension scales."""
    result = _array(group, name, tuple(len(over) for over in scales), meaning, unit)
    for dimension, over in zip(result.dims, scales, strict=True):
        dimension.attach_scale(over)
    return result


def _array(group: Any, name: str, shape: tuple[int, ...], meaning: str, unit: str) -> Any:
    """Return a new array of floats with the attributes `long_name` and `units`."""
    made = group.create_dataset(name, shape, float)
    made.attrs["long_name"], made.attrs["units"] = meaning, unit
    return made


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
    for group in equal_beams(solution.model, [AxisPoints.spaced(mesh, 1) for mesh in meshes], len(solution)):
        # several beams are together only where one table holds all rows
        tables = _tables(solution, group, small) if len(group.numbers) == 1 else [*_tables(solution, group, small)]
        for place, number in enumerate(group.numbers):
            axis = _Axis(file, solution, number, group.single[place], small)
            for rows, parts in tables:
                axis.write(rows, parts[place])
                require_written()


def _tables(solution: Solution, group: LikeBeams, forces: bool) -> Iterator[tuple[slice, list[np.ndarray]]]:
    """Yield x, y and rotation, and section forces if wanted (3 or 6, rows, points) of each beam, with their rows."""
    points, block = group.points, max(VALUES // sum(group.counts), 1)
    for first in range(0, len(solution), block):
        rows = slice(first, min(first + block, len(solution)))
        r = points.positions(solution.p[rows])[0]
        values = [r[..., 0], r[..., 1], rotation(points, solution, rows)]
        if forces:
            found = section_forces(points, solution, rows)
            values += [found[name] for name in _FORCES]
        yield rows, group.parted(np.stack(values), 2)


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
        arc = points.arc_length
        at = scale(group, over, solution.at, over.replace("_", " "), of_rows)
        along = scale(group, "arc_length", arc[self._ends], "arc length in the reference", unit("m"))
        self._forces: list[Any] = []
        if forces:
            ends = scale(group, "element_end", arc, "arc length of the ends of each element", unit("m"))
            about = ((name, QUANTITIES[name].label, unit(QUANTITIES[name].unit)) for name in _FORCES)
            self._forces = [variable(group, *each, (at, ends)) for each in about]
        moved = (
            ("x", "position x", unit("m")),
            ("y", "position y", unit("m")),
            ("rotation", "rotation of the section", "rad"),
        )
        self._moved = [variable(group, *each, (at, along)) for each in moved]

    def write(self, rows: slice, table: np.ndarray) -> None:
        """Write some rows of the values of `_tables`."""
        for moved, values in zip(self._moved, table, strict=False):
            moved[rows] = values[:, self._ends]
        for force, values in zip(self._forces, table[3:], strict=True):
            force[rows] = values


_STATE = ("at", "p")
_CROSSING = ("at", "p", "mode", "tangent")


def load_factors(path: Path) -> np.ndarray:
    """Return the load factors of the critical points of a path (m,), at which its functions are evaluated too."""
    return np.array([state.at for state in (*path.limit_points, *path.bifurcations)])


def save_critical(file: Any, path: Path) -> None:
    """Write the critical points of a path, one per row."""
    for name, parts in (("limit_points", _STATE), ("bifurcations", _CROSSING)):
        group, states = file.create_group(name), getattr(path, name)
        for part in parts:
            write_checked(group, part, np.array([getattr(state, part) for state in states]))
        turned = [state.turned for state in states if state.turned is not None]
        if turned and turned[0].size:
            write_checked(group, "turned", np.array(turned))


def load_path(file: Any, rows: Solution) -> Solution:
    """Return the rows as the saved path with its critical points, or unchanged if no path was saved."""
    if "limit_points" not in file:
        return rows
    model, zeros = rows.model, np.zeros(rows.model.size)

    def states(name: str, kind: type[PathState], parts: tuple[str, ...]) -> tuple[Any, ...]:
        rows = _rows(file[name], parts)
        return tuple(
            kind(p, zeros, zeros, float(at), model, *more, stability=False, turned=turned)
            for at, p, *more, turned in rows
        )

    members = {name: getattr(rows, name) for name in Solution.__dataclass_fields__}
    limits, crossings = states("limit_points", PathState, _STATE), states("bifurcations", Bifurcation, _CROSSING)
    return Path(**members, limit_points=limits, bifurcations=crossings)


def _rows(group: Any, parts: tuple[str, ...]) -> Any:
    """Return the members of each state and its counted rotations, None if no beam needs them or the file is older."""
    turned = read_checked(group, "turned") if "turned" in group else [None] * len(group["at"])
    return zip(*(read_checked(group, part) for part in parts), turned, strict=True)
