"""Gauss quadrature on an interval, the rules of scikit-fem, and interpolation by polynomials."""

from functools import lru_cache

import numpy as np
from skfem.quadrature import get_quadrature_line


@lru_cache(maxsize=64)  # asked for by every beam of a model
def gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points (points,) and weights (points,) on [0, 1], which cannot be written to."""
    # scikit-fem has no rule of one point
    (xi,), weights = ([[0.5]], np.ones(1)) if points == 1 else get_quadrature_line(2 * points - 1)
    rule = np.array(xi), np.array(weights)
    for values in rule:
        values.setflags(write=False)
    return rule


def gauss_between(low: float, high: float, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points (points,) between two ends and their weights (points,)."""
    at, weights = gauss(points)
    return low + (high - low) * at, (high - low) * weights


def interpolation_weights(at: np.ndarray, x: float | np.ndarray) -> np.ndarray:
    """Return the weights (..., k) of values at `at` (k,) that give their interpolation polynomial at x (...)."""
    itself = np.eye(len(at), dtype=bool)
    above = np.where(itself, 1.0, np.asarray(x)[..., None, None] - at)
    return np.asarray(np.prod(above / np.where(itself, 1.0, at[:, None] - at), axis=-1))
