"""Stages of compiled time steps for models with connectors or a sparse tangent: routines that call Python."""

from collections.abc import Callable
from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p, cast
from typing import Any

import numpy as np
from scipy.sparse import csc_array

from beamfem.assembly.equations import tangent_of
from beamfem.assembly.motion_workspace import MotionWorkspace
from beamfem.assembly.system import System
from beamfem.kernels import motion_stages, record, rollers
from beamfem.kernels.pointers import address_of
from beamfem.kernels.two_sided import SHORT, two_sided
from beamfem.linalg.bordered import BorderedFactors, border_of
from beamfem.linalg.lapack import LinAlgError
from beamfem.linalg.saddle import SaddleTangent
from beamfem.linalg.tangent import UNROTATED, Factorised, SparseTangent

_Stage = CFUNCTYPE(c_double, *(c_int64,) * 4)
_Factor = CFUNCTYPE(c_double, *(c_int64,) * 2, *(c_void_p,) * 3)
_Solve = CFUNCTYPE(None, *(c_int64,) * 2, *(c_void_p,) * 2)


class CoupledStages:
    """The routines of a motion with connectors or a sparse tangent.

    An error in them cannot propagate through compiled code: it is stored, the corrections become nan, which ends any
    iteration, and `raise_error` raises it. state (4, n): of the motion; times (steps,) [s]: ends of the steps.
    """

    def __init__(self, system: System, space: MotionWorkspace) -> None:
        self.system, self.state, self.times = system, np.empty((4, 0)), np.empty(0)
        self._residual, self._right = space.arrays["residual"], space.arrays[record.RIGHT]
        self._matrix, self._solver, self._table = space.arrays[record.ROWS], space.solver, space.assembler.table
        self._weights, self._coupled = space.assembler.weights, list[np.ndarray]()
        banded = system.unknowns.pattern is None
        self._factors: _BandSolver | _SparseSolver = (_BandSolver if banded else _SparseSolver)(system)
        self._error: BaseException | None = None
        self._functions = {
            record.ASSEMBLE: _Stage(self._guarded(self._assemble)),
            record.FACTOR_BOTH: _Factor(self._guarded(self._factor)),
            record.SOLVE_BOTH: _Solve(self._guarded(self._solve)),
            record.CORRECT: _Stage(self._guarded(self._correct)),
        }
        self.routines = system.solver_table.routines(moving=True).copy()
        self.routines[record.CONSTRAIN_NORMALS] = rollers.constrain_nothing.address
        for number, function in self._functions.items():
            self.routines[number] = cast(function, c_void_p).value

    def raise_error(self) -> None:
        """Raise the first error since the last call, if there is one."""
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _guarded(self, function: Callable[..., float | None]) -> Callable[..., Any]:
        """Return a function that compiled code may call: it raises nothing."""

        def guarded(*arguments: int) -> float | None:
            try:
                if self._error is None:
                    return function(*arguments)
            except BaseException as error:
                self._error = error
            self._right[:] = np.nan
            return np.nan

        return guarded

    def _assemble(self, part: int, system: int, solver: int, calls: int) -> float:
        """See `motion_stages.assemble`."""
        motion_stages.assemble.compiled(part, system, solver, calls)
        connectors, (p, v, a, _) = self.system.connectors, self.state
        if connectors.items:
            time = float(self.times[self._solver[record.NOW]])
            connectors.add_forces(self._residual, (p, v, a), time)
            if self._table[record.TANGENT]:
                self._coupled = connectors.tangents((p, v, a), time, self._weights)
        return -1.0

    def _factor(self, unknown: int, half: int, reach: int, rows: int, space: int) -> float:
        """Factorise the tangent; return the smallest ratio of pivots that are measured, 1 if none is."""
        return self._factors.factorise(self._matrix, self._coupled, space)

    def _solve(self, unknown: int, half: int, rows: int, right: int) -> None:
        """Replace the right-hand side by the solution, nan if the tangent is singular."""
        try:
            self._factors.solve(self._right)
        except LinAlgError:
            self._right[:] = np.nan

    def _correct(self, part: int, system: int, solver: int, calls: int) -> float:
        """See `motion_stages.correct`."""
        size = motion_stages.correct.compiled(part, system, solver, calls)
        self.state[1:3, self.system.connectors.multipliers] = 0.0  # multipliers have no rates
        return float(size)


class _SparseSolver:
    """Factors of a sparse tangent by SuperLU."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._factors: Factorised | None = None

    def factorise(self, matrix: np.ndarray, coupled: list[np.ndarray], space: int) -> float:
        """Factorise a matrix with the tangents of connectors."""
        self._factors = None  # frees memory before the new factorisation
        tangent, multipliers = tangent_of(self._system, matrix, coupled), len(self._system.connectors.multipliers)
        if len(self._system.rotated[0]):
            constrained = SparseTangent(csc_array(tangent.sparse(self._system.rotated)))
            tangent = SaddleTangent(constrained, multipliers) if multipliers else constrained
        try:
            self._factors = tangent.factorised(UNROTATED)
        except LinAlgError:
            return 0.0
        return 1.0

    def solve(self, right: np.ndarray) -> None:
        """Replace a right-hand side by the solution. Raises LinAlgError."""
        if self._factors is None:
            raise LinAlgError("the tangent is singular")
        right[:] = self._factors.solve(right)


class _BandSolver:
    """Factors of a band that connectors border."""

    def __init__(self, system: System) -> None:
        self._system, self._size, self._half = system, system.unknowns.banded, system.layouts[0].half_width
        self._routines = two_sided(self._half, self._size < SHORT)
        self._factors: BorderedFactors | None = None

    def factorise(self, matrix: np.ndarray, coupled: list[np.ndarray], space: int) -> float:
        """Factorise a matrix, in place, with the tangents of connectors; space: address of numbers (n,)."""
        size, unknowns, multipliers = self._size, self._system.unknowns, len(self._system.connectors.multipliers)
        rows = address_of(matrix)
        ratio = self._routines.factor.compiled(size, self._half, address_of(unknowns.reach), rows, space)

        def solve(x: np.ndarray) -> None:
            self._routines.solve.compiled(size, self._half, rows, address_of(x))

        self._factors = None
        try:
            self._factors = BorderedFactors(size, border_of(size, multipliers, unknowns.border, coupled), solve)
        except LinAlgError:
            return 0.0
        return float(ratio)

    def solve(self, right: np.ndarray) -> None:
        """Replace a right-hand side by the solution. Raises LinAlgError."""
        if self._factors is None:
            raise LinAlgError("the tangent is singular")
        self._factors.solve(right)
