"""Tangents with Lagrange multipliers, [K, G^T; G, 0]: G are the gradients of the conditions."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_array, csc_array, csr_array, dia_array

from beamfem.linalg.tangent import (
    UNROTATED,
    Factorised,
    Rotated,
    SparseFactors,
    SparseTangent,
    Tangent,
    rotation_to_normals,
)


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
