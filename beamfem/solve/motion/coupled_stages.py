"""Stages of compiled time steps for models with a sparse tangent: routines that call Python."""

from collections.abc import Callable
from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p, cast
from typing import Any

import numpy as np
from scipy.sparse import csc_array

from beamfem.equations.callbacks import Deferred, KeptErrors
from beamfem.equations.equations import tangent_of
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import System
from beamfem.kernels import motion_steps, rollers
from beamfem.kernels.time_loop import march
from beamfem.linalg.lapack import LinAlgError
from beamfem.linalg.tangent import UNROTATED, Factorised, SaddleTangent, SparseTangent

_Factor = CFUNCTYPE(c_double, *(c_int64,) * 2, *(c_void_p,) * 3)
_Solve = CFUNCTYPE(None, *(c_int64,) * 2, *(c_void_p,) * 2)
_Correct = CFUNCTYPE(c_double, *(c_int64,) * 2)


class PythonRoutines:
    """Routines in Python that compiled time steps call; spoiled: right-hand sides that an error fills with nan.

    An error in them cannot propagate through compiled code: it is kept, the corrections become nan, which ends any
    iteration, and `take_error` returns it. So do they where a tangent cannot be formed.
    """

    def __init__(self, spoiled: np.ndarray) -> None:
        self._spoiled, self._errors, self._deferred = spoiled, KeptErrors(), Deferred()
        self._factors: Factorised | None = None

    def take_error(self) -> BaseException | None:
        """Return the first error since the last call, if there is one."""
        return self._errors.take()

    def _guarded(self, function: Callable[..., float | None]) -> Callable[..., Any]:
        """Return a function that compiled code may call: it raises nothing."""

        def guarded(*arguments: int) -> float | None:
            try:
                if not (self._errors.waiting or self._deferred.lost):
                    return function(*arguments)
            except LinAlgError:
                self._factors = None
            except BaseException as error:
                self._errors.keep(error)
            self._spoiled[:] = np.nan
            return np.nan

        return guarded


class CoupledStages(PythonRoutines):
    """The routines of a motion with a sparse tangent."""

    def __init__(self, system: System, space: MotionWorkspace) -> None:
        super().__init__(space.solver.right)
        self.system = system
        self._state, self._equations, self._solver = np.empty((4, 0)), space.assembler.record, space.solver
        self._functions = {
            "factor": _Factor(self._guarded(self._factor)),
            "solve_both": _Solve(self._guarded(self._solve)),
            "correct": _Correct(self._guarded(self._correct)),
        }
        self._routines = space.solver.routines.copy()
        self._routines.constrain_normals = rollers.constrain_nothing
        self._routines.fill(**{name: cast(each, c_void_p).value for name, each in self._functions.items()})

    def march(self, state: np.ndarray, deferred: Deferred) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n); see `time_loop.march`."""
        self._state, self._deferred = state, deferred
        usual, self._solver.routines = self._solver.routines, self._routines
        try:
            return int(march(self._equations, self._solver))
        finally:
            self._solver.routines = usual

    def _factor(self, unknown: int, half: int, reach: int, rows: int, space: int) -> float:
        """Factorise the tangent; return 1, or 0 if it is singular."""
        system, self._factors = self.system, None  # frees memory before the new factorisation
        tangent, multipliers = tangent_of(system, self._solver.rows), len(system.connectors.multipliers)
        if len(system.rotated[0]):
            constrained = SparseTangent(csc_array(tangent.sparse(system.rotated)))
            tangent = SaddleTangent(constrained, multipliers) if multipliers else constrained
        try:
            self._factors = tangent.factorised(UNROTATED)
        except LinAlgError:
            return 0.0
        return 1.0

    def _solve(self, unknown: int, half: int, rows: int, right: int) -> None:
        """Replace the right-hand side by the solution, nan if the tangent is singular."""
        if self._factors is None:
            raise LinAlgError("the tangent is singular")
        self._solver.right[:] = self._factors.solve(self._solver.right)

    def _correct(self, system: int, solver: int) -> float:
        """See `motion_steps.correct`."""
        size = motion_steps.correct.compiled(system, solver)
        self._state[1:3, self.system.connectors.multipliers] = 0.0  # multipliers have no rates
        return float(size)
