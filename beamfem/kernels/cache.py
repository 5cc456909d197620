"""Cache of machine code on disk, in a folder named by hashes of all kernel sources and of the target machine."""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from uuid import uuid4

from platformdirs import user_cache_path

from beamfem.kernels.compiler import machine

_HERE = Path(__file__).parent
_ENDING = ".code"


def _digest() -> str | None:
    """Return a hash of the sources of all kernels; None if they are not files, as in an archive."""
    try:
        files = [file for file in sorted(_HERE.rglob("*.py")) if not file.name.startswith(".") and file.is_file()]
        content = b"".join(file.name.encode() + file.read_bytes() for file in files)
    except OSError:
        return None
    return hashlib.sha256(content).hexdigest()[:16] if files else None


_SOURCES = _digest()  # at import, because the files may change while a process runs


@cache
def cache_folder() -> Path | None:
    """Return the writable folder for machine code of exactly these kernels on this machine, None if there is none.

    Kernels call one another by number and share data layouts, so the name of the folder depends on all sources: machine
    code of other sources is never loaded, whatever the file times are and whichever processes write. It has a subfolder
    for each kind of processor, since machines may share a home directory.
    """
    for folder in _folders():
        try:
            _clear_others(folder.parent)
            folder.mkdir(parents=True, exist_ok=True)
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
    yield _HERE / "__pycache__"
    with suppress(RuntimeError, KeyError):  # the user has no home directory
        of_the_user = user_cache_path("beamfem", appauthor=False)
        if of_the_user.is_absolute():
            yield of_the_user


def _clear_others(folder: Path) -> None:
    """Remove machine code of earlier sources, but only next to the sources; other installations share other folders."""
    if folder.parent.parent != _HERE or folder.exists():
        return
    for other in folder.parent.glob("beamfem-*"):
        shutil.rmtree(other, ignore_errors=True)


def kept() -> int:
    """Return the number of compiled kernels on disk."""
    return len({file.name for folder in _folders() for file in folder.glob(f"*{_ENDING}")})


def found(name: str) -> bytes | None:
    """Return the machine code of a kernel, None if it is not on disk or its file is damaged."""
    for folder in _folders():
        with suppress(OSError):
            content = (folder / (name + _ENDING)).read_bytes()
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
        os.replace(part, folder / (name + _ENDING))
    except OSError:  # the disk is full, or the folder has been removed
        with suppress(OSError):
            part.unlink(missing_ok=True)
