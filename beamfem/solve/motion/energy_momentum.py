"""Energy and momentum conserving steps: forces between two states with mean stresses."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dgbsv
from scipy.sparse import coo_array, csc_array, csr_array

from beamfem.equations.equations import linearise
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.kernels.conserving_step import balance, place_vectors
from beamfem.linalg.lapack import superlu
from beamfem.linalg.tangent import UNROTATED
from beamfem.results.solution import State
from beamfem.solve.motion.conserving_model import ConservingModel, conserving_model, not_conserved
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion
from beamfem.solve.motion.time_marching import initial_acceleration

_TOLERANCE = 1e-13  # of the model: a correction that ends an iteration
_NOISE = 1e-10  # of the model: smaller corrections that no longer decrease are round-off
_ITERATIONS = 30
_SINGULAR = "the tangent of a step is singular"


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
    energy too. Forces that have another potential, such as those of a `SpringDamper`, of a spring against rotation
    or of a moment, are those of the mean state, and conserve energy to second order.

    Raises
    ------
    InputError
        As the motion begins, if the model has section laws, damping of beams, imposed strains, moved supports,
        conditions, or bodies other than `PointMass` and `RigidBody`.

    Examples
    --------
    >>> free = bf.Model([beam])
    >>> motion = bf.simulate(
    ...     free, 0.1, 0.005, integrator=bf.EnergyMomentum(), velocity=bf.RigidVelocity(angular=20.0, about=(0.5, 0.0))
    ... )
    >>> bool(np.ptp(motion.energy().total) < 1e-12 * motion.energy().total[0])
    True
    """

    def run(self) -> "EnergyMomentumRun":
        """Return the integrator of one motion, which keeps its tables."""
        return EnergyMomentumRun()


class EnergyMomentumRun:
    """The steps of `EnergyMomentum` in one motion."""

    def __init__(self) -> None:
        self._model: ConservingModel | None = None
        self._forces: np.ndarray | None = None

    def step(self, motion: EquationsOfMotion, begin: State, end: float) -> State:
        """Return the state after a step. Raises ConvergenceError."""
        system, h, middle = motion.system, end - begin.at, 0.5 * (begin.at + end)
        if self._model is None:
            if (why := not_conserved(system)) is not None:
                raise InputError(f"EnergyMomentum is not for {why}; use GeneralizedAlpha or Radau")
            self._model = conserving_model(system)
        model = self._model
        if self._forces is None or system.loads.varying:
            self._forces = model.forces(system, middle)
        own = model.record
        own.fill(time_step=h, load=self._forces)
        own.p[:], own.v[:] = begin.p, begin.v
        place_vectors(own, 0)
        for way in (1.0, 0.0):  # rates of vibrations that the step does not resolve mislead
            own.p[:], own.v[:] = begin.p + way * h * begin.v, (2.0 * way - 1.0) * begin.v
            if self._solved(motion, model, begin, middle):
                state = np.array([own.p, own.v, np.zeros_like(own.p)])
                a = initial_acceleration(system_of(begin.model, static=False), state, end)
                return replace(begin, p=state[0], v=state[1], a=a, at=end)
        raise ConvergenceError(f"{_ITERATIONS} iterations did not suffice")

    def _solved(self, motion: EquationsOfMotion, model: ConservingModel, begin: State, middle: float) -> bool:
        """Find p and p' at the end of a step by Newton's method; return whether it converges."""
        own, free, before = model.record, motion.free, np.inf
        if not len(free):
            return True
        for _ in range(_ITERATIONS):
            place_vectors(own, 1)
            balance(own)
            change = self._correction(motion, model, begin, middle)
            motion.counted[0] += 1
            own.p[free] += change[0]
            own.v[free] += change[1]
            size = float(np.max(np.abs(change[0]) / motion.scale))
            if not np.isfinite(size):
                return False
            if size <= _TOLERANCE or (size <= _NOISE and size > 0.5 * before):
                return True
            before = size
        return False

    def _correction(self, motion: EquationsOfMotion, model: ConservingModel, begin: State, middle: float) -> np.ndarray:
        """Return the changes (2, unknown) of p and p'. Raises ConvergenceError."""
        system, own, left, matrix = motion.system, model.record, model.record.left, model.matrix
        if model.others is not None:
            h = own.time_step
            mean, rate, rest = 0.5 * (begin.p + own.p), (own.p - begin.p) / h, np.zeros_like(begin.p)
            weights = 0.5, 1.0 / h, 0.0
            force, tangent = linearise(system, mean, rate, rest, middle, weights, equations=model.others, dt=0.5 * h)
            left[1] += force[motion.free]
            added = coo_array(tangent.sparse(UNROTATED))
            below = coo_array((added.data, (added.row + own.unknown, added.col)), shape=matrix.shape)
            matrix = csc_array(matrix + csc_array(below))
        if isinstance(matrix, np.ndarray):
            half = (matrix.shape[0] - 1) // 3
            *_, found, failed = dgbsv(half, half, matrix, -left.T.ravel(), overwrite_ab=True, overwrite_b=True)
            if failed:
                raise ConvergenceError(_SINGULAR)
            return found.reshape(-1, 2).T[::-1]
        if system.inclined:
            return motion.solver(csr_array(matrix))(-left.ravel()).reshape(left.shape)
        try:
            return superlu(matrix, full_diagonal=True).solve(-left.ravel()).reshape(left.shape)
        except LinAlgError as error:
            raise ConvergenceError(_SINGULAR) from error
