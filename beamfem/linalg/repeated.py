"""Eigenpairs of an unsymmetric matrix, searched for again until none that are larger remain.

An iteration with one starting vector may miss some of several equal eigenvalues. Symmetric matrices are checked by
counts of pivots; here the search is repeated without the space of those found, where missed ones are the largest.
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_array

from beamfem.errors import ConvergenceError
from beamfem.linalg.eigenpairs import Pairs
from beamfem.linalg.lapack import eig, eigh

_SEARCHES = 12
_FURTHER = 4  # pairs of the second search; each later one finds twice as many
_EQUAL = 1e-9  # relative distance of eigenvalues of which it does not matter which is found
_ROUND_OFF = 1e-14  # of the largest eigenvalue
_INDEPENDENT = 1e-8  # of vectors of unit size: least square of what is left of them beside others

# search(basis, count): the largest eigenvalues of A (I - basis basis^T M) and their vectors, all n of them or count
Search = Callable[[np.ndarray, int], Pairs]


def repeated(
    search: Search,
    times: Callable[[np.ndarray], np.ndarray],
    mass: csr_array,
    count: int,
    size: Callable[[np.ndarray], np.ndarray],
    negligible: float = 0.0,
) -> Pairs:
    """Return at least the `count` largest eigenvalues of a real matrix A and their vectors (n, m), in descending order.

    times(x): A x; mass (n, n): M, positive definite, gives the product in which found vectors are projected out; size:
    of eigenvalues, by which they are sorted; negligible: size up to which they may be missing. Raises ConvergenceError.
    """
    n = mass.shape[0]
    values, x = _largest(*search(np.empty((n, 0)), count), size)
    if len(values) == n:
        return values, x
    basis, further = _extended(np.empty((n, 0)), x, mass), _FURTHER
    negligible = max(negligible, _ROUND_OFF * float(size(values[:1])[0]))
    for _ in range(_SEARCHES):
        more, beside = _largest(*search(basis, further), size)
        least = float(size(values[count - 1 : count])[0])
        if float(size(more[:1])[0]) <= max(least + _EQUAL * abs(least), negligible):
            return values, x
        basis = _extended(basis, beside[:, :further], mass)
        whole, y = eig(basis.T @ (mass @ np.column_stack([times(column) for column in basis.T])))
        values, x = _largest(whole, basis @ y, size)
        further *= 2
    raise ConvergenceError(f"some of the {count} largest eigenvalues were missed")


def _largest(values: np.ndarray, x: np.ndarray, size: Callable[[np.ndarray], np.ndarray]) -> Pairs:
    order = np.argsort(-size(values), kind="stable")
    return values[order], x[:, order]


def _extended(basis: np.ndarray, x: np.ndarray, mass: csr_array) -> np.ndarray:
    """Return an M-orthonormal basis of another one (n, k) and the real and imaginary parts of vectors (n, m)."""
    parts = np.column_stack([x.real, x.imag])
    for _ in range(2):
        parts = parts / np.maximum(np.sqrt((parts * (mass @ parts)).sum(axis=0)), np.finfo(float).tiny)
        parts = parts - basis @ (basis.T @ (mass @ parts))
        sizes, turn = eigh(parts.T @ (mass @ parts))
        kept = sizes > _INDEPENDENT
        parts = parts @ turn[:, kept] / np.sqrt(sizes[kept])
    return np.column_stack([basis, parts])
