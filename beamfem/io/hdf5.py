"""HDF5 files with checksums, written completely or not at all."""

import io
import signal
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np

from beamfem.atomic_write import whole
from beamfem.equations.callbacks import Deferred
from beamfem.errors import InputError
from beamfem.extras import needed_for

# object headers of this version have checksums; those of later ones mark a file whose writer was killed as unreadable
_VERSIONS = ("v108", "v110")
_CHECKSUM = "crc32"


def write_hdf5(path: str | PathLike[str], fill: Callable[[Any, Callable[[], None]], None]) -> None:
    """Call `fill` with an open HDF5 file, which then replaces `path`, and a check that all so far was written.

    HDF5 calls the stream and ignores what it raises, so handlers of signals run in the check, or at the end. Raises
    FileError if the system refuses to write, MissingPackageError without h5py, and what handlers raise.
    """
    h5py = required_h5py("writing")
    deferred = Deferred(signal.valid_signals())
    try:
        with deferred, whole(path) as partial, _Stream(partial) as stream:

            def require_written() -> None:
                deferred.handle()
                stream.require()

            try:
                with h5py.File(stream, "w", libver=_VERSIONS) as file:
                    fill(file, require_written)
            finally:
                stream.require()
    finally:
        deferred.deliver()


def required_h5py(purpose: str) -> Any:
    """Return the module h5py. Raises MissingPackageError if it is not installed."""
    with needed_for(f"{purpose} HDF5 files"):
        import h5py
    return h5py


def write_checked(group: Any, name: str, values: np.ndarray) -> None:
    """Write an array with a checksum: HDF5's own does not cover the positions of an array's chunks."""
    group.create_dataset(name, data=values).attrs[_CHECKSUM] = checksum(values)


def begin_checked(group: Any, name: str, row: tuple[int, ...], kind: Any, rows: int) -> None:
    """Make an array of rows that `extend_checked` appends; rows: in a chunk of the file."""
    made = group.create_dataset(name, (0, *row), kind, maxshape=(None, *row), chunks=(rows, *row))
    made.attrs[_CHECKSUM] = checksum()


def extend_checked(group: Any, name: str, values: np.ndarray) -> None:
    """Append rows to an array with a checksum."""
    data = group[name]
    before = len(data)
    data.resize(before + len(values), axis=0)
    data[before:] = values
    data.attrs.modify(_CHECKSUM, checksum(values.astype(data.dtype), begin=int(data.attrs[_CHECKSUM])))


def shorten_checked(group: Any, name: str, rows: int) -> None:
    """Keep some rows of an array with a checksum."""
    data = group[name]
    data.resize(rows, axis=0)
    parts = (data[first : first + data.chunks[0]] for first in range(0, rows, data.chunks[0]))
    data.attrs.modify(_CHECKSUM, checksum(*parts))


def read_checked(group: Any, name: str) -> np.ndarray:
    """Return an array. Raises InputError if it differs from what was written; older files have no checksum."""
    data = group[name]
    values = np.asarray(data)
    if _CHECKSUM in data.attrs and checksum(values) != int(data.attrs[_CHECKSUM]):
        raise InputError(f"its {name} is damaged: the checksum is that of other numbers")
    return values


def require_own(group: Any, *besides: str) -> None:
    """Raise InputError for a link to another file, or an array stored in one; besides: members that nobody reads.

    A file that somebody sent must not read others of the user.
    """
    h5py = required_h5py("loading")
    for name in group:
        link = group.get(name, getlink=True)
        if name in besides:
            continue
        if not isinstance(link, h5py.HardLink):
            raise InputError(f"its {name} is a link; beamfem reads only what is in the file itself")
        item = group[name]
        if isinstance(item, h5py.Group):
            require_own(item)
        elif isinstance(item, h5py.Dataset) and (item.external or item.is_virtual):
            raise InputError(f"the numbers of its {name} are in another file; beamfem reads only the file itself")


def write_label(group: Any, name: str, label: str) -> None:
    """Write an attribute of fixed length: in a damaged file HDF5 may search endlessly for one of variable length."""
    group.attrs[name] = np.bytes_(label)


def read_label(group: Any, name: str) -> str:
    """Return a text attribute, '' if there is none; older versions wrote it with variable length."""
    label = group.attrs.get(name, "")
    return label.decode() if isinstance(label, bytes) else str(label)


def checksum(*arrays: np.ndarray, begin: int = 0) -> int:
    """Return the CRC-32 of arrays, one after the other; begin: that of what is before them."""
    result = begin
    for values in arrays:
        result = crc32(np.ascontiguousarray(values).tobytes(), result)
    return result


class _Stream(io.FileIO):
    """A file that records the first error and continues as if there were none.

    HDF5 cannot close a file that it cannot write: it would crash the process on exit.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(path, "w+")
        self._error: BaseException | None = None

    def write(self, data: Any) -> int:
        size: int = data.nbytes if isinstance(data, memoryview) else len(data)
        try:
            written = 0
            while self._error is None and written < size:
                written += super().write(memoryview(data).cast("B")[written:])
        except BaseException as error:
            self._error = error
        return size

    def truncate(self, size: int | None = None) -> int:
        try:
            return super().truncate(size)
        except BaseException as error:
            self._error = self._error or error
            return size or 0

    def require(self) -> None:
        """Raise the recorded error."""
        if self._error is not None:
            raise self._error
