"""Complex bands: factors and solutions against dense matrices."""

import numpy as np
import pytest

from beamfem.kernels.band import KNOWN
from beamfem.kernels.complex_band import complex_band


@pytest.mark.parametrize("half", [*KNOWN, 3, 17])
def test_solutions_are_those_of_dense_matrices(half):
    """M + z C + z^2 K with positive matrices, at eigenvalues of Gauss with four stages."""
    rng, n = np.random.default_rng(half), 60
    band = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) <= half
    mass, damping, stiffness = (
        np.where(band, rng.normal(size=(n, n)), 0.0) + size * half * np.eye(n) for size in (4.0, 0.0, 40.0)
    )
    z = 0.0945 + 0.185j
    matrix = mass + z * damping + z * z * stiffness
    rows = np.zeros((n, 2 * half + 1), dtype=complex)
    for i in range(n):
        inside = np.arange(max(0, i - half), min(n, i + half + 1))
        rows[i, inside - i + half] = matrix[i, inside]
    re, im = rows.real.copy(), rows.imag.copy()
    right = rng.normal(size=n) + 1j * rng.normal(size=n)
    x, y, reach = right.real.copy(), right.imag.copy(), np.minimum(np.arange(n) + half + 1, n).astype(np.int32)
    routines = complex_band(half)
    assert 0.1 < routines.factor(n, half, reach, re, im, np.empty(n)) <= 1.0
    routines.solve(n, half, re, im, x, y)
    np.testing.assert_allclose(x + 1j * y, np.linalg.solve(matrix, right), rtol=1e-11, atol=1e-13)


def test_a_zero_pivot_is_reported():
    re, im, space = np.zeros((4, 3)), np.zeros((4, 3)), np.empty(4)
    assert complex_band(1).factor(4, 1, np.full(4, 4, dtype=np.int32), re, im, space) == 0.0
