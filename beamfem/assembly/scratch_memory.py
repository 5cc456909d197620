"""Aligned arrays in one block of memory, and scratch memory of compiled code, reused by the next solve of any model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np

from beamfem.kernels.pointers import address_of
from beamfem.kernels.simd import WIDTH

_ITEM = 8  # bytes of a float or an integer


class Arena:
    """New arrays of zeros of one type and their addresses, by name.

    Each begins at a cache line, so that vectors of lanes do not straddle two lines.
    """

    def __init__(self, shapes: Mapping[Any, Sequence[int]], dtype: type = float) -> None:
        self.arrays: dict[Any, np.ndarray] = {}
        self.addresses: dict[Any, int] = {}
        sizes = [prod(shape) for shape in shapes.values()]
        memory: np.ndarray = np.zeros(sum(sizes) + WIDTH * (len(sizes) + 1), dtype=dtype)
        address = address_of(memory)
        first = 0
        for (name, shape), size in zip(shapes.items(), sizes, strict=True):
            first += -(address // _ITEM + first) % WIDTH
            array = memory[first : first + size]
            self.arrays[name] = array if len(shape) == 1 else array.reshape(shape)
            self.addresses[name] = address + _ITEM * first
            first += size


_LARGEST = 1_000_000  # floats of memory that is kept
_MOST = 4


@dataclass(eq=False)
class Scratch:
    """Scratch memory, its address, and its last user."""

    memory: np.ndarray
    address: int
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
    memory = np.zeros(size)
    return Scratch(memory, address_of(memory))


def take_back(scratch: Scratch) -> None:
    """Keep memory for the next solve, if it is small."""
    if len(scratch.memory) <= _LARGEST and len(_kept) < _MOST:
        _kept.append(scratch)
