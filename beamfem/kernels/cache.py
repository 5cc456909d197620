"""Machine code on disk, in a folder that is named by the content of all kernels and by what it was compiled for."""

import hashlib
import shutil
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numba
from numba import config
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.core.registry import cpu_target
from numba.misc.appdirs import AppDirs

_HERE = Path(__file__).parent


@cache
def cache_folder() -> Path | None:
    """Return the folder of machine code of exactly these kernels for this machine, None where none can be written.

    Kernels call one another by number and share layouts, so that the code of all of them is in the name: machine code
    of other sources is never found, whatever their times and whoever else writes. Each kind of processor has a folder
    of its own in it: Numba's index of a function is read, extended and written without a lock, so that machines which
    share a home could each take the other's code for their own.
    """
    sources = sorted(_HERE.rglob("*.py"))
    if not sources:  # imported from an archive
        return None
    digest = hashlib.sha256(b"".join(source.name.encode() + source.read_bytes() for source in sources))
    for parent in _parents():
        of_sources = parent / f"beamfem-{digest.hexdigest()[:16]}"
        folder = of_sources / _target()
        try:
            _clear_others(of_sources)
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return None


def _target() -> str:
    """Return a name of what machine code is for: the versions of Python and Numba, the processor and its features."""
    machine = cpu_target.target_context.codegen().magic_tuple()
    target = repr((sys.implementation.cache_tag, numba.__version__, machine))
    return hashlib.sha256(target.encode()).hexdigest()[:8]


def _parents() -> Iterator[Path]:
    """Yield where machine code may be kept, the first that can be written is taken: as Numba does."""
    if config.CACHE_DIR:
        yield Path(config.CACHE_DIR)
        return
    yield _HERE / "__pycache__"
    of_the_user = Path(AppDirs(appname="beamfem", appauthor=False).user_cache_dir)
    if of_the_user.is_absolute():  # it is not where the user has no home
        yield of_the_user


def _clear_others(folder: Path) -> None:
    """Remove machine code of earlier sources, beside the sources only: elsewhere other installations have theirs."""
    if folder.parent.parent != _HERE or folder.exists():
        return
    for other in folder.parent.glob("beamfem-*"):
        shutil.rmtree(other, ignore_errors=True)


class _Locator(_CacheLocator):
    """Where the machine code of one kernel lies."""

    def __init__(self, function, file):
        self._py_file = file
        self._line = function.__code__.co_firstlineno

    @classmethod
    def from_function(cls, py_func, py_file):
        return cls(py_func, py_file)

    def get_cache_path(self):
        return str(cache_folder())

    def get_source_stamp(self):
        return cache_folder().name

    def get_disambiguator(self):
        return str(self._line)


class _Implementation(CompileResultCacheImpl):
    _locator_classes = (_Locator,)


class KernelCache(FunctionCache):
    """A cache that never stands in the way of a solve: what cannot be read or written is compiled."""

    _impl_class = _Implementation

    def load_overload(self, sig, target_context):
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # a damaged file raises whatever unpickling it leads to
            return None

    def save_overload(self, sig, data):
        try:
            try:
                super().save_overload(sig, data)
            except OSError:
                raise
            except Exception:  # a damaged index is written anew
                self.flush()
                super().save_overload(sig, data)
        except Exception:  # of the disk, or of a compilation that was interrupted
            self.disable()
