"""Arrays in one piece of memory: NumPy takes a microsecond to tell an address, so it is asked once for all of them."""

from collections.abc import Mapping, Sequence
from math import prod
from typing import Any

import numpy as np

from beamfem.kernels.pointers import address_of


class Arena:
    """New arrays of one type, by name, and their addresses."""

    def __init__(self, shapes: Mapping[Any, Sequence[int]], dtype: type = float) -> None:
        self.arrays: dict[Any, np.ndarray] = {}
        self.addresses: dict[Any, int] = {}
        sizes = [prod(shape) for shape in shapes.values()]
        memory: np.ndarray = np.zeros(sum(sizes), dtype=dtype)
        address, first = address_of(memory), 0
        for (name, shape), size in zip(shapes.items(), sizes, strict=True):
            self.arrays[name] = memory[first : first + size].reshape(shape)
            self.addresses[name] = address + memory.itemsize * first
            first += size
