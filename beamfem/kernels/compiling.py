"""How kernels are compiled and kept: one decorator, and a cache whose folder is named by the content of all kernels."""

import hashlib
import shutil
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from numba import config, njit
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.misc.appdirs import AppDirs

_HERE = Path(__file__).parent


def kernel(**options):
    """Return a decorator that compiles a function for plain arrays; `options` are those of `numba.njit`.

    Machine code is kept on disk where a folder can be written; where none can, or the disk is full, it is compiled for
    each process.
    """

    def decorate(function):
        compiled = njit(error_model="numpy", **{"_nrt": False, **options})(function)
        if cache_folder() is not None:
            compiled._cache = _KernelCache(function)
        return compiled

    return decorate


@cache
def cache_folder() -> Path | None:
    """Return the folder of machine code of exactly these kernels, None where none can be written.

    One kernel inlines others, so that the code of all of them is in the name: machine code of other sources is never
    found, whatever their times and whoever else writes.
    """
    sources = sorted(_HERE.glob("*.py"))
    if not sources:  # imported from an archive
        return None
    digest = hashlib.sha256(b"".join(source.name.encode() + source.read_bytes() for source in sources))
    for parent in _parents():
        folder = parent / f"beamfem-{digest.hexdigest()[:16]}"
        try:
            _clear_others(folder)
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return None


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


class _KernelCache(FunctionCache):
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
        except OSError:
            self.disable()
