"""What is spread over elements and known at their Gauss points: how much of it is before a cut, and at more points."""

from functools import lru_cache

import numpy as np

from beamfem.element.gauss import gauss


def fractions_before(points: int, at: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """Share of what stands for a Gauss point at xi `at` (m,) that is before a cut (m,), its density interpolated.

    The integral from 0 to the cut of the polynomial that is one there and zero at the other points, over its whole.
    """
    xi, integral = _integrals(points)
    return np.einsum("mk,mk->m", integral[nearest(xi, at)], np.polynomial.legendre.legvander(2.0 * cut - 1.0, points))


@lru_cache(maxsize=32)
def to_more_points(points: int, more: int) -> np.ndarray:
    """Return (more, points) what stands for each of more Gauss points by what stands for fewer.

    The density through the fewer is a polynomial that stays the same.
    """
    (xi, _), (fine, weights) = gauss(points), gauss(more)
    here, there = (np.polynomial.legendre.legvander(2.0 * at - 1.0, points - 1) for at in (xi, fine))
    return np.asarray(weights[:, None] * ((there * (2 * np.arange(points) + 1)) @ here.T))


def nearest(xi: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return which of the points xi (n,) those at `at` (m,) are."""
    return np.asarray(np.abs(xi - at[:, None]).argmin(axis=1))


@lru_cache(maxsize=32)
def _integrals(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points on [0, 1] and the integrals, as Legendre series, of the polynomials through them."""
    xi, weights = gauss(points)
    degree = np.arange(points)
    legendre = np.polynomial.legendre.legvander(2.0 * xi - 1.0, points - 1)
    # a row of coefficients for each polynomial
    coefficients = legendre * weights[:, None] * (2 * degree + 1)
    return xi, np.polynomial.legendre.legint(coefficients, lbnd=-1.0, axis=1) / (2.0 * weights[:, None])
