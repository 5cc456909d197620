"""Memory that compiled code works in during one solve, kept for the next one, of whatever model.

Fresh memory costs more than a small solve: the system clears it, page by page.
"""

from dataclasses import dataclass

import numpy as np

from beamfem.kernels.pointers import address_of

_LARGEST = 1_000_000  # numbers of what is kept
_MOST = 4


@dataclass(eq=False)
class Scratch:
    """Memory to work in, its address, and who has worked in it last."""

    memory: np.ndarray
    address: int
    user: object = None


_kept: list[Scratch] = []


def lend(size: int) -> Scratch:
    """Return memory of at least some numbers that nobody else has; it holds what its last user has left."""
    try:
        found = _kept.pop()
    except IndexError:
        return new(size)
    return found if len(found.memory) >= size else new(size)


def new(size: int) -> Scratch:
    """Return memory (size,) of zeros."""
    memory = np.zeros(size)
    return Scratch(memory, address_of(memory))


def take_back(scratch: Scratch) -> None:
    """Keep memory for the next solve, if it is small."""
    if len(scratch.memory) <= _LARGEST and len(_kept) < _MOST:
        _kept.append(scratch)
