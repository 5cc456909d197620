"""A tangent with multipliers: [K, G'; G, 0] with the conditions G behind the coordinates."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_array, csc_array, csr_array, dia_array

from beamfem.linalg.tangent import UNROTATED, Rotated, SparseFactors, SparseTangent, Stresses, turning


@dataclass(frozen=True)
class SaddleFactors:
    """Factors of [K + c G'G, G'; G, 0], which has as many negative eigenvalues as [K, G'; G, 0] (Sylvester).

    With G' = G transposed. What conditions alone hold has no stiffness in K; here it does, so that pivots stay where
    they are and their signs count. stiffening: c G' (n - k, k).
    """

    factors: SparseFactors
    stiffening: csr_array
    multipliers: int
    rotated: Rotated

    @property
    def negative_pivots(self) -> int:
        """How many eigenvalues are negative for motions that meet the conditions."""
        return self.factors.negative_pivots - self.multipliers

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right. Raises LinAlgError."""
        turn = turning(len(right), self.rotated)
        whole = turn @ right
        whole[self.rotated[0]] = 0.0
        whole[: -self.multipliers] += self.stiffening @ whole[-self.multipliers :]
        return np.asarray(turn.T @ self.factors.solve(whole))

    def correction(self, unbalanced: np.ndarray) -> tuple[np.ndarray, Stresses | None]:
        """Return Newton's step (n,) where a residual (n,) was left when the tangent was formed. Raises LinAlgError."""
        return self.solve(-unbalanced), None


@dataclass(frozen=True)
class SaddleTangent:
    """A sparse matrix whose last rows and columns are those of multipliers."""

    whole: SparseTangent
    multipliers: int

    def factorised(self, rotated: Rotated) -> SaddleFactors:
        """Return the factors. Raises LinAlgError."""
        matrix, k = self.whole.sparse(rotated), self.multipliers
        conditions = csr_array(matrix[-k:, :-k])
        # each condition as stiff as the coordinates that it binds
        sizes = np.abs(conditions).max(axis=1).toarray().ravel()
        stiffest = float(np.abs(matrix.diagonal()[:-k]).max(initial=0.0)) or 1.0
        weights = stiffest / np.where(sizes > 0.0, sizes, 1.0) ** 2
        stiffening = csr_array(conditions.T @ dia_array((weights[None], [0]), shape=(k, k)))
        stiffness = matrix[:-k, :-k] + stiffening @ conditions
        whole = csc_array(block_array([[stiffness, matrix[:-k, -k:]], [conditions, None]]))
        return SaddleFactors(SparseTangent(whole).factorised(UNROTATED), stiffening, k, rotated)

    def solve(self, right: np.ndarray, rotated: Rotated) -> np.ndarray:
        """Return x with A x = right. Raises LinAlgError."""
        return self.factorised(rotated).solve(right)

    def sparse(self, rotated: Rotated) -> csr_array:
        """Return the matrix (n, n) with the normals of inclined rollers rotated to x and constrained there."""
        return self.whole.sparse(rotated)
