"""Report of the kernels that have been, or must be, compiled."""

import sys
from functools import cache

from beamfem.kernels.cache import cache_folder, kept
from beamfem.kernels.compiling import Routine
from beamfem.progress import in_notebook


def compiled_here() -> list[Routine]:
    """Return the kernels that this process had to compile."""
    return [routine for routine in Routine.made if routine.compiled_here]


@cache
def announce_compilation() -> None:
    """Print once, on a terminal or in a notebook, that the first solve must wait for the compiler."""
    if not (sys.stderr.isatty() or in_notebook()) or kept():
        return
    if cache_folder() is None:
        how_often = "again in each process, since no folder can be written (BEAMFEM_CACHE_DIR names one)"
    else:
        how_often = "once on this computer"
    print(f"compiling kernels, {how_often}: three to five seconds ...", file=sys.stderr)
