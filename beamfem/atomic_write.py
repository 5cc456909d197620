"""Files of the user: their paths checked, read where they can be, written whole or not at all.

What is written is written beside its place first, and moved there when all of it is on disk.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from uuid import uuid4

from beamfem.errors import FileError, InputError, MissingFileError
from beamfem.validation import shown

_STEM = 40  # characters that a file beside its place takes of its name, as systems allow 255 bytes in all


def path_of(path: str | PathLike[str]) -> Path:
    """Return a path. Raises InputError for what is none."""
    try:
        text = os.fspath(path)
    except TypeError:
        text = None
    if not isinstance(text, str) or not text or "\0" in text:
        raise InputError(f'a path is a text such as "out/result.h5", or a pathlib.Path, got {shown(path)}')
    return Path(text)


def path_ending(path: str | PathLike[str], kind: str, *suffixes: str, example: str) -> Path:
    """Return the path of a file of a kind with one of some suffixes. Raises InputError, with what would be right."""
    target = path_of(path)
    if target.suffix.lower() not in suffixes:
        right = target.with_suffix(suffixes[0]) if target.name else target / example
        raise InputError(f'{kind} is a {" or a ".join(suffixes)} file, got "{target}"; "{right}" would be right')
    return target


def readable(path: str | PathLike[str]) -> Path:
    """Return the path of a file that can be opened. Raises InputError, FileNotFoundError, FileError."""
    source = path_of(path)
    try:
        if source.exists() and not source.is_file():
            raise FileError(f"{source} cannot be read: it is a folder, a device or a pipe; give a file")
        with source.open("rb"):
            return source
    except FileNotFoundError:
        raise MissingFileError(f"there is no file {source}") from None
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{source} cannot be read: {error.strerror or error}") from error


def make_folder(folder: Path) -> None:
    """Make a folder and those above it where they are not there. Raises FileError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"the folder {folder} cannot be made: {error.strerror or error}") from error


@contextmanager
def whole(path: str | PathLike[str]) -> Iterator[Path]:
    """Give a path beside `path` to write to, with the same suffix; what is there takes the place of `path` at the end.

    Folders are made. Where writing fails the earlier file stays as it was and nothing is left behind; where the process
    is killed, a file <stem>.<token>.part<suffix>. Raises InputError for what is no path, FileError if the system
    refuses to write.
    """
    target = Path(os.path.realpath(path_of(path)))  # a link stays one
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir():
            raise IsADirectoryError(f"{target} is a folder; give the name of a file")
        if target.exists() and not target.is_file():
            yield target  # a pipe or a device: it cannot be replaced
            return
        partial = target.with_name(f"{target.stem[:_STEM]}.{uuid4().hex[:8]}.part{target.suffix}")
        try:
            yield partial
            with partial.open("rb+") as file:
                os.fsync(file.fileno())  # a full disk is known before the earlier file is replaced
            os.replace(partial, target)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        reason = error.strerror or str(error)
        raise FileError(f"{path} cannot be written: {reason}; an earlier file of that name is as it was") from error
