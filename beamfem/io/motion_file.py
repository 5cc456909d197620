"""Motions that are written into an HDF5 file while they run, with what a run needs to go on from there."""

import os
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import path_of, readable
from beamfem.equations.callbacks import uninterrupted
from beamfem.errors import FileError, InputError, MissingFileError
from beamfem.io import hdf5
from beamfem.io.description import describe, rebuild
from beamfem.io.results_hdf5 import (
    CHECKSUMS,
    EVENTS,
    STATES,
    about,
    append_events,
    as_text,
    begin_events,
    begin_file,
    read_text,
)
from beamfem.model.model import Model
from beamfem.results.motion_state import Occurrence
from beamfem.results.status import Statistics

_BLOCK_BYTES = 2**17  # of rows with a checksum, which are written anew while they are not complete
_TEXT = 2048  # characters of the statistics, so that their place can be used again
_SETTINGS, _CHECKPOINT = "settings", "checkpoint"

# times, and states with what else there is in each row, and events
Rows = tuple[np.ndarray, Sequence[np.ndarray], tuple[Occurrence, ...]]
_OF_ROWS = ("turned", "exchanged")


class MotionFile:
    """An open file of a motion; what it holds is what the last `commit` left, whenever the process ends."""

    def __init__(self, path: str | PathLike[str], create: Callable[[Path], None] | None = None) -> None:
        """create: writes the file, once nobody else does. Raises InputError, FileError and MissingPackageError."""
        self.h5py = hdf5.required_h5py("writing")
        self.path = Path(os.path.realpath(path_of(path) if create else readable(path)))
        self._journal = hdf5.Journal(self.path)
        try:
            self._journal.replay()
            if create is not None:
                create(self.path)
            self._pages = hdf5.Pages(self.path, self._journal)
            try:
                self._file = self.h5py.File(self._pages, "r+", libver=("v108", "v110"))
                if _CHECKPOINT not in self._file:
                    self._file.close()
                    raise InputError(f"{path} cannot be resumed: it holds no motion that simulate wrote with file=")
                self._tail = _last_block(self._file)
                for name in self._file[_CHECKPOINT]:
                    hdf5.read_checked(self._file[_CHECKPOINT], name)
                hdf5.read_checked(self._file, "model")
            except (OSError, LookupError, RuntimeError) as error:
                raise InputError(f"{path} cannot be resumed: it is no HDF5 file, or damaged ({error})") from error
        except BaseException:
            self._journal.close()
            raise

    def close(self) -> None:
        """Close the file; what was not committed is dropped."""
        self._file.close()
        self._pages.close()
        self._journal.close()

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self._file["at"])

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self._file["p"].shape[1])

    @property
    def settings(self) -> dict[str, Any]:
        """What the motion was begun with."""
        return dict(read_text(self._file, _SETTINGS))

    @property
    def checkpoint(self) -> dict[str, np.ndarray]:
        """What the run needs to go on."""
        group = self._file[_CHECKPOINT]
        return {name: hdf5.read_checked(group, name) for name in group}

    def model(self, given: Model | None) -> Model:
        """Return the model given, or that of the file. Raises InputError for another one, or if it has functions."""
        described = read_text(self._file, "model")
        if given is None:
            if described["functions"]:
                raise InputError(
                    f"{self.path} has functions of time, of which it holds values only; give resume the model itself"
                )
            return rebuild(described)
        if as_text(describe(given, np.array(described["at"])))[0] != hdf5.read_checked(self._file, "model")[0]:
            raise InputError(f"{self.path} holds a motion of another model than the one given")
        return given

    @uninterrupted
    def shorten(self, rows: int, events: int) -> None:
        """Keep some rows and events."""
        for name in STATES:
            self._file[name].resize(rows, axis=0)
        for name in ("rows", "all_rows"):
            self._file.attrs.modify(name, rows)
        self._tail = _last_block(self._file)
        _sum(self._file, rows - len(self._tail[0]), self._tail)
        for name in _OF_ROWS:
            if name in self._file:
                hdf5.shorten_checked(self._file, name, rows)
        if EVENTS in self._file:
            for name in self._file[EVENTS]:
                hdf5.shorten_checked(self._file[EVENTS], name, events)

    @uninterrupted
    def commit(
        self,
        rows: Rows,
        statistics: Statistics,
        checkpoint: Mapping[str, np.ndarray],
        begun: dict[str, Any] | None = None,
    ) -> None:
        """Append rows, and replace what the run needs to go on; begun: new settings. Raises FileError."""
        self._tail = _append(self._file, self._tail, rows)
        _write_anew(self._file, "statistics", _padded(as_text(about(False, statistics))))
        for name, values in checkpoint.items():
            _write_anew(self._file[_CHECKPOINT], name, values)
        if begun is not None:
            _write_anew(self._file, _SETTINGS, as_text(begun))
        self._file.flush()
        try:
            self._pages.commit()
        except MissingFileError:
            raise
        except FileError as error:
            raise FileError(f"{error}; the motion up to then is in it, and bf.resume goes on from there") from error

    @uninterrupted
    def describe(self, model: Model, at: np.ndarray | None = None) -> None:
        """Write the functions of a model anew, with values at times [s], by default those of the rows."""
        if read_text(self._file, "model")["functions"]:
            _write_anew(self._file, "model", as_text(describe(model, self._file["at"][:] if at is None else at)))


def created(
    model: Model,
    at: np.ndarray,
    settings: dict[str, Any],
    checkpoint: Mapping[str, np.ndarray],
    statistics: Statistics,
    event_names: Sequence[str],
    rows: Rows,
) -> Callable[[Path], None]:
    """Return what writes the file of a motion with its first rows; at [s]: where its functions are evaluated.

    Raises InputError for a model that cannot be saved. An unfinished motion is not replaced: InputError.
    """
    once = describe(model, at[:1])
    description = as_text(describe(model, at) if once["functions"] else once)
    size = model.size
    block = max(_BLOCK_BYTES // (8 * size), 1)

    def fill(file: Any, require_written: Callable[[], None]) -> None:
        begin_file(file, 0, description, size, block)
        hdf5.write_checked(file, "statistics", _padded(as_text(about(False, statistics))))
        for name, values in zip(_OF_ROWS, rows[1][1:], strict=True):
            if values.shape[1]:
                hdf5.begin_checked(file, name, values.shape[1:], np.float64, block)
        if event_names:
            begin_events(file, max(len(name.encode()) for name in event_names))
        _append(file, _last_block(file), rows)
        hdf5.write_checked(file, _SETTINGS, as_text(settings))
        group = file.create_group(_CHECKPOINT)
        for name, values in checkpoint.items():
            hdf5.write_checked(group, name, values)

    def create(path: Path) -> None:
        _refuse_unfinished(path)
        hdf5.write_hdf5(path, fill)

    return create


def _refuse_unfinished(path: Path) -> None:
    """Raise InputError if a file holds a motion that has not ended."""
    h5py = hdf5.required_h5py("writing")
    try:
        with h5py.File(path, "r") as file:
            unfinished = _CHECKPOINT in file and bool(read_text(file, _SETTINGS)["unfinished"])
    except (OSError, FileError, InputError, KeyError, ValueError):
        return
    if unfinished:
        raise InputError(f"{path} holds a motion that has not ended; resume it, or delete the file")


def _last_block(file: Any) -> list[np.ndarray]:
    """Return the rows of the last block, if it is not complete."""
    rows, block = file["at"].shape[0], file["at"].chunks[0]
    return [np.asarray(file[name][rows - rows % block :]) for name in STATES]


def _append(file: Any, tail: list[np.ndarray], rows: Rows) -> list[np.ndarray]:
    """Append rows, and events; tail: the rows of the last block, if it is not complete. Return those of the new one."""
    times, (states, *others), events = rows
    before, added, block = len(file["at"]), (times, *states.swapaxes(0, 1)), file["at"].chunks[0]
    if events:
        append_events(file, events)
    if not len(times):
        return tail
    for name, values in zip(STATES, added, strict=True):
        file[name].resize(before + len(times), axis=0)
        file[name][before:] = values
    joined = [np.concatenate([old, new]) if len(old) else new for old, new in zip(tail, added, strict=True)]
    _sum(file, before - len(tail[0]), joined)
    for name, values in zip(_OF_ROWS, others, strict=True):
        if name in file:
            hdf5.extend_checked(file, name, values)
    for name in ("rows", "all_rows"):
        file.attrs.modify(name, before + len(times))
    whole = len(joined[0]) - len(joined[0]) % block
    return [values[whole:].copy() for values in joined]


def _sum(file: Any, first: int, states: Sequence[np.ndarray]) -> None:
    """Write the checksums of blocks of rows from one on that begins a block."""
    block, count = file["at"].chunks[0], len(states[0])
    sums = [hdf5.checksum(*(values[at : at + block] for values in states)) for at in range(0, count, block)]
    file[CHECKSUMS].resize(first // block + len(sums), axis=0)
    file[CHECKSUMS][first // block :] = sums


def _padded(text: np.ndarray) -> np.ndarray:
    return text.astype(f"S{max(_TEXT, text.dtype.itemsize)}")


def _write_anew(group: Any, name: str, values: np.ndarray) -> None:
    """Replace an array, in its place if it has the same size."""
    old = group.get(name)
    if old is not None and (old.shape, old.dtype) == (values.shape, values.dtype):
        old[...] = values
        old.attrs.modify("crc32", hdf5.checksum(np.asarray(old)))
        return
    if old is not None:
        del group[name]
    hdf5.write_checked(group, name, values)
