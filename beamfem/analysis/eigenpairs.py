"""Extreme eigenpairs of a pair of matrices, one of which is factorised."""

from typing import Protocol

import numpy as np
from scipy.linalg import eig, eigh
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigs, eigsh

_DENSE = 200  # unknowns up to which all eigenpairs are as quick as a few


class Solver(Protocol):
    """The factors of a matrix; `solve` leaves directions that are held at zero."""

    def solve(self, right: np.ndarray) -> np.ndarray: ...


Pairs = tuple[np.ndarray, np.ndarray]


def largest_pairs(
    matrix: csr_array, stiffness: csr_array, factors: Solver, count: int, known: Pairs | None = None
) -> Pairs:
    """Return the largest mu (m,), descending, and x (n, m) with matrix x = mu stiffness x, x^T stiffness x = 1.

    stiffness: positive definite along the free directions, with its factors; count: how many to find besides the
    `known` ones, which the result holds as well. m is smaller only where there are no more directions.
    """
    n = matrix.shape[0]
    found = 0 if known is None else len(known[0])
    if n <= _DENSE or 2 * (count + found) >= n:
        basis = _dense_basis(factors, n)
        values, y = eigh(basis.T @ (matrix @ basis))
        return values[::-1][: count + found], (basis @ y[:, ::-1])[:, : count + found]

    def remaining(x: np.ndarray) -> np.ndarray:
        result = matrix @ x
        if known is not None:
            carried = stiffness @ known[1]
            result = result - carried @ (known[0] * (carried.T @ x))
        return np.asarray(result)

    values, x = eigsh(
        LinearOperator((n, n), matvec=remaining, dtype=float),
        count,
        M=stiffness,
        Minv=LinearOperator((n, n), matvec=factors.solve, dtype=float),
        which="LA",
        v0=_first_vector(n),
    )
    if known is not None:
        values, x = np.append(known[0], values), np.column_stack([known[1], x])
    order = np.argsort(-values, kind="stable")
    return values[order], x[:, order]


def general_pairs(matrix: csr_array, stiffness: csr_array, factors: Solver, count: int) -> Pairs:
    """Return the largest |mu| (m,) complex, descending, and x (n, m) with matrix x = mu stiffness x.

    matrix: symmetric, positive definite; stiffness: any matrix, with its factors.
    """
    n = matrix.shape[0]
    if n <= _DENSE or 2 * count + 2 >= n:
        values, x = eig(np.column_stack([factors.solve(column) for column in matrix.toarray().T]))
    else:
        # with sigma = 0, ARPACK finds the smallest 1/mu of stiffness x = (1/mu) matrix x
        inverse = LinearOperator((n, n), matvec=factors.solve, dtype=float)
        reciprocal, x = eigs(stiffness, count, M=matrix, sigma=0.0, OPinv=inverse, v0=_first_vector(n))
        values = 1.0 / reciprocal
    order = np.argsort(-np.abs(values), kind="stable")[:count]
    return values[order], x[:, order]


def _dense_basis(factors: Solver, n: int) -> np.ndarray:
    """Return F (n, m) with F F^T = inverse of the stiffness along the free directions, so F^T stiffness F = 1."""
    inverse = np.column_stack([factors.solve(column) for column in np.eye(n)])
    size = np.sqrt(np.abs(np.diag(inverse)))
    size[size == 0.0] = 1.0
    inverse = 0.5 * (inverse + inverse.T) / np.outer(size, size)
    values, vectors = eigh(inverse)
    free = values > n * np.finfo(float).eps * values[-1]
    return np.asarray(size[:, None] * vectors[:, free] * np.sqrt(values[free]))


def _first_vector(n: int) -> np.ndarray:
    """Return a start of the iteration that is the same in every run and has a share of every mode."""
    return np.random.default_rng(0).standard_normal(n)
