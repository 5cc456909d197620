"""Distributions over elements known at Gauss points: their fraction before a cut, and their transfer to more points."""

from functools import lru_cache

import numpy as np

from beamfem.quadrature import gauss


def fractions_before(points: int, at: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """Return the fraction (m,) before a cut (m,) of the amount lumped at a Gauss point `at` (m,), density interpolated.

    It is the integral from 0 to the cut of the Lagrange polynomial of that point, over its integral from 0 to 1.
    """
    xi, integral = _integrals(points)
    return np.einsum("mk,mk->m", integral[nearest(xi, at)], np.polynomial.legendre.legvander(2.0 * cut - 1.0, points))


def to_more_points(points: int, more: int) -> np.ndarray:
    """Return the matrix (more, points) that transfers lumped values from `points` to `more` Gauss points.

    It keeps the polynomial density through the fewer points.
    """
    (xi, _), (fine, weights) = gauss(points), gauss(more)
    old_values, new_values = (np.polynomial.legendre.legvander(2.0 * at - 1.0, points - 1) for at in (xi, fine))
    return np.asarray(weights[:, None] * ((new_values * (2 * np.arange(points) + 1)) @ old_values.T))


def nearest(xi: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the indices (m,) of the points xi (n,) nearest to `at` (m,)."""
    return np.asarray(np.abs(xi - at[:, None]).argmin(axis=1))


@lru_cache(maxsize=32)
def _integrals(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points on [0, 1] and the integrals of their Lagrange polynomials as Legendre series."""
    xi, weights = gauss(points)
    degree = np.arange(points)
    legendre = np.polynomial.legendre.legvander(2.0 * xi - 1.0, points - 1)
    coefficients = legendre * weights[:, None] * (2 * degree + 1)
    return xi, np.polynomial.legendre.legint(coefficients, lbnd=-1.0, axis=1) / (2.0 * weights[:, None])
