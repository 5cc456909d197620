"""Which kernels are compiled already, and where numba keeps them."""

import importlib
import pkgutil
import sys
from functools import cache
from pathlib import Path
from typing import Any

import beamfem.kernels


def kernels() -> dict[str, Any]:
    """Return every compiled function of beamfem by `module.name`."""
    found = {}
    for module in pkgutil.iter_modules(beamfem.kernels.__path__):
        members = vars(importlib.import_module(f"beamfem.kernels.{module.name}"))
        for name, value in members.items():
            if hasattr(value, "stats") and getattr(value, "__module__", "").endswith(f".{module.name}"):
                found[f"{module.name}.{name}"] = value
    return found


def cache_folder() -> Path | None:
    """Return where numba keeps compiled kernels, None where it found no folder to write to."""
    paths = {kernel.stats.cache_path for kernel in kernels().values()} - {None}
    return Path(sorted(paths)[0]) if paths else None


def cached() -> int:
    """Return how many kernels are found compiled on disk."""
    folder = cache_folder()
    return len(list(folder.glob("*.nbi"))) if folder and folder.is_dir() else 0


@cache
def tell_of_compilation() -> None:
    """Say on a terminal, once, that the first solve has to wait for the compiler."""
    if sys.stderr.isatty() and not cached():
        print("compiling kernels, once on this computer: some ten seconds ...", file=sys.stderr)
