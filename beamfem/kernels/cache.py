"""Machine code on disk, in a folder that is named by the content of all kernels and by what it was compiled for."""

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
    """Return what the sources of all kernels are, in short; None if they are not files, as in an archive."""
    try:
        files = [file for file in sorted(_HERE.rglob("*.py")) if not file.name.startswith(".") and file.is_file()]
        content = b"".join(file.name.encode() + file.read_bytes() for file in files)
    except OSError:
        return None
    return hashlib.sha256(content).hexdigest()[:16] if files else None


_SOURCES = _digest()  # when they were imported: they may change while a process runs


@cache
def cache_folder() -> Path | None:
    """Return the folder of machine code of exactly these kernels for this machine, None if none can be written.

    Kernels call one another by number and share layouts, so that the code of all of them is in the name: machine code
    of other sources is never found, whatever their times and whoever else writes. Each kind of processor has a folder
    of its own in it, since machines may share a home.
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
    """Return where machine code may be found, in the order in which folders are tried."""
    if _SOURCES is None:
        return ()
    target = hashlib.sha256(machine.description().encode()).hexdigest()[:8]
    return tuple(parent / f"beamfem-{_SOURCES}" / target for parent in _parents())


def _parents() -> Iterator[Path]:
    """Yield where machine code may be kept, the first that can be written is taken."""
    named = os.environ.get("BEAMFEM_CACHE_DIR") or os.environ.get("NUMBA_CACHE_DIR")  # which names it for others too
    if named:
        yield Path(named).absolute()
        return
    yield _HERE / "__pycache__"
    with suppress(RuntimeError, KeyError):  # of a user without a home
        of_the_user = user_cache_path("beamfem", appauthor=False)
        if of_the_user.is_absolute():
            yield of_the_user


def _clear_others(folder: Path) -> None:
    """Remove machine code of earlier sources, beside the sources only: elsewhere other installations have theirs."""
    if folder.parent.parent != _HERE or folder.exists():
        return
    for other in folder.parent.glob("beamfem-*"):
        shutil.rmtree(other, ignore_errors=True)


def kept() -> int:
    """Return how many kernels are found compiled on disk."""
    return len({file.name for folder in _folders() for file in folder.glob(f"*{_ENDING}")})


def found(name: str) -> bytes | None:
    """Return the machine code of a kernel, None if there is none or its file is damaged."""
    for folder in _folders():
        with suppress(OSError):
            content = (folder / (name + _ENDING)).read_bytes()
            digest, code = content[:32], content[32:]
            if code and hashlib.sha256(code).digest() == digest:
                return code
    return None


def keep(name: str, code: bytes) -> None:
    """Write the machine code of a kernel, at once or not at all; where that is not possible work goes on."""
    folder = cache_folder()
    if folder is None or _digest() != _SOURCES:
        return
    part = folder / f"{uuid4().hex}.part"
    try:
        part.write_bytes(hashlib.sha256(code).digest() + code)
        os.replace(part, folder / (name + _ENDING))
    except OSError:  # of a disk that is full, or a folder that has been removed
        with suppress(OSError):
            part.unlink(missing_ok=True)
