"""Changes of functions of a state with small steps, by differences that are exact for polynomials up to degree 4."""

from collections.abc import Callable

import numpy as np

from beamfem.equations.system import System

_STRAIN = 1e-3
_DIFFERENCE = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))  # offset and weight


def differentiated(
    system: System, values: Callable[[np.ndarray], np.ndarray], p: np.ndarray, step: np.ndarray
) -> np.ndarray:
    """Return the linear change of a function of p (..., n) for a step (..., n) that may be below the round-off of p."""
    return changed(values, p, step, widths(system, step))


def widths(system: System, step: np.ndarray) -> np.ndarray:
    """Return the multiples (...,) of steps (..., n) that cause strains of about 1e-3."""
    size = np.max(np.abs(step) / system.strain_scale, axis=-1, initial=0.0)
    return np.where(size > 0.0, _STRAIN / np.where(size > 0.0, size, 1.0), 1.0)


def changed(
    values: Callable[[np.ndarray], np.ndarray], p: np.ndarray, step: np.ndarray, width: np.ndarray
) -> np.ndarray:
    """Return the change of `differentiated` for some coordinates; width (...,): see `widths`.

    It is a central difference of fourth order.
    """
    result = np.zeros(1)
    for offset, weight in _DIFFERENCE:
        sample = values(p + offset * width[..., None] * step)
        result = result + weight * sample / width.reshape(width.shape + (1,) * (sample.ndim - width.ndim))
    return result
