"""Scratch memory of compiled code, reused by the next solve of any model."""

from dataclasses import dataclass

import numpy as np

_LARGEST = 1_000_000  # floats of memory that is kept
_MOST = 4


@dataclass(eq=False)
class Scratch:
    """Scratch memory and its last user."""

    memory: np.ndarray
    user: object = None


_kept: list[Scratch] = []


def lend(size: int) -> Scratch:
    """Return memory of at least `size` floats that is not in use; its contents are arbitrary."""
    try:
        scratch = _kept.pop()
    except IndexError:
        return new(size)
    return scratch if len(scratch.memory) >= size else new(size)


def new(size: int) -> Scratch:
    """Return memory (size,) of zeros."""
    return Scratch(np.zeros(size))


def take_back(scratch: Scratch) -> None:
    """Keep memory for the next solve, if it is small."""
    if len(scratch.memory) <= _LARGEST and len(_kept) < _MOST:
        _kept.append(scratch)
