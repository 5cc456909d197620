"""Arrays in one block of memory: NumPy takes a microsecond to return an address, so only one is requested."""

from collections.abc import Mapping, Sequence
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
