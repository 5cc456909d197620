"""Band matrices with a border: a few unknowns that are coupled beyond the band, and Lagrange multipliers."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array

from beamfem.kernels import model_record
from beamfem.kernels.bidirectional_lu import bidirectional_lu
from beamfem.kernels.condensation import factor_condensed, solve_condensed
from beamfem.kernels.records import aligned
from beamfem.linalg.lapack import LinAlgError
from beamfem.linalg.tangent import (
    SMALLEST_PIVOT,
    BandTangent,
    Factorised,
    Rotated,
    SaddleTangent,
    SparseTangent,
    Tangent,
)


class Border(NamedTuple):
    """Entries of a matrix beside those of a band (n, n).

    numbers (t,): unknowns of the band that they couple; multipliers: number k of unknowns that follow those of the
    band; entries (t + k, t + k): of the coupled unknowns and the multipliers.
    """

    numbers: np.ndarray
    multipliers: int
    entries: np.ndarray

    @property
    def size(self) -> int:
        """Number t + k of coupled unknowns and multipliers."""
        return len(self.entries)


def condensed_record(size: int, half: int, reach: np.ndarray, rows: np.ndarray, border: Border) -> model_record.Border:
    """Return the workspace to factor a band of n unknowns, in `rows`, with a border, in place."""
    (numbers, multipliers, entries), routines = border, bidirectional_lu(half, True)
    t, m = len(numbers), len(numbers) + multipliers
    own = model_record.Border(unknown=size, half=half, reach=reach, edge=t, conditions=multipliers)
    own.fill(rows=rows, entries=entries, numbers=np.ascontiguousarray(numbers))
    own.fill(factor=routines.factor, solve=routines.solve)
    room = {"signs": (size,), "columns": (t, size), "beside": (t, 2 * half + 1), "condensed": (m, m), "sizes": (3, m)}
    own.fill(**aligned(room))
    return own


@dataclass(frozen=True)
class CondensedFactors(Factorised):
    """Factors of a band with a border, see `kernels.condensation`."""

    border: model_record.Border

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues for motions that satisfy the conditions."""
        return self.border.negative

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n + k,) with A x = right. Raises LinAlgError."""
        x = right.copy()
        solve_condensed(self.border, x)
        if not np.isfinite(x).all():
            raise LinAlgError("the tangent is singular")
        return x


@dataclass(frozen=True)
class BorderedTangent(Tangent):
    """A band matrix with a border; where pivots are tiny, it is taken as a sparse matrix."""

    band: BandTangent
    border: Border

    def factorised(self, rotated: Rotated) -> Factorised:
        """Return the factors. Raises LinAlgError."""
        rows, reach = self.band.rows.copy(), np.ascontiguousarray(self.band.reach)
        border = self.border._replace(entries=np.ascontiguousarray(self.border.entries))
        own = condensed_record(len(rows), rows.shape[1] // 2, reach, rows, border)
        if not len(rotated[0]) and factor_condensed(own) > SMALLEST_PIVOT:
            return CondensedFactors(own)
        whole, multipliers = SparseTangent(self._whole()), self.border.multipliers
        return (SaddleTangent(whole, multipliers) if multipliers else whole).factorised(rotated)

    def without(self, numbers: np.ndarray, diagonal: np.ndarray) -> "BorderedTangent":
        """Return the tangent with diagonal entries alone in some rows and columns of multipliers, counted from -k."""
        entries = self.border.entries.copy()
        entries[numbers], entries[:, numbers] = 0.0, 0.0
        entries[numbers, numbers] = diagonal
        return replace(self, border=self.border._replace(entries=entries))

    def sparse(self, rotated: Rotated) -> csr_array:
        """Return the matrix (n + k, n + k) with the normals of inclined rollers rotated to x and constrained there."""
        return SparseTangent(self._whole()).sparse(rotated)

    def _whole(self) -> csc_array:
        numbers, multipliers, entries = self.border
        rows = self.band.rows
        size, width = rows.shape
        own = np.concatenate([numbers, np.arange(size, size + multipliers)])
        row, place = np.nonzero(rows)
        column = row + place - width // 2
        beside = np.nonzero(entries)
        shape = size + multipliers, size + multipliers
        data = np.concatenate([rows[row, place], entries[beside]])
        places = np.concatenate([row, own[beside[0]]]), np.concatenate([column, own[beside[1]]])
        return csc_array(coo_array((data, places), shape=shape))
