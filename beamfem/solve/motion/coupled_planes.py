"""Routines in Python for steps of collocation methods, of models with a tangent that is no plain band."""

from collections.abc import Callable
from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p, cast

import numpy as np
from scipy.sparse import csc_array

from beamfem.equations.callbacks import Deferred
from beamfem.equations.equations import tangent_of
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import System
from beamfem.kernels.compiling import Routine
from beamfem.kernels.stage_record import Stages
from beamfem.linalg.lapack import LinAlgError, superlu
from beamfem.linalg.tangent import UNROTATED, SparseTangent
from beamfem.solve.motion.constraints import onto_conditions
from beamfem.solve.motion.coupled_stages import PythonRoutines
from beamfem.solve.motion.start_acceleration import initial_acceleration

_Two = CFUNCTYPE(None, *(c_int64,) * 2)
_Three = CFUNCTYPE(None, *(c_int64,) * 3)
_Factor = CFUNCTYPE(c_double, *(c_int64,) * 2)


def is_coupled(system: System) -> bool:
    """Return whether the equations need `CoupledPlanes`."""
    unknowns = system.unknowns
    return unknowns.pattern is not None or unknowns.border_size > 0 or len(system.rotated[0]) > 0


class CoupledPlanes(PythonRoutines):
    """The routines of such steps: SuperLU factorises the matrices of the planes."""

    def __init__(self, system: System, space: MotionWorkspace, stages: Stages) -> None:
        super().__init__(stages.right)
        self._system, self._stages, self._solver = system, stages, space.solver
        self._equations, self._state, self._times = space.assembler.record, np.empty((4, 0)), np.empty(0)
        self._solvers: list[Callable[[np.ndarray], np.ndarray]] = []
        self._functions = {
            "accelerate": _Three(self._guarded(self._accelerate)),
            "factor_planes": _Factor(self._guarded(self._factor)),
            "solve_planes": _Two(self._guarded(self._solve)),
        }
        stages.routines.fill(**{name: cast(each, c_void_p).value for name, each in self._functions.items()})

    def march(self, routine: Routine, state: np.ndarray, times: np.ndarray, deferred: Deferred) -> int:
        """March a state (4, n) with loads at times (rows,) [s]; see `stage_steps.march_stages`, or another routine."""
        self.take(state, times, deferred)
        return int(routine(self._equations, self._solver, self._stages))

    def take(self, state: np.ndarray, times: np.ndarray, deferred: Deferred) -> None:
        """Take the state (4, n) that is marched, with loads at times (rows,) [s]."""
        self._state, self._times, self._deferred = state, times, deferred

    def _factor(self, solver: int, stages: int) -> float:
        """Factorise the matrices of the planes; return 1, or 0 if one is singular."""
        matrices, real = self._stages.matrices, self._stages.real
        planes = [*matrices[:real], *(matrices[real::2] + 1j * matrices[real + 1 :: 2])]
        tangents = [csc_array(tangent_of(self._system, plane).sparse(UNROTATED)) for plane in planes]
        if len(self._system.rotated[0]):
            tangents = [csc_array(SparseTangent(each).sparse(self._system.rotated)) for each in tangents]
        try:
            self._solvers = [superlu(each).solve for each in tangents]
        except LinAlgError:
            return 0.0
        return 1.0

    def _solve(self, solver: int, stages: int) -> None:
        """Replace the right-hand sides of the planes by solutions."""
        own, unknown = self._stages, self._solver.unknown
        planes = own.planes[:, :unknown]
        for number, solve in enumerate(self._solvers):
            if number < own.real:
                planes[number] = solve(planes[number].copy())
            else:
                re = 2 * number - own.real
                solution = solve(planes[re] + 1j * planes[re + 1])
                planes[re], planes[re + 1] = solution.real, solution.imag

    def _accelerate(self, system: int, solver: int, stages: int) -> None:
        """Set p'' in the state reached, and multipliers, and put it onto the conditions."""
        time, elapsed = float(self._times[self._solver.now]), self._stages.elapsed
        if len(self._system.connectors.multipliers):
            onto_conditions(self._system, self._state, time)
        self._state[2] = initial_acceleration(self._system, self._state, time, elapsed=elapsed)
