"""Tangents, the matrices of the unknown coordinates: their factorisation, solution and counts of negative pivots."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import block_array, csc_array, csr_array, dia_array
from scipy.sparse.linalg import SuperLU

from beamfem.kernels.band import band
from beamfem.kernels.compiling import Routine
from beamfem.kernels.rollers import constrain_normals, rotate_back, rotate_in
from beamfem.linalg.lapack import LinAlgError, solve_banded, superlu

SMALLEST_PIVOT = 1e-13
_NOTHING = np.empty(0)

# for inclined rollers: number of each x among the unknowns (nt,), and unit normals (nt, 2)
Rotated = tuple[np.ndarray, np.ndarray]
# neither rotates nor constrains: for matrices applied to vectors that satisfy the constraints of rollers already
UNROTATED: Rotated = (np.empty(0, dtype=np.int64), np.empty((0, 2)))
Stresses = tuple[np.ndarray, ...]


class Factorised(Protocol):
    """A factorised tangent, for any number of right-hand sides."""

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of a symmetric tangent (Sylvester's law of inertia)."""

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right and no change along the normals of inclined rollers. Raises LinAlgError."""

    def correction(self, unbalanced: np.ndarray) -> tuple[np.ndarray, Stresses | None]:
        """Return the Newton correction (n,) for the residual (n,) of the state of the tangent. Raises LinAlgError.

        Also return the stress resultants (ne, nq, ns) of each block after it if they are separate unknowns, else None.
        """
        return self.solve(-unbalanced), None


class Tangent(Protocol):
    """A matrix of the unknown coordinates, before factorisation."""

    def factorised(self, rotated: Rotated) -> Factorised:
        """Return the factors. Raises LinAlgError."""

    def solve(self, right: np.ndarray, rotated: Rotated) -> np.ndarray:
        """Return x with A x = right. Raises LinAlgError."""
        return self.factorised(rotated).solve(right)

    def sparse(self, rotated: Rotated) -> csr_array:
        """Return the matrix (n, n) with the normals of inclined rollers rotated to x and constrained there."""


@dataclass(frozen=True)
class BandFactors(Factorised):
    """Factors of a band matrix.

    rows: the matrix with inclined rollers constrained; lu: its factors without pivoting; plain: whether these are
    accurate enough; otherwise each solve factorises with pivoting.
    """

    rows: np.ndarray
    lu: np.ndarray
    plain: bool
    rotated: Rotated

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of a symmetric tangent (Sylvester's law of inertia)."""
        # the factorisation stores the inverse of each pivot on the diagonal
        return int((self.lu[:, self.lu.shape[1] // 2] < 0.0).sum())

    def solve(self, right: np.ndarray) -> np.ndarray:
        x = right.copy()
        _rotate(rotate_in, x, self.rotated)
        if self.plain:
            balanced = x.copy()
            n, half = len(x), self.lu.shape[1] // 2
            routines = band(half)
            routines.solve_lower(n, n, half, self.lu, x)
            routines.solve_upper(n, n, half, self.lu, x)
            if not np.isfinite(x).all():
                x = _solve_pivoted(self.rows, balanced)
        else:
            x = _solve_pivoted(self.rows, x)
        _rotate(rotate_back, x, self.rotated)
        return x


@dataclass(frozen=True)
class BandTangent(Tangent):
    """A band matrix, rows of 2 w + 1 entries; reach (n,): see `kernels.band.elimination`."""

    rows: np.ndarray
    reach: np.ndarray

    def factorised(self, rotated: Rotated) -> BandFactors:
        """Return the factors; pivoting is used only if the factorisation without it meets a tiny pivot."""
        rows = _constrained(self.rows, rotated)
        lu = rows.copy()
        n, half = len(lu), lu.shape[1] // 2
        ratio = band(half).factor(n, n, half, 0, self.reach, lu, _NOTHING, np.empty(n))
        return BandFactors(rows, lu, ratio > SMALLEST_PIVOT, rotated)

    def sparse(self, rotated: Rotated) -> csr_array:
        rows = _constrained(self.rows, rotated)
        half = rows.shape[1] // 2
        return csr_array(dia_array((diagonals(rows), np.arange(half, -half - 1, -1)), shape=(len(rows), len(rows))))


@dataclass(frozen=True)
class SparseFactors(Factorised):
    """Factors of a sparse matrix."""

    lu: SuperLU
    rotated: Rotated

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of a symmetric tangent, provided that no rows were exchanged."""
        return int((self.lu.U.diagonal() < 0.0).sum())

    def solve(self, right: np.ndarray) -> np.ndarray:
        x = right.copy()
        _rotate(rotate_in, x, self.rotated)
        x = self.lu.solve(x)
        if not np.isfinite(x).all():
            raise LinAlgError("the tangent is singular")
        _rotate(rotate_back, x, self.rotated)
        return np.asarray(x)


@dataclass(frozen=True)
class SparseTangent(Tangent):
    """A sparse matrix."""

    matrix: csc_array

    def factorised(self, rotated: Rotated) -> SparseFactors:
        """Return the factors, with diagonal pivots unless these are tiny, so that their signs can be counted.

        Raises LinAlgError.
        """
        matrix = csc_array(self.sparse(rotated)) if len(rotated[0]) else self.matrix
        # the ordering already limits fill-in; wide panels and relaxed supernodes cost more than they save here
        settings = {"permc_spec": "NATURAL", "diag_pivot_thresh": 1e-10, "relax": 1, "panel_size": 1}
        lu = superlu(matrix, full_diagonal=not len(rotated[0]), **settings, options={"SymmetricMode": True})
        return SparseFactors(lu, rotated)

    def sparse(self, rotated: Rotated) -> csr_array:
        first, _ = rotated
        if not len(first):
            return csr_array(self.matrix)
        rotation = rotation_to_normals(self.matrix.shape[0], rotated)
        matrix = csr_array(rotation @ self.matrix @ rotation.T)
        kept = np.ones(matrix.shape[0])
        kept[first] = 0.0
        keep = dia_array((kept[None], [0]), shape=matrix.shape)
        diagonal = np.where(kept == 0.0, np.abs(matrix.diagonal()).max(), 0.0)
        return csr_array(keep @ matrix @ keep + dia_array((diagonal[None], [0]), shape=matrix.shape))


def _rotate(routine: Routine, x: np.ndarray, rotated: Rotated) -> None:
    """Rotate the pairs of inclined rollers in x, in place; routine: `rotate_in` or `rotate_back`."""
    first, normal = rotated
    if len(first):
        routine(len(first), first, normal, x)


def _constrained(rows: np.ndarray, rotated: Rotated) -> np.ndarray:
    """Return a band matrix with the normals of inclined rollers constrained; without rollers it is the same array."""
    first, normal = rotated
    if not len(first):
        return rows
    result = rows.copy()
    constrain_normals(len(rows), rows.shape[1] // 2, len(first), result, first, normal)
    return result


def rotation_to_normals(size: int, rotated: Rotated) -> csr_array:
    """Return the rotation matrix (n, n) that takes the normals of inclined rollers to x."""
    first, normal = rotated
    diagonal, above, below = np.ones(size), np.zeros(size), np.zeros(size)
    diagonal[first] = diagonal[first + 1] = normal[:, 0]
    above[first + 1], below[first] = normal[:, 1], -normal[:, 1]
    return csr_array(dia_array(([below, diagonal, above], [-1, 0, 1]), shape=(size, size)))


def diagonals(rows: np.ndarray) -> np.ndarray:
    """Return the band (2 w + 1, n) in the storage scheme of SciPy: entry (w + i - j, j) is A[i, j]."""
    n, width = rows.shape
    half = width // 2
    diagonals = np.zeros((width, n), dtype=rows.dtype)
    for offset in range(-half, half + 1):
        size = max(n - abs(offset), 0)
        first = max(-offset, 0)
        diagonals[half - offset, first + offset : first + offset + size] = rows[first : first + size, half + offset]
    return diagonals


def _solve_pivoted(rows: np.ndarray, right: np.ndarray) -> np.ndarray:
    half = rows.shape[1] // 2
    x = solve_banded((half, half), diagonals(rows), right)
    if not np.isfinite(x).all():
        raise LinAlgError("the tangent is singular")
    return np.asarray(x)


@dataclass(frozen=True)
class SaddleFactors(Factorised):
    """Factors of [K + G^T c G, G^T; G, 0], which has as many negative eigenvalues as [K, G^T; G, 0] (Sylvester).

    K has no stiffness in directions that only conditions constrain. The added term gives them stiffness, so that no
    rows need to be exchanged and the signs of pivots can be counted. stiffening: G^T c (n - k, k), c diagonal.
    """

    factors: SparseFactors
    stiffening: csr_array
    multipliers: int
    rotated: Rotated

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of K for motions that satisfy the conditions."""
        return self.factors.negative_pivots - self.multipliers

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right. Raises LinAlgError."""
        rotation = rotation_to_normals(len(right), self.rotated)
        whole = rotation @ right
        whole[self.rotated[0]] = 0.0
        whole[: -self.multipliers] += self.stiffening @ whole[-self.multipliers :]
        return np.asarray(rotation.T @ self.factors.solve(whole))


@dataclass(frozen=True)
class SaddleTangent(Tangent):
    """A sparse matrix whose last rows and columns belong to Lagrange multipliers."""

    whole: SparseTangent
    multipliers: int

    def factorised(self, rotated: Rotated) -> SaddleFactors:
        """Return the factors. Raises LinAlgError."""
        matrix, k = self.whole.sparse(rotated), self.multipliers
        conditions = csr_array(matrix[-k:, :-k])
        # each condition is made as stiff as the stiffest coordinate
        sizes = np.abs(conditions).max(axis=1).toarray().ravel()
        stiffest = float(np.abs(matrix.diagonal()[:-k]).max(initial=0.0)) or 1.0
        weights = stiffest / np.where(sizes > 0.0, sizes, 1.0) ** 2
        stiffening = csr_array(conditions.T @ dia_array((weights[None], [0]), shape=(k, k)))
        stiffness = matrix[:-k, :-k] + stiffening @ conditions
        whole = csc_array(block_array([[stiffness, matrix[:-k, -k:]], [conditions, matrix[-k:, -k:]]]))
        return SaddleFactors(SparseTangent(whole).factorised(UNROTATED), stiffening, k, rotated)

    def without(self, numbers: np.ndarray, diagonal: np.ndarray) -> "SaddleTangent":
        """Return the tangent with diagonal entries alone in some rows and columns of multipliers, counted from -k."""
        matrix = self.whole.matrix
        own = np.zeros(matrix.shape[0])
        own[numbers] = diagonal
        kept = dia_array((np.where(own == 0.0, 1.0, 0.0)[None], [0]), shape=matrix.shape)
        switched = kept @ matrix @ kept + dia_array((own[None], [0]), shape=matrix.shape)
        return SaddleTangent(SparseTangent(csc_array(switched)), self.multipliers)

    def sparse(self, rotated: Rotated) -> csr_array:
        return self.whole.sparse(rotated)
