"""Check that the states of a motion fit into memory, before the first of them is computed."""

from beamfem.errors import InputError
from beamfem.installed_memory import USABLE_FRACTION, in_gib, installed_memory

_STATE = 3 * 8  # bytes of a coordinate: p, p', p''
_STEP = 8 * 8  # bytes of a step, stored or not: its time, prescribed values and loads


def require_memory(coordinates: int, duration: float, step: float, save_every: int) -> None:
    """Raise InputError if the states of a motion need more memory [bytes] than this computer has."""
    steps = duration / step
    memory = installed_memory()
    needed = steps * (_STATE * coordinates / save_every + _STEP)
    if memory is None or needed <= USABLE_FRACTION * memory:
        return
    room = USABLE_FRACTION * memory - steps * _STEP
    message = (
        f"{steps:.3g} steps of {coordinates} coordinates, of which every {_ordinal(save_every)} is kept, need "
        f"{in_gib(needed)}, and this computer has {in_gib(memory)}"
    )
    if room > 0.0:
        enough = int(-(-(steps * _STATE * coordinates) // room))
        raise InputError(f"{message}; save_every={enough} would fit")
    raise InputError(f"{message}; take a larger step, or a shorter duration and continue from the last state")


def require_fits_memory(states: int, coordinates: int) -> None:
    """Raise InputError if this many states of a mode need more memory [bytes] than this computer has."""
    memory, needed = installed_memory(), float(states) * 2 * _STATE * coordinates
    if memory is not None and needed > USABLE_FRACTION * memory:
        raise InputError(
            f"{states:.3g} frames of {coordinates} coordinates need {in_gib(needed)}, and this computer has "
            f"{in_gib(memory)}; take fewer"
        )


def _ordinal(number: int) -> str:
    return "one" if number == 1 else f"{number}th"
