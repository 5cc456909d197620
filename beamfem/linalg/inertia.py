"""How many eigenvalues of a sparse symmetric matrix are negative, whatever their signs and order."""

import numpy as np
from scipy.linalg.lapack import dsytrs
from scipy.sparse import csr_array, triu
from scipy.sparse.csgraph import reverse_cuthill_mckee

from beamfem.linalg.lapack import LinAlgError, symmetric_factors

_FEWEST = 24  # rows of a block; of fewer the calls cost more than the work
_WINDOW = 96  # rows in which a block may end: an element of high order has fewer
_LARGEST = 3000  # rows of a block that is eliminated at once
_GROWTH = 1e5  # of the largest number in front of it: a block that leaves more behind is joined with the next


def negative_eigenvalues(matrix: csr_array) -> int | None:
    """Return how many eigenvalues of a symmetric matrix (n, n) are negative; Sylvester's law of inertia.

    L D L^T block by block, with exchanges inside of blocks (Bunch and Kaufman 1977), which end where the fewest rows
    are coupled with what follows: between two elements. A block that is nearly singular without what follows is
    eliminated together with it, up to 3000 rows; None where these are not enough. Raises LinAlgError where numbers are
    not finite.
    """
    order = reverse_cuthill_mckee(matrix, symmetric_mode=True)
    ordered = csr_array(triu(matrix[order][:, order]))
    ordered.eliminate_zeros()
    size = ordered.shape[0]
    coupled = _first_coupled(ordered)
    count, start, fewest = 0, 0, 0
    active, carried = np.empty(0, dtype=np.int64), np.empty((0, 0))
    for end in _block_ends(coupled):
        if end - start < fewest and end < size:
            continue
        if end - start > _LARGEST:
            return None
        behind = end + np.flatnonzero(coupled[end:] < end)
        rows = np.append(np.arange(start, end), behind)
        inside = end - start
        front = _rows_of(ordered, start, end, rows)
        known = np.searchsorted(rows, active)
        front[np.ix_(known, known)] += carried
        largest = np.abs(front).max()
        factored, exchanged = symmetric_factors(front[:inside, :inside])
        solved, failed = dsytrs(factored, exchanged, front[:inside, inside:], lower=1)
        singular = failed or not np.isfinite(solved).all()
        left = carried if singular else front[inside:, inside:] - front[inside:, :inside] @ solved
        if end < size and (singular or not np.abs(left).max(initial=0.0) <= _GROWTH * largest):
            fewest = 2 * (end - start)
            continue
        count += _negative_blocks(factored, exchanged)
        active, carried, start, fewest = behind, left, end, 0
    return count


def _rows_of(upper: csr_array, start: int, end: int, rows: np.ndarray) -> np.ndarray:
    """Return the rows from `start` to `end` of a symmetric matrix, and their columns, of `rows` (m,) it has (m, m)."""
    part = slice(upper.indptr[start], upper.indptr[end])
    row = np.repeat(np.arange(end - start), np.diff(upper.indptr[start : end + 1]))
    column = np.searchsorted(rows, upper.indices[part])
    result = np.zeros((len(rows), len(rows)))
    result[row, column] = result[column, row] = upper.data[part]
    return result


def _first_coupled(matrix: csr_array) -> np.ndarray:
    """Return the first row (n,) that each is coupled with, itself where there is none before; of an upper half."""
    row, column = matrix.nonzero()
    result = np.arange(matrix.shape[0])
    np.minimum.at(result, column, row)
    return result


def _block_ends(coupled: np.ndarray) -> list[int]:
    """Return where blocks end: in each window where the fewest rows that follow are coupled with some before."""
    size, steps = len(coupled), np.zeros(len(coupled) + 2, dtype=np.int64)
    np.add.at(steps, coupled + 1, 1)
    np.add.at(steps, np.arange(size) + 1, -1)
    crossing, ends = np.cumsum(steps)[: size + 1], [0]
    while ends[-1] < size:
        window = crossing[ends[-1] + _FEWEST : min(ends[-1] + _FEWEST + _WINDOW, size)]
        ends.append(ends[-1] + _FEWEST + int(np.argmin(window)) if len(window) else size)
    return ends[1:]


def _negative_blocks(factored: np.ndarray, exchanged: np.ndarray) -> int:
    """Return how many eigenvalues of the blocks of one and of two in D are negative."""
    pivots, beside = np.diagonal(factored).copy(), np.diagonal(factored, -1)
    first = np.flatnonzero(exchanged < 0)[::2]  # both rows of a block of two are marked
    mean, half = 0.5 * (pivots[first] + pivots[first + 1]), 0.5 * (pivots[first] - pivots[first + 1])
    away = np.hypot(half, beside[first])
    pivots[first], pivots[first + 1] = mean - away, mean + away
    if not np.isfinite(pivots).all():
        raise LinAlgError("the tangent is singular")
    return int((pivots < 0.0).sum())
