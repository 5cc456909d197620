"""Tangent with stress resultants as additional unknowns, for models whose plain tangent loses its digits.

    [ G      B^T W ] [ x ]   [ f ]        K = G + B^T W C B,   G: geometric part, loads, springs, inertia
    [ W B  -W / C  ] [ s ] = [ 0 ]

Round-off in K is of size eps C, which may exceed the stiffness of adjacent soft parts. Here the stiffness enters by its
inverse and may be arbitrarily large: round-off is of size eps^2 C. Zienkiewicz and Taylor, The Finite Element Method,
mixed formulations.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.linalg.lapack import dsytrs
from scipy.sparse import coo_array, csc_array, csr_array, triu
from scipy.sparse.csgraph import reverse_cuthill_mckee
from scipy.sparse.linalg import SuperLU

from beamfem.cached_properties import cached_property
from beamfem.equations.system import System
from beamfem.linalg.lapack import LinAlgError, superlu, symmetric_factors
from beamfem.linalg.tangent import UNROTATED, Rotated, Stresses, Tangent, rotation_to_normals

_FLEXIBILITY = 1e-10  # of the stiffest part, beside derivatives of strains of one
_REFINEMENTS = 2  # make each equation accurate relative to its own terms, however large others are (Skeel 1980)


@dataclass(frozen=True, eq=False)
class MixedFactors:
    """Factors of the mixed tangent.

    scale (n + m,): scaling of the coordinates, then of the resultants; kept (n,): mask of the coordinates without the
    normals of inclined rollers; rotation (n, n): rotation of these normals to x, None if there are none.
    """

    lu: SuperLU
    scale: np.ndarray
    matrix: csc_array
    kept: np.ndarray
    tangent: "MixedTangent"
    rotated: Rotated
    rotation: csr_array | None

    @cached_property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of a symmetric tangent (Sylvester's law of inertia).

        Each positive eigenvalue of a section stiffness gives the mixed matrix one more, which is subtracted.
        """
        count = negative_eigenvalues(csr_array(self.matrix))
        if count is None or count < self.tangent.positive:  # round-off prevents a count
            return self.tangent.plain.factorised(self.rotated).negative_pivots
        return count - self.tangent.positive

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right, zero along the normals of inclined rollers. Raises LinAlgError."""
        return self._solve(right, np.zeros(len(self.scale) - int(self.kept.sum())))[0]

    def correction(self, unbalanced: np.ndarray) -> tuple[np.ndarray, Stresses | None]:
        """Return the Newton step (n,) for the strains and loads of the tangent, and the stress resultants after it.

        Raises LinAlgError.
        """
        tangent = self.tangent
        x, resultants = self._solve(-tangent.loads, -tangent.weight * tangent.strain)
        stresses, first = [], 0
        for shape, resists in tangent.places:
            table = np.zeros(shape)
            last = first + table[..., resists].size
            table[..., resists] = resultants[first:last].reshape(*shape[:2], -1)
            stresses.append(table)
            first = last
        return x, tuple(stresses)

    def _solve(self, right: np.ndarray, strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rotation, n = self.rotation, int(self.kept.sum())
        rhs = np.concatenate([(right if rotation is None else rotation @ right)[self.kept], strain])
        rhs = self.scale * rhs
        solution = self.lu.solve(rhs)
        for _ in range(_REFINEMENTS):
            solution += self.lu.solve(rhs - self.matrix @ solution)
        solution *= self.scale
        if not np.isfinite(solution).all():
            raise LinAlgError("the tangent is singular")
        x = np.zeros(len(right))
        x[self.kept] = solution[:n]
        return x if rotation is None else np.asarray(rotation.T @ x), solution[n:]


@dataclass(frozen=True, eq=False)
class MixedTangent(Tangent):
    """A tangent in mixed form.

    zeros (n, n): tangent without the elastic part; slopes (m, n): weights times derivatives of the strains by the
    unknowns; flexibility (m, m): weights times inverse stiffness; weight (m,): quadrature weights; loads (n,): residual
    without elastic forces; strain (m,): strains; places: shape (ne, nq, ns) of the stress resultants of each block, and
    the measures that have a stiffness; positive: number of positive eigenvalues of the section stiffnesses; plain: K;
    unit (n,): size of the model for positions [m], 1 for other coordinates.
    """

    zeros: csr_array
    slopes: coo_array
    flexibility: coo_array
    weight: np.ndarray
    loads: np.ndarray
    strain: np.ndarray
    places: tuple[tuple[tuple[int, ...], np.ndarray], ...]
    positive: int
    plain: Tangent
    unit: np.ndarray

    def factorised(self, rotated: Rotated) -> MixedFactors:
        """Factorise the mixed matrix. Raises LinAlgError."""
        n, zeros, couples = self.zeros.shape[0], self.zeros, self.slopes
        kept, rotation = np.ones(n, dtype=bool), None
        if len(rotated[0]):
            kept[rotated[0]] = False
            rotation = rotation_to_normals(n, rotated)
            zeros, couples = (rotation @ zeros @ rotation.T)[kept][:, kept], csr_array(couples @ rotation.T)[:, kept]
        unknown = zeros.shape[0]
        above, beside, below = coo_array(zeros), coo_array(couples), self.flexibility
        row = np.concatenate([above.row, unknown + beside.row, beside.col, unknown + below.row])
        column = np.concatenate([above.col, beside.col, unknown + beside.row, unknown + below.col])
        data = np.concatenate([above.data, beside.data, beside.data, -below.data])
        entries = data != 0.0
        row, column, data = row[entries], column[entries], data[entries]
        sizes, scale = np.abs(data), self._units(self.unit[kept], beside)
        for _ in range(3):
            largest = np.zeros(len(scale))
            np.maximum.at(largest, row, scale[row] * sizes * scale[column])
            scale /= np.sqrt(np.where(largest > 0.0, largest, 1.0))
        scale = 2.0 ** np.round(np.log2(scale))  # powers of two round nothing
        shape = len(scale), len(scale)
        matrix = csc_array(coo_array((scale[row] * data * scale[column], (row, column)), shape=shape))
        return MixedFactors(superlu(matrix), scale, matrix, kept, self, rotated, rotation)

    def _units(self, length: np.ndarray, couples: coo_array) -> np.ndarray:
        """Return the scale (n + m,) in which the matrix is nearly the same in any units.

        In it the least flexibility is well above round-off beside the derivatives of the strains, which would otherwise
        hide how stresses with the same resultants share them. length (n,): `unit` of the coordinates; couples (m, n):
        `slopes` of them.
        """
        below, couple = self.flexibility, np.abs(couples.data) * length[couples.col]
        flexible, strains, stiff = np.zeros(len(self.weight)), np.zeros(len(self.weight)), np.zeros(len(length))
        own = below.row == below.col
        flexible[below.row[own]] = np.abs(below.data[own])
        known = flexible[couples.row] > 0.0
        np.maximum.at(strains, couples.row, couple)
        np.add.at(stiff, couples.col[known], couple[known] ** 2 / flexible[couples.row[known]])
        size = 1.0 / np.sqrt(_FLEXIBILITY * stiff.max(initial=0.0)) if stiff.any() else 1.0
        with np.errstate(divide="ignore"):
            resultant = np.fmin(1.0 / (size * strains), 1.0 / np.sqrt(flexible))
        return np.concatenate([size * length, np.where(np.isfinite(resultant), resultant, 1.0)])

    def lost(self, rotated: Rotated) -> float:
        """Return the relative error of a solution with the plain tangent, for random forces on all coordinates.

        The reference is the solution with the mixed tangent. Raises LinAlgError.
        """
        force = np.random.default_rng(0).standard_normal(self.zeros.shape[0])
        plain, exact = self.plain.factorised(rotated), self.factorised(rotated).solve(force)
        return float(np.max(np.abs(plain.solve(force) - exact)) / np.max(np.abs(exact)))

    def sparse(self, rotated: Rotated) -> csr_array:
        return self.plain.sparse(rotated)


def mixed(
    system: System, p: np.ndarray, time: float, factor: float, loads: np.ndarray, zeros: Tangent, plain: Tangent
) -> MixedTangent:
    """Return the mixed tangent of a state p (n,) at a time.

    factor: weight of the elastic part; loads (n,), zeros: residual and tangent without the elastic part; plain: the
    complete tangent.
    """
    tables, imposing = system.strain_rates, system.loads.imposing(time)
    rates, strain, flexible_at, positive = zip(*(table.at(p, imposing) for table in tables), strict=True)
    weight = np.concatenate([table.weight for table in tables])
    before = np.cumsum([0, *(len(table.weight) for table in tables)])
    pairs = list(zip(tables, before, strict=False))
    point = np.concatenate([table.point + first for table, first in pairs])
    column = np.concatenate([table.column for table in tables])
    slopes = coo_array((np.concatenate(rates) * weight[point], (point, column)), shape=(len(weight), len(loads)))
    above, below = (np.concatenate([table.flexibility[side] + first for table, first in pairs]) for side in (0, 1))
    inverse = np.concatenate(flexible_at) / factor
    flexible = coo_array((inverse, (above, below)), shape=(len(weight),) * 2)
    places = tuple((table.shape, table.resists) for table in tables)
    bare, strains = zeros.sparse(UNROTATED), np.concatenate(strain)
    fields = bare, slopes, flexible, weight, loads, strains, places, sum(positive), plain
    return MixedTangent(*fields, system.scale[system.free_dofs])


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
