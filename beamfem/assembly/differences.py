"""How functions of a state change with small steps, by differences that are exact where they are polynomials."""

from collections.abc import Callable

import numpy as np

from beamfem.assembly.system import System

_STRAIN = 1e-3
_DIFFERENCE = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))  # where, and weight


def differentiated(
    system: System, values: Callable[[np.ndarray], np.ndarray], p: np.ndarray, step: np.ndarray
) -> np.ndarray:
    """Return the change of a function of p (..., n) with a step (..., n) that may be below the last digit of p.

    A central difference of fourth order, so wide that the strains it gives are of size 1e-3.
    """
    size = np.max(np.abs(step) / system.strain_scale, axis=-1, initial=0.0)
    width = np.where(size > 0.0, _STRAIN / np.where(size > 0.0, size, 1.0), 1.0)
    result = np.zeros(1)
    for at, weight in _DIFFERENCE:
        found = values(p + at * width[..., None] * step)
        result = result + weight * found / width.reshape(width.shape + (1,) * (found.ndim - width.ndim))
    return result
