"""Solutions in HDF5 files: the model described in JSON, the states in rows."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from importlib.metadata import version
from math import prod
from os import PathLike
from typing import Any

import numpy as np

from beamfem.atomic_write import readable
from beamfem.errors import InputError
from beamfem.io.description import describe, rebuild
from beamfem.io.hdf5 import (
    begin_checked,
    checksum,
    extend_checked,
    read_checked,
    read_label,
    require_own,
    required_h5py,
    write_checked,
    write_hdf5,
    write_label,
)
from beamfem.io.hdf5_arrays import AXES, load_factors, load_path, save_axes, save_critical
from beamfem.results.motion_state import Occurrence
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics, Status

FORMAT = "beamfem solution"
_FORMAT_VERSION = 1
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_BLOCK_BYTES = 2**20
_STATES = ("at", "p", "v", "a")
_OPTIONAL = ("stability", "turned", "loaded")
_CHECKSUMS = "checksums"  # of each block of rows
_EVENTS = "events"
_BLOCK_EVENTS = 64


def save(solution: Solution, path: str | PathLike[str]) -> None:
    """Write model and states into one HDF5 file with checksums, see `Solution.save`."""
    at = np.append(solution.at, load_factors(solution)) if isinstance(solution, EquilibriumPath) else solution.at
    description = _text(describe(solution.model, at))
    block = max(min(_BLOCK_BYTES // (8 * solution.p.shape[1]), len(solution)), 1)

    def fill(file: Any, require_written: Callable[[], None]) -> None:
        write_label(file, "format", FORMAT)
        file.attrs["format_version"] = _FORMAT_VERSION
        write_label(file, "beamfem_version", version("beamfem"))
        about = asdict(solution.statistics) | {"status": solution.status.name}
        write_checked(file, "statistics", _text({"static": solution.static, **about}))
        file.attrs["all_rows"] = len(solution)
        file.attrs["rows"] = 0
        write_checked(file, "model", description)
        for name in _OPTIONAL:
            values = getattr(solution, name)
            if values is not None and values.size:
                write_checked(file, name, values)
        for name in _STATES:
            row = getattr(solution, name).shape[1:]
            file.create_dataset(name, (0, *row), np.float64, maxshape=(None, *row), chunks=(block, *row))
        file.create_dataset(_CHECKSUMS, (0,), np.int64, maxshape=(None,))
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

    write_hdf5(path, fill)


def load(path: str | PathLike[str]) -> Solution:
    """Return the solution stored in a file.

    Functions of time are returned as `Sampled`, their values at the saved rows. If the writing process was killed, the
    rows written so far are returned.

    Parameters
    ----------
    path : path
        A file that `Solution.save` wrote.

    Returns
    -------
    Solution
        The model with its states; a `Path` for a path.

    Raises
    ------
    FileError
        If the system refuses to read the file; FileNotFoundError if there is none.
    InputError
        If the file is damaged, of a newer format or not of beamfem.
    MissingPackageError
        Without h5py.

    Examples
    --------
    >>> solution.save("cantilever.h5")
    >>> bf.load("cantilever.h5").at
    array([0., 1.])
    """
    h5py = required_h5py("loading")
    source = readable(path)
    with source.open("rb") as stream:
        if stream.read(len(_SIGNATURE)) != _SIGNATURE:
            raise InputError(f"{source} is not a file that beamfem saved: it is no HDF5 file")
    try:
        with h5py.File(source, "r") as file:
            return _read(file)
    except InputError as error:
        raise InputError(f"{source} cannot be loaded: {error}") from error
    except MemoryError as error:
        raise InputError(f"{source} cannot be loaded: it needs more memory than there is") from error
    except (
        OSError,
        KeyError,
        IndexError,
        TypeError,
        ValueError,
        RuntimeError,
        AssertionError,
        AttributeError,
    ) as error:
        message = f"{source} cannot be loaded: it is truncated, damaged or still being written ({error})"
        raise InputError(message) from error


def _append(file: Any, solution: Solution, rows: slice) -> None:
    for name in _STATES:
        file[name].resize(rows.stop, axis=0)
        file[name][rows] = getattr(solution, name)[rows]
    blocks = len(file[_CHECKSUMS])
    file[_CHECKSUMS].resize(blocks + 1, axis=0)
    file[_CHECKSUMS][blocks] = checksum(*(getattr(solution, name)[rows] for name in _STATES))
    # rows count only when their numbers have left for the file
    file.flush()
    file.attrs.modify("rows", rows.stop)
    file.flush()


def _read(file: Any) -> Solution:
    if read_label(file, "format") != FORMAT:
        raise InputError("it is an HDF5 file, but not one that beamfem saved")
    if file.attrs["format_version"] > _FORMAT_VERSION:
        raise InputError(
            f"beamfem {read_label(file, 'beamfem_version')} wrote it in format {file.attrs['format_version']}, this "
            f"version reads formats up to {_FORMAT_VERSION}; a newer beamfem can load it"
        )
    rows, all_rows = int(file.attrs["rows"]), int(file.attrs["all_rows"])
    if rows == 0:
        raise InputError("its writing was cut off before the first rows")
    require_own(file, AXES)
    model = rebuild(_read_text(file, "model"))
    for name in _STATES:
        data = file[name]
        if (
            data.compression is None
            and data.id.get_storage_size() < min(rows, len(data)) * prod(data.shape[1:]) * data.dtype.itemsize
        ):
            raise InputError(f"its {name} has {len(data)} rows that were never written")
    at, p, v, a = (np.asarray(file[name][:rows]) for name in _STATES)
    if at.shape != (rows,) or any(values.shape != (rows, model.size) for values in (p, v, a)):
        raise InputError(f"its arrays do not fit its model of {model.size} coordinates and its {rows} rows")
    about = _about(file)
    static = bool(about.pop("static"))
    statistics = _statistics(about)
    if rows < all_rows:
        ended = f"{statistics.ended}; the file holds {rows} of {all_rows} rows because its writing was cut off"
        statistics = replace(statistics, ended=ended, status=Status.STOPPED)
    _require_whole(file, rows, (at, p, v, a))
    optional_arrays: dict[str, Any] = {name: read_checked(file, name)[:rows] for name in _OPTIONAL if name in file}
    return load_path(file, Solution(model, static, at, p, v, a, statistics, **optional_arrays, events=_events(file)))


def begin_events(file: Any, size: int) -> None:
    """Make the group of events with names of at most some bytes."""
    group = file.create_group(_EVENTS)
    for name, kind in (("name", f"S{size}"), ("time", np.float64), ("row", np.int64)):
        begin_checked(group, name, (), kind, _BLOCK_EVENTS)


def append_events(file: Any, events: Sequence[Occurrence]) -> None:
    """Write further events."""
    extend_checked(file[_EVENTS], "name", np.array([event.name.encode() for event in events]))
    for name in ("time", "row"):
        extend_checked(file[_EVENTS], name, np.array([getattr(event, name) for event in events]))


def _events(file: Any) -> tuple[Occurrence, ...]:
    if _EVENTS not in file:
        return ()
    columns = (read_checked(file[_EVENTS], name).tolist() for name in ("name", "time", "row"))
    return tuple(Occurrence(name.decode(), time, row) for name, time, row in zip(*columns, strict=True))


def _text(item: Any) -> np.ndarray:
    """Return an object that JSON can represent as an array of one text, which can have a checksum."""
    return np.array([json.dumps(item).encode()])


def _read_text(file: Any, name: str) -> Any:
    """Return the object in a text; older versions wrote it without a checksum."""
    return json.loads(read_checked(file, name)[0] if file[name].shape else file[name].asstr()[()])


def _require_whole(file: Any, rows: int, states: tuple[np.ndarray, ...]) -> None:
    """Raise InputError if rows differ from those that were written; older files have no checksum."""
    if _CHECKSUMS not in file:
        return
    block, sums = file["at"].chunks[0], file[_CHECKSUMS][:].tolist()
    for number, first in enumerate(range(0, rows, block)):
        last = min(first + block, rows)
        if checksum(*(values[first:last] for values in states)) != sums[number]:
            raise InputError(f"its rows {first} to {last - 1} are damaged: the checksum is that of other numbers")


def _about(file: Any) -> dict[str, Any]:
    """Return the statistics and whether the solution is static; in older files these are attributes."""
    if "statistics" in file:
        return dict(_read_text(file, "statistics"))
    return {"static": file.attrs["static"], **json.loads(file.attrs["statistics"])}


def _statistics(saved: dict[str, Any]) -> Statistics:
    """Return the statistics of a file; older files have no status and no warnings."""
    status = Status[saved.pop("status", Status.COMPLETED.name)]
    if np.isnan(saved.get("digits", np.nan)):
        saved.pop("digits", None)  # not known: that of the default, which equals itself
    sequences = {name: tuple(saved.get(name, ())) for name in ("warnings", "rule")}
    return Statistics(**saved | {"status": status} | sequences)
