"""Which kernels are compiled already."""

import importlib
import pkgutil
import sys
from functools import cache
from typing import Any

import beamfem.kernels
from beamfem.kernels.compiling import cache_folder


def kernels() -> dict[str, Any]:
    """Return every compiled function of beamfem by `module.name`."""
    found = {}
    for module in pkgutil.iter_modules(beamfem.kernels.__path__):
        members = vars(importlib.import_module(f"beamfem.kernels.{module.name}"))
        for name, value in members.items():
            if hasattr(value, "stats") and getattr(value, "__module__", "").endswith(f".{module.name}"):
                found[f"{module.name}.{name}"] = value
    return found


def cached() -> int:
    """Return how many kernels are found compiled on disk."""
    folder = cache_folder()
    return len(list(folder.glob("*.nbi"))) if folder else 0


@cache
def tell_of_compilation() -> None:
    """Say on a terminal, once, that the first solve has to wait for the compiler."""
    if not sys.stderr.isatty() or cached():
        return
    if cache_folder() is None:
        how_often = "again in each process, since no folder can be written (NUMBA_CACHE_DIR names one)"
    else:
        how_often = "once on this computer"
    print(f"compiling kernels, {how_often}: some ten seconds ...", file=sys.stderr)
