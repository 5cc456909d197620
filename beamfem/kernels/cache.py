"""Cache of machine code on disk, in a folder named by hashes of all kernel sources and of the target machine."""

import hashlib
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from time import time
from uuid import uuid4

from platformdirs import user_cache_path

from beamfem.kernels.compiler import machine

_FOLDERS = Path(__file__).parent, Path(__file__).parents[1] / "physics"  # from which some kernels are derived
_ENDING = ".code"
_OLD = 90 * 86400  # [s]


def _digest() -> str | None:
    """Return a hash of the sources of all kernels; None if they are not files, as in an archive."""
    try:
        every = (file for folder in _FOLDERS for file in sorted(folder.rglob("*.py")))
        files = [file for file in every if not file.name.startswith(".") and file.is_file()]
        content = b"".join(file.name.encode() + file.read_bytes() for file in files)
    except OSError:
        return None
    return hashlib.sha256(content).hexdigest()[:16] if files else None


_SOURCES = _digest()  # at import, because the files may change while a process runs


@cache
def cache_folder() -> Path | None:
    """Return the writable folder for machine code of exactly these kernels on this machine, None if there is none.

    A folder that others own or may write is not used: machine code in it could be anybody's.

    Kernels call one another by number and share data layouts, so the name of the folder depends on all sources: machine
    code of other sources is never loaded, whatever the file times are and whichever processes write. It has a subfolder
    for each kind of processor, since machines may share a home directory.
    """
    for folder in _folders():
        try:
            _clear_old(folder.parent)
            folder.parent.parent.mkdir(parents=True, exist_ok=True)
            for own in (folder.parent, folder):
                own.mkdir(mode=0o755, exist_ok=True)  # whatever the umask is, no one else may write
            if not _trusted(folder):
                continue
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return None


@cache
def _folders() -> tuple[Path, ...]:
    """Return the folders that may contain machine code, in the order in which they are tried."""
    if _SOURCES is None:
        return ()
    target = hashlib.sha256(machine.description().encode()).hexdigest()[:8]
    return tuple(parent / f"beamfem-{_SOURCES}" / target for parent in _parents())


def _parents() -> Iterator[Path]:
    """Yield the candidate locations of the cache, of which the first writable one is used."""
    # NUMBA_CACHE_DIR: a user who has set it for other packages wants compiled code there
    named = os.environ.get("BEAMFEM_CACHE_DIR") or os.environ.get("NUMBA_CACHE_DIR")
    if named:
        yield Path(named).absolute()
        return
    with suppress(RuntimeError, KeyError):  # the user has no home directory
        of_the_user = user_cache_path("beamfem", appauthor=False)
        if of_the_user.is_absolute():
            yield of_the_user


def _clear_old(folder: Path) -> None:
    """Remove machine code of other sources that is old, before the first of these sources."""
    if folder.exists():
        return
    for other in folder.parent.glob("beamfem-*"):
        with suppress(OSError):
            if max(each.stat().st_mtime for each in [other, *other.iterdir()]) < time() - _OLD:
                shutil.rmtree(other, ignore_errors=True)


def _trusted(folder: Path) -> bool:
    """Return whether only the user and root could write a folder of machine code, which is run unseen."""
    return all(stat.S_ISDIR(own.lstat().st_mode) and _safe(own.lstat()) for own in (folder.parent, folder))


def _safe(about: os.stat_result) -> bool:
    """Return whether a file is of the user or root, and nobody else may write it."""
    return os.name != "posix" or (about.st_uid in (0, os.geteuid()) and not about.st_mode & 0o022)


def _content(file: Path) -> bytes:
    """Return the content of a regular file that nobody else could have written; otherwise nothing. No FIFO waits."""
    flags = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(file, os.O_RDONLY | flags), "rb") as stream:
        about = os.fstat(stream.fileno())
        return stream.read() if stat.S_ISREG(about.st_mode) and _safe(about) else b""


def kept() -> int:
    """Return the number of compiled kernels on disk."""
    return len({file.name for folder in _folders() for file in folder.glob(f"*{_ENDING}")})


def found(name: str) -> bytes | None:
    """Return the machine code of a kernel, None if it is not on disk or its file is damaged."""
    for folder in _folders():
        with suppress(OSError):
            content = _content(folder / (name + _ENDING)) if _trusted(folder) else b""
            digest, code = content[:32], content[32:]
            if code and hashlib.sha256(code).digest() == digest:
                return code
    return None


def keep(name: str, code: bytes) -> None:
    """Write the machine code of a kernel atomically; ignore failures, since the code only saves time later."""
    folder = cache_folder()
    if folder is None or _digest() != _SOURCES:
        return
    part = folder / f"{uuid4().hex}.part"
    try:
        part.write_bytes(hashlib.sha256(code).digest() + code)
        part.chmod(0o644)  # whatever the umask is
        os.replace(part, folder / (name + _ENDING))
    except OSError:  # the disk is full, or the folder has been removed
        with suppress(OSError):
            part.unlink(missing_ok=True)
