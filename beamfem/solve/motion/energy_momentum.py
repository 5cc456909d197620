"""Energy and momentum conserving steps: forces between two states with mean stresses."""

from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p, cast
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array

from beamfem.equations.equations import linearise
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import System
from beamfem.errors import ConvergenceError, InputError
from beamfem.kernels import conserving_loop
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.kernels.stage_record import Stages
from beamfem.linalg.lapack import superlu
from beamfem.linalg.tangent import UNROTATED
from beamfem.solve.motion.collocation import Midpoint
from beamfem.solve.motion.conserving_model import ConservingModel, conserving_model, not_conserved
from beamfem.solve.motion.coupled_stages import PythonRoutines
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion
from beamfem.solve.motion.marching_stages import StageSteps
from beamfem.solve.motion.stage_coefficients import coefficients
from beamfem.solve.motion.stored_states import Saving

_RULE = replace(coefficients(Midpoint()))  # times in a step, and accelerations at its end; a workspace of its own


@dataclass(frozen=True)
class EnergyMomentum:
    """Energy-momentum method: conserves energy and both momenta at any step size; second order.

    In vectors z by which all nodal vectors are linear, with rates w and a constant mass M: M (w1 - w0) / h + f = 0 and
    M (z1 - z0) / h = M (w0 + w1) / 2. f has the mean of the stresses of both states, and algebraic differences of the
    strains, which are functions of products of r', d and d', so that f . (z1 - z0) is the change of the strain energy
    (Simo and Tarnow 1992; Gonzalez 2000). Where coordinates are angles or stretches, z and w satisfy |d| = 1 and its
    rate in both states, by the constraint forces of Gonzalez (1999), which are eliminated by the null space of the
    mean state (Betsch and Leyendecker 2006).

    It is for linear elastic beams of any element. Gravity, dead loads, foundations and springs along x and y conserve
    energy too. Forces that have another potential, such as those of a `SpringDamper`, of a spring against rotation or
    of a moment, are those of the mean state, and conserve energy to second order. Raises InputError as the motion
    begins, if the model has section laws, damping of beams, imposed strains, moved supports, conditions, or bodies
    other than `PointMass` and `RigidBody`.

    Examples
    --------
    >>> free = bf.Model([beam])
    >>> motion = bf.simulate(
    ...     free, 0.1, 0.005, integrator=bf.EnergyMomentum(), velocity=bf.RigidVelocity(angular=20.0, about=(0.5, 0.0))
    ... )
    >>> bool(np.ptp(motion.energy().total) < 1e-12 * motion.energy().total[0])
    True
    """


class ConservingSteps(StageSteps):
    """Marches through steps of `EnergyMomentum`. Raises InputError for a model that is not conserved."""

    def __init__(
        self, system: System, space: MotionWorkspace, begin: float, step: float, statistics: MotionStatistics
    ) -> None:
        if (why := not_conserved(system)) is not None:
            raise InputError(f"EnergyMomentum is not for {why}; use GeneralizedAlpha or Radau")
        super().__init__(system, space, _RULE, begin, step, statistics)
        self._model = model = conserving_model(system)
        model.record.time_step = step
        self._stages.fill(conserving=model.record, factored=1)
        self._stages.routines.fill(
            predict=conserving_loop.predict, iterate=conserving_loop.iterate, complete=conserving_loop.complete
        )
        if not model.banded:
            self._in_python = (*self._in_python, _Corrections(system, space, model, self._stages))

    @property
    def why(self) -> str:
        """Why a step has failed."""
        return f"{conserving_loop.ITERATIONS} iterations did not suffice"

    def _advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """Do what `advance` does in one compiled call."""
        middles = 0.5 * (np.append(self._time, times[:-1]) + times)
        acting = middles if self._system.loads.varying else middles[:1]
        self._model.record.loads = np.array([self._model.forces(self._system, time) for time in acting.tolist()])
        return super()._advance(state, prescribed, times, saving)

    def _solved_together(self, state: np.ndarray, step: int, begins: np.ndarray, ends: np.ndarray) -> bool:
        """Return False: iterations have the tangent of each iterate already."""
        return False


class _Corrections(PythonRoutines):
    """Corrections of models whose matrix is no narrow band, or that have forces which are not in z."""

    def __init__(self, system: System, space: MotionWorkspace, model: ConservingModel, stages: Stages) -> None:
        super().__init__(model.record.left)
        self._system, self._equations, self._model, self._stages = system, space.assembler.record, model, stages
        self._function = CFUNCTYPE(c_double, c_int64)(self._guarded(self._correct))
        model.record.correct = cast(self._function, c_void_p).value

    def _correct(self, record: int) -> float:
        """See `conserving_step.correct_band`."""
        system, model, own, matrix = self._system, self._model, self._model.record, self._model.matrix
        left, time, h = own.left, float(self._equations.time), own.time_step
        motion = EquationsOfMotion(system, np.zeros(1, dtype=np.int64), time)
        if model.others is not None:
            begin = self._stages.begin[0, : len(own.p)]
            mean, rate, rest = 0.5 * (begin + own.p), (own.p - begin) / h, np.zeros_like(begin)
            weights = 0.5, 1.0 / h, 0.0
            force, tangent = linearise(system, mean, rate, rest, time, weights, equations=model.others, dt=0.5 * h)
            left[1] += force[motion.free]
            added = coo_array(tangent.sparse(UNROTATED))
            below = coo_array((added.data, (added.row + own.unknown, added.col)), shape=matrix.shape)
            matrix = csc_array(matrix + csc_array(below))
        try:
            solve = motion.solver(csr_array(matrix)) if system.inclined else superlu(matrix, full_diagonal=True).solve
        except ConvergenceError:
            return 0.0
        left[:] = solve(-left.ravel()).reshape(left.shape)
        return 1.0
