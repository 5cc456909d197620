"""Machine code on disk, in a folder that is named by the content of all kernels and by what it was compiled for."""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from platformdirs import user_cache_path

from beamfem.kernels.compiler import machine

_HERE = Path(__file__).parent
_ENDING = ".code"


@cache
def cache_folder() -> Path | None:
    """Return the folder of machine code of exactly these kernels for this machine, None where none can be written.

    Kernels call one another by number and share layouts, so that the code of all of them is in the name: machine code
    of other sources is never found, whatever their times and whoever else writes. Each kind of processor has a folder
    of its own in it, since machines may share a home.
    """
    sources = sorted(_HERE.rglob("*.py"))
    if not sources:  # imported from an archive
        return None
    digest = hashlib.sha256(b"".join(source.name.encode() + source.read_bytes() for source in sources))
    for parent in _parents():
        of_sources = parent / f"beamfem-{digest.hexdigest()[:16]}"
        folder = of_sources / hashlib.sha256(machine.description().encode()).hexdigest()[:8]
        try:
            _clear_others(of_sources)
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return None


def _parents() -> Iterator[Path]:
    """Yield where machine code may be kept, the first that can be written is taken."""
    named = os.environ.get("BEAMFEM_CACHE_DIR") or os.environ.get("NUMBA_CACHE_DIR")  # which names it for others too
    if named:
        yield Path(named)
        return
    yield _HERE / "__pycache__"
    of_the_user = user_cache_path("beamfem", appauthor=False)
    if of_the_user.is_absolute():  # it is not where the user has no home
        yield of_the_user


def _clear_others(folder: Path) -> None:
    """Remove machine code of earlier sources, beside the sources only: elsewhere other installations have theirs."""
    if folder.parent.parent != _HERE or folder.exists():
        return
    for other in folder.parent.glob("beamfem-*"):
        shutil.rmtree(other, ignore_errors=True)


def kept() -> int:
    """Return how many kernels are found compiled on disk."""
    folder = cache_folder()
    return len(list(folder.glob(f"*{_ENDING}"))) if folder else 0


def found(name: str) -> bytes | None:
    """Return the machine code of a kernel, None where there is none or its file is damaged."""
    folder = cache_folder()
    try:
        content = (folder / (name + _ENDING)).read_bytes() if folder else b""
    except OSError:
        return None
    digest, code = content[:32], content[32:]
    return code if code and hashlib.sha256(code).digest() == digest else None


def keep(name: str, code: bytes) -> None:
    """Write the machine code of a kernel, at once or not at all; where that is not possible work goes on."""
    folder = cache_folder()
    if folder is None:
        return
    part = ""
    try:
        handle, part = tempfile.mkstemp(dir=folder)
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(code).digest() + code)
        os.replace(part, folder / (name + _ENDING))
    except OSError:  # of a disk that is full, or a folder that has been removed
        if part:
            Path(part).unlink(missing_ok=True)
