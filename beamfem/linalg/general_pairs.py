"""Eigenpairs of an unsymmetric matrix nearest to a shift."""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigs

from beamfem.linalg.eigenpairs import MOST_RESTARTS, Pairs, Solver, first_that_works, first_vector, lanczos_vectors
from beamfem.linalg.lapack import eig
from beamfem.linalg.repeated import repeated


def general_pairs(mass: csr_array, stiffness: csr_array, factors: Solver, count: int, known: Pairs) -> Pairs:
    """Return the largest |mu| (m,) complex, descending, and x (n, m) with mass x = mu stiffness x.

    mass: symmetric, positive definite; stiffness: any matrix, and its factors; known: pairs that are not to be found
    again, with x^T mass x = 1. Raises ConvergenceError if some were missed.
    """
    n = mass.shape[0]
    weighted = mass @ known[1]

    def solved(b: np.ndarray) -> np.ndarray:
        return factors.solve(b - weighted @ (known[1].T @ b))

    def search(basis: np.ndarray, wanted: int) -> Pairs:
        found = mass @ basis

        def dense() -> Pairs:
            columns = mass.toarray() - found @ found.T
            return eig(np.column_stack([solved(column) for column in columns.T]))

        def few(vectors: int) -> Pairs:
            inverse = LinearOperator((n, n), matvec=lambda b: solved(b - found @ (basis.T @ b)), dtype=float)
            # with sigma = 0, ARPACK finds the smallest 1/mu of stiffness x = (1/mu) mass x
            options = {"ncv": lanczos_vectors(vectors, wanted, n), "maxiter": MOST_RESTARTS, "v0": first_vector(n)}
            reciprocal, x = eigs(stiffness, wanted, M=mass, sigma=0.0, OPinv=inverse, **options)
            return 1.0 / reciprocal, x

        return first_that_works(dense, few, n, wanted + 1)

    values, x = repeated(search, lambda b: solved(mass @ b), mass, count, np.abs)
    values, x = values[:count], x[:, :count]
    # Wielandt's deflation preserves the other eigenvalues, but changes their vectors along the known ones
    fractions = known[0][:, None] * (weighted.T @ x) / (values - known[0][:, None])
    return values, x + known[1] @ fractions
