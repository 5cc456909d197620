"""Files that are written whole or not at all: beside their place first, and moved there when all of it is on disk."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from uuid import uuid4

from beamfem.errors import FileError


@contextmanager
def whole(path: str | PathLike[str]) -> Iterator[Path]:
    """Give a path beside `path` to write to, with the same suffix; what is there takes the place of `path` at the end.

    Folders are made. Where writing fails the earlier file stays as it was and nothing is left behind; where the process
    is killed, a file <stem>.<token>.part<suffix>. Raises FileError where the system refuses to write.
    """
    target = Path(os.path.realpath(path))  # a link stays one
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir():
            raise IsADirectoryError(f"{target} is a folder; give the name of a file")
        if target.exists() and not target.is_file():
            yield target  # a pipe or a device: it cannot be replaced
            return
        partial = target.with_name(f"{target.stem}.{uuid4().hex[:8]}.part{target.suffix}")
        try:
            yield partial
            _to_disk(partial)
            os.replace(partial, target)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        reason = error.strerror or str(error)
        raise FileError(f"{path} cannot be written: {reason}; an earlier file of that name is as it was") from error


def _to_disk(path: Path) -> None:
    """Let the system write what it still holds, so that a full disk is known before the earlier file is replaced."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())
