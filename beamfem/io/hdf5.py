"""HDF5 files with checksums, written completely or not at all, or changing as a whole while they grow."""

import io
import os
import signal
import struct
import time
from collections.abc import Callable
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np

from beamfem.atomic_write import whole
from beamfem.equations.callbacks import Deferred
from beamfem.errors import FileError, InputError, MissingFileError
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


try:
    import fcntl
except ImportError:  # not on Windows, where nothing keeps two processes apart
    fcntl = None  # type: ignore[assignment]

_PAGE = 1 << 14
_PATIENCE, _PAUSE = 100, 0.02  # how often to try for a lock, and the seconds between
_MAGIC = b"beamfem1"
_HEAD = struct.Struct("<8sqqqI")  # mark, inode and size of the file, bytes of pages that follow, their checksum
_NUMBER = struct.Struct("<q")


class Journal:
    """The file beside another one, <name>.journal, that holds what is about to be written there.

    Its lock, which ends with the process, tells that the other file is being written.
    """

    def __init__(self, path: Path) -> None:
        """Raises InputError if another process writes the file, FileError if the system refuses."""
        self._of, self._path = path, path.with_name(f"{path.name}.journal")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            while True:
                self._file = _opened(self._path, os.O_RDWR | os.O_CREAT)
                if not _locked(self._file):
                    os.close(self._file)
                    raise InputError(f"{path} is being written by another process")
                if self._path.exists() and os.path.samestat(os.fstat(self._file), self._path.stat()):
                    return
                os.close(self._file)  # its last owner has just removed it
        except OSError as error:
            raise FileError(f"{path} cannot be written: {error.strerror or error}") from error

    def replay(self) -> None:
        """Write what a killed process left behind. Raises FileError."""
        data = self._path.read_bytes()
        if len(data) < _HEAD.size or not self._of.is_file():
            return
        mark, inode, size, length, found = _HEAD.unpack_from(data)
        pages = data[_HEAD.size :]
        if mark == _MAGIC and inode == self._of.stat().st_ino and length == len(pages) and found == crc32(pages):
            self._apply(pages, size)

    def write(self, pages: dict[int, bytearray], size: int, inode: int) -> None:
        """Change pages, and the size, of the file.

        Raises FileError; the file then is as it was, or as `replay` makes it.
        """
        if not self._of.exists() or self._of.stat().st_ino != inode:
            raise MissingFileError(f"{self._of} was replaced or removed while a motion was written into it")
        data = b"".join(part for number, page in pages.items() for part in (_NUMBER.pack(number), page))
        try:
            _put(self._file, _HEAD.pack(_MAGIC, inode, size, len(data), crc32(data)) + data, 0)
            os.fsync(self._file)
        except OSError as error:
            with suppress(OSError):
                os.ftruncate(self._file, 0)
            raise FileError(f"{self._of} cannot be written: {error.strerror or error}") from error
        self._apply(data, size)

    def _apply(self, data: bytes, size: int) -> None:
        try:
            target = _opened(self._of, os.O_RDWR)
            try:
                _wait_for_readers(target)
                for at in range(0, len(data), _NUMBER.size + _PAGE):
                    begin = _NUMBER.unpack_from(data, at)[0] * _PAGE
                    page = memoryview(data)[at + _NUMBER.size : at + _NUMBER.size + _PAGE]
                    _put(target, page[: max(size - begin, 0)], begin)
                os.ftruncate(target, size)
                os.fsync(target)
            finally:
                os.close(target)
            os.ftruncate(self._file, 0)
        except OSError as error:
            raise FileError(f"{self._of} cannot be written: {error.strerror or error}") from error

    def close(self) -> None:
        """End the lock; the file stays only where it has something to replay."""
        with suppress(OSError):
            if os.fstat(self._file).st_size == 0:
                self._path.unlink()
        os.close(self._file)


def being_written(path: Path) -> bool:
    """Return whether a process has begun to write a file and not ended it."""
    return os.path.exists(f"{path}.journal")  # False for a name that is too long


def replay(path: Path) -> None:
    """Complete what a killed process was about to write, if it is not being written now."""
    if not being_written(path):
        return
    with suppress(InputError, FileError):
        journal = Journal(path)
        try:
            journal.replay()
        finally:
            journal.close()


class Pages(io.RawIOBase):
    """A file whose changes stay in memory, by pages, until `commit`.

    HDF5 calls it and ignores what it raises: the first error in reading is raised by `commit`.
    """

    def __init__(self, path: Path, journal: Journal) -> None:
        self._file, self._journal = _opened(path, os.O_RDONLY), journal
        self._stored = self._size = os.fstat(self._file).st_size
        self._at, self._error = 0, None
        self._pages: dict[int, bytearray] = {}

    _error: BaseException | None

    def commit(self) -> None:
        """Write all changes. Raises FileError, and from then on, since the journal may hold what `replay` needs."""
        if self._error is not None:
            raise self._error
        try:
            self._journal.write(self._pages, self._size, os.fstat(self._file).st_ino)
        except BaseException as error:
            self._error = error
            raise
        self._pages, self._stored = {}, self._size

    def close(self) -> None:
        """Close the file; changes since the last `commit` are dropped."""
        if not self.closed:
            os.close(self._file)
        super().close()

    def tell(self) -> int:
        return self._at

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._at = offset + (0, self._at, self._size)[whence]
        return self._at

    def truncate(self, size: int | None = None) -> int:
        self._size = self._at if size is None else size
        self._stored = min(self._stored, self._size)
        return self._size

    def readinto(self, buffer: Any) -> int:
        into = memoryview(buffer).cast("B")
        count, done = min(len(into), max(self._size - self._at, 0)), 0
        while done < count:
            number, inside = divmod(self._at, _PAGE)
            part = min(_PAGE - inside, count - done)
            page = self._pages.get(number) or self._page(number)
            into[done : done + part] = page[inside : inside + part]
            done, self._at = done + part, self._at + part
        return count

    def write(self, data: Any) -> int:
        given, done = memoryview(data).cast("B"), 0
        while done < len(given):
            number, inside = divmod(self._at, _PAGE)
            part = min(_PAGE - inside, len(given) - done)
            if number not in self._pages:
                self._pages[number] = self._page(number)
            self._pages[number][inside : inside + part] = given[done : done + part]
            done, self._at = done + part, self._at + part
        self._size = max(self._size, self._at)
        return len(given)

    def _page(self, number: int) -> bytearray:
        """Return a page as it is on disk, zero beyond the end."""
        result = bytearray(_PAGE)
        if number * _PAGE < self._stored:
            try:
                os.lseek(self._file, number * _PAGE, os.SEEK_SET)
                data = os.read(self._file, _PAGE)
                result[: len(data)] = data
            except OSError as error:
                self._error = self._error or error
        return result


def _opened(path: Path, how: int) -> int:
    return os.open(path, how | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0), 0o666)


def _locked(file: int) -> bool:
    if fcntl is None:
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


def _wait_for_readers(file: int) -> None:
    """Lock a file against readers by HDF5, which lock it too; wait for those that read it, but not for long."""
    for _ in range(_PATIENCE):
        if _locked(file):
            return
        time.sleep(_PAUSE)


def opened_once_written(h5py: Any, path: Path) -> Any:
    """Return an HDF5 file opened to read, once the process that is changing it has done so."""
    for _ in range(_PATIENCE):
        try:
            return h5py.File(path, "r")
        except BlockingIOError:
            time.sleep(_PAUSE)
    return h5py.File(path, "r")


def _put(file: int, data: bytes | memoryview, at: int) -> None:
    os.lseek(file, at, os.SEEK_SET)
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(file, rest) :]
