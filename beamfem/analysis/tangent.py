"""The matrix of the unknown coordinates: how it is solved with, and what its pivots tell."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solve_banded
from scipy.sparse import csr_array, dia_array

from beamfem.kernels.band import factor, solve
from beamfem.kernels.turned import hold_normals, turn_back, turn_in

_SMALLEST_PIVOT = 1e-13


@dataclass(frozen=True)
class Factorised:
    """A tangent in its factors, for any number of right-hand sides.

    rows: the matrix, inclined rollers held; lu: its factors; plain: whether they may be used, or pivots are needed.
    """

    rows: np.ndarray
    lu: np.ndarray
    plain: bool
    turned: tuple[np.ndarray, np.ndarray]

    @property
    def negative_pivots(self) -> int:
        """How many eigenvalues of a symmetric tangent are negative (Sylvester's law of inertia)."""
        # the factorisation keeps the inverse of each pivot on the diagonal
        return int((self.lu[:, self.lu.shape[1] // 2] < 0.0).sum())

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right and no change along the normals of inclined rollers. Raises LinAlgError."""
        x = right.copy()
        turn_in(x, *self.turned)
        if self.plain:
            balanced = x.copy()
            solve(self.lu, x)
            if not np.isfinite(x).all():
                x = _solve_pivoted(self.rows, balanced)
        else:
            x = _solve_pivoted(self.rows, x)
        turn_back(x, *self.turned)
        return x


@dataclass(frozen=True)
class Tangent:
    """A band matrix of the unknown coordinates, rows of 2 w + 1 entries."""

    rows: np.ndarray

    def factorised(self, turned: tuple[np.ndarray, np.ndarray]) -> Factorised:
        """Return the factors; turned: numbers (nt,) and normals (nt, 2) of inclined rollers.

        Pivots only where the plain factorisation meets a tiny pivot.
        """
        rows = self.rows.copy()
        hold_normals(rows, *turned)
        lu = rows.copy()
        return Factorised(rows, lu, factor(lu) > _SMALLEST_PIVOT, turned)

    def solve(self, right: np.ndarray, turned: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Return x with A x = right. Raises LinAlgError."""
        return self.factorised(turned).solve(right)

    def sparse(self, turned: tuple[np.ndarray, np.ndarray]) -> csr_array:
        """Return the matrix (n, n) with the normals of inclined rollers turned to x and held there."""
        rows = self.rows.copy()
        hold_normals(rows, *turned)
        half = rows.shape[1] // 2
        return csr_array(dia_array((_diagonals(rows), np.arange(half, -half - 1, -1)), shape=(len(rows), len(rows))))


def _diagonals(rows: np.ndarray) -> np.ndarray:
    """Return the band (2 w + 1, n) in the storage of SciPy: entry (w + i - j, j) is A[i, j]."""
    n, width = rows.shape
    half = width // 2
    diagonals = np.zeros((width, n))
    for offset in range(-half, half + 1):
        size = max(n - abs(offset), 0)
        first = max(-offset, 0)
        diagonals[half - offset, first + offset : first + offset + size] = rows[first : first + size, half + offset]
    return diagonals


def _solve_pivoted(rows: np.ndarray, right: np.ndarray) -> np.ndarray:
    half = rows.shape[1] // 2
    x = solve_banded((half, half), _diagonals(rows), right)
    if not np.isfinite(x).all():
        raise LinAlgError("the tangent is singular")
    return np.asarray(x)
