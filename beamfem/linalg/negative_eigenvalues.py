"""Number of negative eigenvalues of a sparse symmetric matrix, which may be indefinite."""

import numpy as np
from scipy.linalg import eigh
from scipy.linalg.lapack import dsytrs
from scipy.sparse import csr_array, triu
from scipy.sparse.csgraph import reverse_cuthill_mckee

from beamfem.linalg.lapack import LinAlgError, symmetric_factors

_FEWEST = 24  # rows of a block; with fewer, calls take longer than the computations
_WINDOW = 96  # rows within which a block may end: more than an element of high order has
_LARGEST = 3000  # rows of a block that is eliminated at once
_DECOMPOSED = 400  # rows of a block up to which single directions may be delayed
_GROWTH = 1e5  # of the largest entry of a front: directions that would cause more growth are delayed


def negative_eigenvalues(matrix: csr_array) -> int | None:
    """Return the number of negative eigenvalues of a symmetric matrix (n, n), by Sylvester's law of inertia.

    The matrix is factorised as L D L^T block by block, with pivoting within blocks (Bunch and Kaufman 1977). A block
    ends where the fewest rows are coupled with later ones, which is between two elements. Directions in which a block
    alone is nearly singular are delayed and eliminated with the next block, as in the multifrontal method (Duff and
    Reid 1983); if there are many, the blocks are merged, up to 3000 rows. Returns None if that is not enough. Raises
    LinAlgError if entries are not finite.
    """
    order = reverse_cuthill_mckee(matrix, symmetric_mode=True)
    ordered = csr_array(triu(matrix[order][:, order]))
    ordered.eliminate_zeros()
    size = ordered.shape[0]
    coupled = _first_coupled(ordered)
    count, start, fewest, waiting = 0, 0, 0, 0
    active, carried = np.empty(0, dtype=np.int64), np.empty((0, 0))
    for end in _block_ends(coupled):
        if end - start < fewest and end < size:
            continue
        if end - start > _LARGEST:
            return None
        behind = end + np.flatnonzero(coupled[end:] < end)
        rows = np.append(np.arange(start, end), behind)
        inside = waiting + end - start
        front = np.zeros((waiting + len(rows),) * 2)
        front[waiting:, waiting:] = _rows_of(ordered, start, end, rows)
        positions = np.append(np.arange(waiting), waiting + np.searchsorted(rows, active))
        front[np.ix_(positions, positions)] += carried
        if end == size:
            return count + _negative_blocks(*symmetric_factors(front))
        eliminated = _eliminate(front, inside)
        if eliminated is None:
            fewest = 2 * (end - start)
            continue
        negative, waiting, carried = eliminated
        count += negative
        active, start, fewest = behind, end, 0
    return count


def _eliminate(front: np.ndarray, inside: int) -> tuple[int, int, np.ndarray] | None:
    """Eliminate the first `inside` rows of a front (n, n), except for directions that would cause too much growth.

    Return the number of negative eigenvalues eliminated, the number of delayed directions, and the matrix that remains
    for these and the other rows; None if more than half of the directions, or any of a large block, would be delayed.
    """
    largest = np.abs(front).max()
    factored, exchanged = symmetric_factors(front[:inside, :inside])
    solved, failed = dsytrs(factored, exchanged, front[:inside, inside:], lower=1)
    if not failed and np.isfinite(solved).all():
        schur = front[inside:, inside:] - front[inside:, :inside] @ solved
        if np.abs(schur).max(initial=0.0) <= _GROWTH * largest:
            return _negative_blocks(factored, exchanged), 0, schur
    if inside > _DECOMPOSED:
        return None
    values, vectors = eigh(front[:inside, :inside])
    firm = np.abs(values) > largest / _GROWTH
    waiting = int(np.sum(~firm))
    if 2 * waiting > inside:
        return None
    beside = vectors.T @ front[:inside, inside:]
    schur = front[inside:, inside:] - (beside[firm].T / values[firm]) @ beside[firm]
    carried = np.block([[np.diag(values[~firm]), beside[~firm]], [beside[~firm].T, schur]])
    return int(np.sum(values[firm] < 0.0)), waiting, carried


def _rows_of(upper: csr_array, start: int, end: int, rows: np.ndarray) -> np.ndarray:
    """Return the matrix (m, m) with the entries of rows `start` to `end` of a symmetric one, and of the same columns.

    upper: upper triangle of the symmetric matrix; rows (m,): its rows that the result contains, others are zero.
    """
    part = slice(upper.indptr[start], upper.indptr[end])
    row = np.repeat(np.arange(end - start), np.diff(upper.indptr[start : end + 1]))
    column = np.searchsorted(rows, upper.indices[part])
    result = np.zeros((len(rows), len(rows)))
    result[row, column] = result[column, row] = upper.data[part]
    return result


def _first_coupled(matrix: csr_array) -> np.ndarray:
    """Return for each row the first one (n,) that it is coupled with, at most itself; matrix: upper triangle."""
    row, column = matrix.nonzero()
    result = np.arange(matrix.shape[0])
    np.minimum.at(result, column, row)
    return result


def _block_ends(coupled: np.ndarray) -> list[int]:
    """Return the rows at which blocks end, each in its window where the fewest later rows are coupled with earlier."""
    size, steps = len(coupled), np.zeros(len(coupled) + 2, dtype=np.int64)
    np.add.at(steps, coupled + 1, 1)
    np.add.at(steps, np.arange(size) + 1, -1)
    crossing, ends = np.cumsum(steps)[: size + 1], [0]
    while ends[-1] < size:
        window = crossing[ends[-1] + _FEWEST : min(ends[-1] + _FEWEST + _WINDOW, size)]
        ends.append(ends[-1] + _FEWEST + int(np.argmin(window)) if len(window) else size)
    return ends[1:]


def _negative_blocks(factored: np.ndarray, exchanged: np.ndarray) -> int:
    """Return the number of negative eigenvalues of D, which has 1 x 1 and 2 x 2 blocks; see `symmetric_factors`."""
    pivots, beside = np.diagonal(factored).copy(), np.diagonal(factored, -1)
    first = np.flatnonzero(exchanged < 0)[::2]  # both rows of a 2 x 2 block are marked
    mean, half = 0.5 * (pivots[first] + pivots[first + 1]), 0.5 * (pivots[first] - pivots[first + 1])
    away = np.hypot(half, beside[first])
    pivots[first], pivots[first + 1] = mean - away, mean + away
    if not np.isfinite(pivots).all():
        raise LinAlgError("the tangent is singular")
    return int((pivots < 0.0).sum())
