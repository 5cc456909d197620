"""Which kernels are compiled already."""

import sys
from functools import cache

from beamfem.kernels.cache import cache_folder
from beamfem.kernels.compiling import Routine
from beamfem.progress import in_notebook


def compiled_here() -> list[Routine]:
    """Return the kernels that this process had to compile."""
    return [routine for routine in Routine.made if routine.compiled_here]


def cached() -> int:
    """Return how many kernels are found compiled on disk."""
    folder = cache_folder()
    return len(list(folder.glob("*.nbi"))) if folder else 0


@cache
def tell_of_compilation() -> None:
    """Say on a terminal or in a notebook, once, that the first solve has to wait for the compiler."""
    if not (sys.stderr.isatty() or in_notebook()) or cached():
        return
    if cache_folder() is None:
        how_often = "again in each process, since no folder can be written (NUMBA_CACHE_DIR names one)"
    else:
        how_often = "once on this computer"
    print(f"compiling kernels, {how_often}: some twenty seconds ...", file=sys.stderr)
