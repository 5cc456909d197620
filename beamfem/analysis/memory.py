"""Whether the states of a motion fit the memory, asked before the first of them is computed."""

import os

from beamfem.errors import InputError

_SHARE = 0.8  # of the memory of this computer
_STATE = 3 * 8  # bytes of a coordinate: p, p', p''
_STEP = 8 * 8  # bytes of a step whether it is kept or not: its time, what is prescribed and the loads


def require_memory(coordinates: int, duration: float, step: float, save_every: int) -> None:
    """Raise InputError where the states of a motion need more memory [bytes] than this computer has."""
    steps = duration / step
    memory = installed_memory()
    needed = steps * (_STATE * coordinates / save_every + _STEP)
    if memory is None or needed <= _SHARE * memory:
        return
    room = _SHARE * memory - steps * _STEP
    message = (
        f"{steps:.3g} steps of {coordinates} coordinates, of which every {_ordinal(save_every)} is kept, need "
        f"{_size(needed)}, and this computer has {_size(memory)}"
    )
    if room > 0.0:
        enough = int(-(-(steps * _STATE * coordinates) // room))
        raise InputError(f"{message}; save_every={enough} would fit")
    raise InputError(f"{message}; take a larger step, or a shorter duration and go on from the last state")


def installed_memory() -> int | None:
    """Return the memory of this computer [bytes], None where the system does not tell."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # Windows
        return None


def _size(number: float) -> str:
    return f"{number / 2**30:.3g} GiB"


def _ordinal(number: int) -> str:
    return "one" if number == 1 else f"{number}th"
