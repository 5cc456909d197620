"""Solutions in HDF5 files: the model described in JSON, the states in rows, and axes of beams named as in netCDF."""

import json
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, replace
from importlib.metadata import version
from math import prod
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import readable
from beamfem.errors import InputError
from beamfem.io import hdf5
from beamfem.io.description import describe, rebuild
from beamfem.results.axis_fields import QUANTITIES, section_forces
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import VALUES, LikeBeams, equal_beams
from beamfem.results.full_turns import rotation
from beamfem.results.motion_state import Occurrence
from beamfem.results.path import Bifurcation, PathState
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics, Status

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
        beams = zip(group.numbers, group.single, strict=True)
        axes = [_begin_axis(file, solution, number, points, small) for number, points in beams]
        for rows, parts in _tables(solution, group, small):
            for axis, table in zip(axes, parts, strict=True):
                for (array, places), values in zip(axis, table, strict=True):
                    array[rows] = values[:, places]
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


def _begin_axis(
    file: Any, solution: Solution, number: int, points: AxisPoints, forces: bool
) -> list[tuple[Any, np.ndarray]]:
    """Make the group of one beam in the file; return the arrays of what is in `_tables`, each with its points."""
    unit, mesh, arc = solution.model.unit, points.mesh, points.arc_length
    each, ends = np.arange(len(arc)), np.append(np.arange(0, 2 * mesh.elements, 2), 2 * mesh.elements - 1)
    group = file.create_group(f"{AXES}/{number}", track_order=True)
    group.attrs["curve"], group.attrs["element"] = type(mesh.beam.curve).__name__, mesh.beam.element.name
    if mesh.beam.name is not None:
        group.attrs["name"] = mesh.beam.name

    def array(name: str, meaning: str, units: str, over: Any) -> Any:
        """Return an array over dimension scales, or a scale with values (n,)."""
        scales = over if isinstance(over, tuple) else ()
        made = group.create_dataset(name, tuple(map(len, scales or (over,))), float)
        made.attrs["long_name"], made.attrs["units"] = meaning, units
        for dimension, scale in zip(made.dims, scales, strict=False):
            dimension.attach_scale(scale)
        if not scales:
            made[...] = over
            made.make_scale(name)
        return made

    name, of_rows = ("load_factor", "1") if solution.static else ("time", unit("s"))
    at = array(name, name.replace("_", " "), of_rows, solution.at)
    along = array("arc_length", "arc length in the reference", unit("m"), arc[ends])
    acting: list[tuple[Any, np.ndarray]] = []
    if forces:
        beside = array("element_end", "arc length of the ends of each element", unit("m"), arc)
        about = ((name, QUANTITIES[name].label, unit(QUANTITIES[name].unit)) for name in _FORCES)
        acting = [(array(*words, (at, beside)), each) for words in about]
    moved = (("x", "position x", unit("m")), ("y", "position y", unit("m")))
    turned = ("rotation", "rotation of the section", "rad")
    return [*((array(*words, (at, along)), ends) for words in (*moved, turned)), *acting]


_STATE = ("at", "p")
_CROSSING = ("at", "p", "mode", "tangent")


def load_factors(path: EquilibriumPath) -> np.ndarray:
    """Return the load factors of the critical points of a path (m,), at which its functions are evaluated too."""
    return np.array([state.at for state in (*path.limit_points, *path.bifurcations)])


def save_critical(file: Any, path: EquilibriumPath) -> None:
    """Write the critical points of a path, one per row."""
    for name, parts in (("limit_points", _STATE), ("bifurcations", _CROSSING)):
        group, states = file.create_group(name), getattr(path, name)
        for part in parts:
            hdf5.write_checked(group, part, np.array([getattr(state, part) for state in states]))
        turned = [state.turned for state in states if state.turned is not None]
        if turned and turned[0].size:
            hdf5.write_checked(group, "turned", np.array(turned))


def load_path(file: Any, rows: Solution) -> Solution:
    """Return the rows as the saved path with its critical points, or unchanged if no path was saved."""
    if "limit_points" not in file:
        return rows
    model, zeros = rows.model, np.zeros(rows.model.size)

    def states(name: str, kind: type[PathState], parts: tuple[str, ...]) -> tuple[Any, ...]:
        group = file[name]
        # None if no beam needs them, or in older files
        turns = hdf5.read_checked(group, "turned") if "turned" in group else [None] * len(group["at"])
        rows = zip(*(hdf5.read_checked(group, part) for part in parts), turns, strict=True)
        return tuple(
            kind(p, zeros, zeros, float(at), model, *more, stability=False, turned=turned)
            for at, p, *more, turned in rows
        )

    members = {name: getattr(rows, name) for name in Solution.__dataclass_fields__}
    limits, crossings = states("limit_points", PathState, _STATE), states("bifurcations", Bifurcation, _CROSSING)
    return EquilibriumPath(**members, limit_points=limits, bifurcations=crossings)


_FORMAT = "beamfem solution"
_FORMAT_VERSION = 1
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_BLOCK_BYTES = 2**20
STATES = ("at", "p", "v", "a")
_OPTIONAL = ("stability", "turned", "loaded", "exchanged")
CHECKSUMS = "checksums"  # of each block of rows
EVENTS = "events"
_BLOCK_EVENTS = 64
# what h5py and damaged contents raise
_UNREADABLE = (OSError, LookupError, TypeError, ValueError, RuntimeError, AssertionError, AttributeError)
_TRIES = 5  # to read a file that changes meanwhile


def save(solution: Solution, path: str | PathLike[str]) -> None:
    """Write model and states into one HDF5 file with checksums, see `Solution.save`."""
    at = np.append(solution.at, load_factors(solution)) if isinstance(solution, EquilibriumPath) else solution.at
    description = as_text(describe(solution.model, at))
    block = max(min(_BLOCK_BYTES // (8 * solution.p.shape[1]), len(solution)), 1)

    def fill(file: Any, require_written: Callable[[], None]) -> None:
        begin_file(file, len(solution), description, solution.p.shape[1], block)
        hdf5.write_checked(file, "statistics", as_text(about(solution.static, solution.statistics)))
        for name in _OPTIONAL:
            values = getattr(solution, name)
            if values is not None and values.size:
                hdf5.write_checked(file, name, values)
        file.flush()
        for first in range(0, len(solution), block):
            _append(file, solution, slice(first, min(first + block, len(solution))))
            require_written()
        if isinstance(solution, EquilibriumPath):
            save_critical(file, solution)
        if solution.events:
            begin_events(file, max(len(event.name.encode()) for event in solution.events))
            append_events(file, solution.events)
        save_axes(file, solution, require_written)

    hdf5.write_hdf5(path, fill)


def begin_file(file: Any, rows: int, description: np.ndarray, size: int, block: int) -> None:
    """Write what is before the first row; rows: of all; size: number of coordinates; block: rows with a checksum."""
    hdf5.write_label(file, "format", _FORMAT)
    file.attrs["format_version"] = _FORMAT_VERSION
    hdf5.write_label(file, "beamfem_version", version("beamfem"))
    file.attrs["all_rows"], file.attrs["rows"] = rows, 0
    hdf5.write_checked(file, "model", description)
    for name in STATES:
        row = (size,) if name != "at" else ()
        file.create_dataset(name, (0, *row), np.float64, maxshape=(None, *row), chunks=(block, *row))
    file.create_dataset(CHECKSUMS, (0,), np.int64, maxshape=(None,))


def about(static: bool, statistics: Statistics) -> dict[str, Any]:
    """Return how a solve went, to be written as a text."""
    return {"static": static, **asdict(statistics), "status": statistics.status.name}


def load(path: str | PathLike[str], rows: slice | None = None) -> Solution:
    """Return the solution stored in a file.

    Functions of time are returned as `Sampled`, their values at the saved rows. If the writing process was killed, the
    rows written so far are returned.

    Parameters
    ----------
    path : path
        A file that `Solution.save`, or a motion with `file`, wrote.
    rows : slice, optional
        Which rows, in ascending order, if not all: the others need no memory.

    Raises
    ------
    FileError
        If the system refuses to read the file; FileNotFoundError if there is none.
    InputError
        If the file is damaged, of a newer format or not of beamfem, and if no row is selected.
    MissingPackageError
        Without h5py.

    Examples
    --------
    >>> solution.save("cantilever.h5")
    >>> bf.load("cantilever.h5").at
    array([0., 1.])
    """
    h5py = hdf5.required_h5py("loading")
    source = readable(path)
    hdf5.replay(Path(os.path.realpath(source)))
    with source.open("rb") as stream:
        if stream.read(len(_SIGNATURE)) != _SIGNATURE:
            raise InputError(f"{source} is not a file that beamfem saved: it is no HDF5 file")
    for _ in range(_TRIES):
        try:
            return _loaded(h5py, source, rows)
        except InputError:
            if not hdf5.being_written(source):
                raise
    return _loaded(h5py, source, rows)


def _loaded(h5py: Any, source: Path, rows: slice | None) -> Solution:
    """Return the solution in a file. Raises InputError."""
    try:
        with hdf5.opened_once_written(h5py, source) as file:
            return _read(file, slice(None) if rows is None else rows)
    except InputError as error:
        raise InputError(f"{source} cannot be loaded: {error}") from error
    except MemoryError as error:
        raise InputError(f"{source} cannot be loaded: it needs more memory than there is") from error
    except _UNREADABLE as error:
        message = f"{source} cannot be loaded: it is truncated, damaged or still being written ({error})"
        raise InputError(message) from error


def _append(file: Any, solution: Solution, rows: slice) -> None:
    for name in STATES:
        file[name].resize(rows.stop, axis=0)
        file[name][rows] = getattr(solution, name)[rows]
    blocks = len(file[CHECKSUMS])
    file[CHECKSUMS].resize(blocks + 1, axis=0)
    file[CHECKSUMS][blocks] = hdf5.checksum(*(getattr(solution, name)[rows] for name in STATES))
    # rows count only when their numbers have left for the file
    file.flush()
    file.attrs.modify("rows", rows.stop)
    file.flush()


def _read(file: Any, selected: slice) -> Solution:
    if hdf5.read_label(file, "format") != _FORMAT:
        raise InputError("it is an HDF5 file, but not one that beamfem saved")
    if file.attrs["format_version"] > _FORMAT_VERSION:
        raise InputError(
            f"beamfem {hdf5.read_label(file, 'beamfem_version')} wrote it in format {file.attrs['format_version']}, "
            f"this version reads formats up to {_FORMAT_VERSION}; a newer beamfem can load it"
        )
    rows, all_rows = int(file.attrs["rows"]), int(file.attrs["all_rows"])
    if rows == 0:
        raise InputError("its writing was cut off before the first rows")
    hdf5.require_own(file, AXES)
    model = rebuild(read_text(file, "model"))
    for name in STATES:
        data = file[name]
        if (
            data.compression is None
            and data.id.get_storage_size() < min(rows, len(data)) * prod(data.shape[1:]) * data.dtype.itemsize
        ):
            raise InputError(f"its {name} has {len(data)} rows that were never written")
    sizes = {name: (model.size,) if name != "at" else () for name in STATES}
    if any(len(file[name]) < rows or file[name].shape[1:] != size for name, size in sizes.items()):
        raise InputError(
            f"its arrays do not fit its model of {model.size} coordinates and its {rows} rows: it is damaged, or of a "
            "version of beamfem whose parts have other history variables; compute it again"
        )
    chosen = range(rows)[selected]
    if not chosen or chosen.step < 0:
        raise InputError(f"rows must select some of its {rows} rows in ascending order, got {selected}")
    at, p, v, a = _states(file, rows, np.array(chosen))
    if "statistics" in file:
        saved = dict(read_text(file, "statistics"))
    else:  # in older files these are attributes
        saved = {"static": file.attrs["static"], **json.loads(file.attrs["statistics"])}
    static = bool(saved.pop("static"))
    statistics = _statistics(saved)
    if rows < all_rows:
        ended = f"{statistics.ended}; the file holds {rows} of {all_rows} rows because its writing was cut off"
        statistics = replace(statistics, ended=ended, status=Status.STOPPED)
    optional_arrays: dict[str, Any] = {
        name: hdf5.read_checked(file, name)[:rows][np.array(chosen)] for name in _OPTIONAL if name in file
    }
    events = tuple(
        replace(event, row=min(int(np.searchsorted(at, event.time)), len(at) - 1)) for event in _events(file)
    )
    return load_path(file, Solution(model, static, at, p, v, a, statistics, **optional_arrays, events=events))


def begin_events(file: Any, size: int) -> None:
    """Make the group of events with names of at most some bytes."""
    group = file.create_group(EVENTS)
    for name, kind in (("name", f"S{size}"), ("time", np.float64), ("row", np.int64)):
        hdf5.begin_checked(group, name, (), kind, _BLOCK_EVENTS)


def append_events(file: Any, events: Sequence[Occurrence]) -> None:
    """Write further events."""
    hdf5.extend_checked(file[EVENTS], "name", np.array([event.name.encode() for event in events]))
    for name in ("time", "row"):
        hdf5.extend_checked(file[EVENTS], name, np.array([getattr(event, name) for event in events]))


def _events(file: Any) -> tuple[Occurrence, ...]:
    if EVENTS not in file:
        return ()
    columns = (hdf5.read_checked(file[EVENTS], name).tolist() for name in ("name", "time", "row"))
    return tuple(Occurrence(name.decode(), time, row) for name, time, row in zip(*columns, strict=True))


def as_text(item: Any) -> np.ndarray:
    """Return an object that JSON can represent as an array of one text, which can have a checksum."""
    return np.array([json.dumps(item).encode()])


def read_text(file: Any, name: str) -> Any:
    """Return the object in a text; older versions wrote it without a checksum."""
    return json.loads(hdf5.read_checked(file, name)[0] if file[name].shape else file[name].asstr()[()])


def _states(file: Any, rows: int, chosen: np.ndarray) -> list[np.ndarray]:
    """Return chosen rows (k,) of all states, after a look at each block of rows.

    Raises InputError if rows differ from those that were written; older files have no checksum.
    """
    block, sums = file["at"].chunks[0], file[CHECKSUMS][:].tolist() if CHECKSUMS in file else None
    result = [np.empty((len(chosen), *file[name].shape[1:])) for name in STATES]
    for number, first in enumerate(range(0, rows, block)):
        last = min(first + block, rows)
        parts = [np.asarray(file[name][first:last]) for name in STATES]
        if sums is not None and hdf5.checksum(*parts) != sums[number]:
            raise InputError(f"its rows {first} to {last - 1} are damaged: the checksum is that of other numbers")
        begin, end = np.searchsorted(chosen, [first, last])
        for values, part in zip(result, parts, strict=True):
            values[begin:end] = part[chosen[begin:end] - first]
    return result


def _statistics(saved: dict[str, Any]) -> Statistics:
    """Return the statistics of a file; older files have no status and no warnings."""
    status = Status[saved.pop("status", Status.COMPLETED.name)]
    if np.isnan(saved.get("digits", np.nan)):
        saved.pop("digits", None)  # not known: that of the default, which equals itself
    sequences = {name: tuple(saved.get(name, ())) for name in ("warnings", "rule")}
    return Statistics(**saved | {"status": status} | sequences)
