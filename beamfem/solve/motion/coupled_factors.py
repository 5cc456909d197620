"""Factors of the tangents of motions with connectors or a sparse matrix."""

from typing import Protocol

import numpy as np
from scipy.sparse import csc_array

from beamfem.assembly.equations import tangent_of
from beamfem.assembly.system import System
from beamfem.kernels.bidirectional_lu import SHORT, bidirectional_lu
from beamfem.kernels.pointers import address_of
from beamfem.linalg.bordered import BorderedFactors, border_of
from beamfem.linalg.tangent import UNROTATED, Factorised, SparseTangent
from beamfem.precision.saddle import SaddleTangent

# smallest ratio of a pivot to the original diagonal entry with which a band alone has digits enough to be bordered
_WEAK = 1e-10


class CoupledFactors(Protocol):
    """Factors of a tangent."""

    def solve_in_place(self, right: np.ndarray) -> None:
        """Replace a right-hand side by the solution. Raises LinAlgError."""
        ...


class SparseSolution:
    """Factors by SuperLU."""

    def __init__(self, factors: Factorised) -> None:
        self._factors = factors

    def solve_in_place(self, right: np.ndarray) -> None:
        """See `CoupledFactors`."""
        right[:] = self._factors.solve(right)


class SparseFactorisation:
    """Factorises a sparse matrix with the tangents of connectors; matrix: its entries, which are overwritten."""

    def __init__(self, system: System, matrix: np.ndarray) -> None:
        self._system, self._matrix = system, matrix

    def __call__(self, coupled: list[np.ndarray], space: int) -> CoupledFactors:
        """Return the factors; coupled: tangent (k, k) of each connector. Raises LinAlgError."""
        tangent, multipliers = tangent_of(self._system, self._matrix, coupled), len(self._system.connectors.multipliers)
        if len(self._system.rotated[0]):
            constrained = SparseTangent(csc_array(tangent.sparse(self._system.rotated)))
            tangent = SaddleTangent(constrained, multipliers) if multipliers else constrained
        return SparseSolution(tangent.factorised(UNROTATED))


class BandFactorisation:
    """Factorises a band that connectors border; matrix: its rows, which are overwritten.

    If it has few digits without them, as a structure of little inertia that they hold, it is factorised with them as a
    sparse matrix.
    """

    def __init__(self, system: System, matrix: np.ndarray) -> None:
        self._system, self._matrix, self._kept = system, matrix, np.empty_like(matrix)
        self._size, self._half = system.unknowns.banded, system.layouts[0].half_width
        self._rows, self._reach = address_of(matrix), address_of(system.unknowns.reach)
        self._routines = bidirectional_lu(self._half, self._size < SHORT)

    def __call__(self, coupled: list[np.ndarray], space: int) -> CoupledFactors:
        """Return the factors; coupled: tangent (k, k) of each connector; space: address of numbers (n,).

        Raises LinAlgError.
        """
        size, unknowns, multipliers = self._size, self._system.unknowns, len(self._system.connectors.multipliers)
        tangent = tangent_of(self._system, self._matrix, coupled)
        border = border_of(size, multipliers, unknowns.border, coupled)
        self._kept[:] = self._matrix
        ratio = self._routines.factor.compiled(size, self._half, self._reach, self._rows, space)
        if ratio > _WEAK or not border.size:
            return BorderedFactors(size, border, self._solve)
        self._matrix[:] = self._kept
        return SparseSolution(tangent.factorised(UNROTATED))

    def _solve(self, x: np.ndarray) -> None:
        self._routines.solve.compiled(self._size, self._half, self._rows, address_of(x))
