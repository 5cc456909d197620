"""Eigenpairs of matrices, symmetric or not, with repeated eigenvalues."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigs, eigsh

from beamfem.errors import ConvergenceError
from beamfem.linalg.lapack import LinAlgError, cholesky, eig, eigh, solve_triangular
from beamfem.linalg.tangent import Factorised

# Computing all eigenpairs takes no longer than computing a few with so many unknowns, or with so few times the number
# of pairs. It also calls BLAS with large matrices, whose threads wait for each other for seconds on a busy computer.
_DENSE = 64
_UNKNOWNS_PER_PAIR = 6
_LARGEST_DENSE = 4000  # unknowns up to which all eigenpairs are computed if the iteration for a few fails
_MOST_RESTARTS = 100  # of an iteration, which needs about ten unless round-off leaves no accurate digits
_LANCZOS_VECTORS = (1, 3)  # times the usual number


Pairs = tuple[np.ndarray, np.ndarray]


@contextmanager
def digits_for(what: str) -> Iterator[None]:
    """Raise ConvergenceError if LAPACK or ARPACK fail, or numbers overflow; what: the quantities sought, in words."""
    try:
        yield
    except (LinAlgError, ArpackError, ZeroDivisionError, OverflowError) as error:
        raise ConvergenceError(
            f"{what} of this model cannot be found: its tangent is numerically singular, because stiffnesses, lengths "
            f"or loads differ by too many orders of magnitude ({error})"
        ) from error


def nothing_known(n: int) -> Pairs:
    return np.empty(0), np.empty((n, 0))


def largest_pairs(mass: csr_array, factors: Factorised, count: int, known: np.ndarray) -> Pairs:
    """Return the largest mu (m,), descending, and x (n, m) with K^-1 mass x = mu x and x^T mass x = 1.

    mass: positive definite, without the rows of multipliers, which have none; factors: of K, symmetric and positive
    definite along the free directions; count: number of pairs to find besides the vectors x (n, k) that are `known`,
    with x^T mass x = 1. These are projected out of the inverse on both sides; subtracting their mu instead would leave
    round-off that may look like a mode. m < count if there are no more pairs. Raises ConvergenceError.
    """
    n = mass.shape[0]
    weighted = mass @ known

    def dense() -> Pairs:
        own = np.flatnonzero(mass.diagonal())
        root = cholesky(mass[own][:, own].toarray(), lower=True)
        right = np.zeros((n, len(own)))
        right[own] = root
        inverse = root.T @ np.column_stack([factors.solve(column) for column in right.T])[own]
        inverse = 0.5 * (inverse + inverse.T)
        old = root.T @ known[own]
        projector = np.eye(len(own)) - old @ old.T
        values, y = eigh(projector @ inverse @ projector)
        x = np.zeros((n, len(own)))
        x[own] = solve_triangular(root.T, y[:, ::-1])
        return values[::-1], x

    def few(options: dict[str, Any]) -> Pairs:
        # ARPACK does not use the matrix itself if it is given the inverse
        unused, inverse = (LinearOperator((n, n), matvec=apply, dtype=float) for apply in (np.asarray, projected))
        reciprocal, x = eigsh(unused, count, M=mass, sigma=0.0, OPinv=inverse, **options)
        order = np.argsort(reciprocal, kind="stable")
        # The last vectors of a multiple eigenvalue come from round-off and have parts along stiff directions, which are
        # small in x^T M x but not in x^T K x; a solve removes them.
        solved = np.column_stack([projected(column) for column in (mass @ x[:, order]).T])
        return 1.0 / reciprocal[order], orthonormal(solved, mass)

    def projected(b: np.ndarray) -> np.ndarray:
        solved = factors.solve(b - weighted @ (known.T @ b))
        return np.asarray(solved - known @ (weighted.T @ solved))

    mu, x = first_that_works(dense, few, n, count)
    for _ in range(2):
        x = x - known @ (weighted.T @ x)
    return mu[:count], x[:, :count]


def orthonormal(x: np.ndarray, mass: csr_array) -> np.ndarray:
    """Return independent vectors (n, m) with x^T mass x = 1 that span the same space."""
    root = cholesky(x.T @ (mass @ x), lower=True)
    return np.asarray(solve_triangular(root, x.T, lower=True).T)


def first_that_works(
    dense: Callable[[], Any], few: Callable[[dict[str, Any]], Any], n: int, count: int, further: int = 0
) -> Pairs:
    """Return `count` eigenpairs of n unknowns from `few`, or all from `dense` if n is small or the iteration fails.

    few(options): iterates with options of ARPACK; further: pairs that it finds besides. Raises ConvergenceError.
    """
    per_pair = _UNKNOWNS_PER_PAIR if n <= _LARGEST_DENSE else 2
    if n > _DENSE and per_pair * (count + further) < n:
        for times in _LANCZOS_VECTORS:
            vectors = min(n, times * max(2 * count + 1, 20))
            with suppress(ArpackError):
                return few({"ncv": vectors, "maxiter": _MOST_RESTARTS, "v0": first_vector(n)})
        if n > _LARGEST_DENSE:
            raise ConvergenceError(f"the iteration for {count} eigenvalues of {n} unknowns did not converge")
    return dense()


def first_vector(n: int) -> np.ndarray:
    """Return a start vector that is the same in every run and has a component along every mode."""
    return np.random.default_rng(0).standard_normal(n)


_SEARCHES = 12
_FURTHER = 4  # pairs of the second search; each later one finds twice as many
_EQUAL = 1e-9  # relative distance of eigenvalues of which it does not matter which is found
_ROUND_OFF = 1e-14  # of the largest eigenvalue
_INDEPENDENT = 1e-8  # of vectors of unit size: least square of what is left of them beside others


def dominant_pairs(
    times: Callable[[np.ndarray], np.ndarray], mass: csr_array, count: int, which: str, negligible: float = 0.0
) -> Pairs:
    """Return at least the `count` largest eigenvalues of a real matrix A and their vectors (n, m), in descending order.

    times(x): A x; mass (n, n): M, positive definite, gives the product in which found vectors are projected out; which:
    what is large, the size ("LM") or the real part ("LR"); negligible: size up to which they may be missing. Raises
    ConvergenceError.
    """
    n, size = mass.shape[0], np.abs if which == "LM" else np.real

    def search(basis: np.ndarray, wanted: int) -> Pairs:
        """Return the largest eigenvalues of A (I - basis basis^T M) and their vectors, some or all."""

        def besides(x: np.ndarray) -> np.ndarray:
            return times(x - basis @ (basis.T @ (mass @ x)))

        def dense() -> Pairs:
            return eig(np.column_stack([besides(column) for column in np.eye(n)]))

        def few(options: dict[str, Any]) -> Pairs:
            return eigs(LinearOperator((n, n), matvec=besides, dtype=float), wanted, which=which, **options)

        return _largest(*first_that_works(dense, few, n, wanted, further=1), size)

    values, x = search(np.empty((n, 0)), count)
    if len(values) == n:
        return values, x
    basis, further = _extended(np.empty((n, 0)), x, mass), _FURTHER
    negligible = max(negligible, _ROUND_OFF * float(size(values[:1])[0]))
    for _ in range(_SEARCHES):
        more, beside = search(basis, further)
        if len(values) < count:
            break
        least = float(size(values[count - 1 : count])[0])
        if float(size(more[:1])[0]) <= max(least + _EQUAL * abs(least), negligible):
            return values, x
        basis = _extended(basis, beside[:, :further], mass)
        whole, y = eig(basis.T @ (mass @ np.column_stack([times(column) for column in basis.T])))
        values, x = _largest(whole, basis @ y, size)
        further *= 2
    raise ConvergenceError(
        f"some of {count} eigenvalues were missed: stiffnesses or inertias may differ by too many orders of magnitude"
    )


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


def general_pairs(mass: csr_array, factors: Factorised, count: int, known: Pairs) -> Pairs:
    """Return the largest |mu| (m,) complex, descending, and x (n, m) with mass x = mu K x.

    mass: symmetric, positive definite; factors: of any matrix K; known: pairs that are not to be found again, with
    x^T mass x = 1. Raises ConvergenceError if some were missed.
    """
    weighted = mass @ known[1]

    def times(x: np.ndarray) -> np.ndarray:
        b = mass @ x
        return factors.solve(b - weighted @ (known[1].T @ b))

    values, x = dominant_pairs(times, mass, count, "LM")
    values, x = values[:count], x[:, :count]
    # Wielandt's deflation preserves the other eigenvalues, but changes their vectors along the known ones
    fractions = known[0][:, None] * (weighted.T @ x) / (values - known[0][:, None])
    return values, x + known[1] @ fractions
