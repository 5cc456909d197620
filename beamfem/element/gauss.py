"""Gauss points along an element."""

from functools import lru_cache

import numpy as np


@lru_cache(maxsize=32)  # asked for by every beam of a model
def gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points (points,) and weights (points,) on [0, 1], which cannot be written to."""
    xi, weights = np.polynomial.legendre.leggauss(points)
    xi, weights = 0.5 * (xi + 1.0), 0.5 * weights
    xi.setflags(write=False)
    weights.setflags(write=False)
    return xi, weights
