"""Time steps of models whose tangent is not a narrow band, or with history: those of `kernels.march` one by one.

A step is solved to the same tolerances, but a factorisation is kept longer, since it costs as much as ten iterations.
"""

import numpy as np

from beamfem.assembly.equations import linearise, predicted_stresses, residual
from beamfem.assembly.system import System
from beamfem.kernels.extrapolation import complete, difference_rows, padded, predict
from beamfem.kernels.motion_steps import CONVERGED, DIVERGED, FAR, RENEW, SMALLEST_RATE, check_convergence, correct
from beamfem.kernels.rollers import stay_on_planes
from beamfem.linalg.tangent import Factorised
from beamfem.solve.motion.limits import not_converged
from beamfem.solve.newton.convergence import Correction
from beamfem.solve.newton.iteration import Termination
from beamfem.solve.newton.loop import iterate

# Simplified Newton iterations: the number after which a step starts again with the full Newton method; the number, and
# the rate of convergence, above which the next step gets a new tangent.
_MOST, _MANY, _SLOW = 24, 16, 0.5


class SparseStep:
    """A step of the generalized-alpha method with a sparse tangent, whose factors it keeps for the next one.

    rule: step, alpha_m, alpha_f, gamma, beta; limits: tolerance of the correction relative to the scale of a
    coordinate, largest number of iterations; statistics (10,): see `kernels.march.march`.
    """

    def __init__(self, system: System, rule: np.ndarray, limits: np.ndarray, statistics: np.ndarray) -> None:
        h, alpha_m, alpha_f, gamma, beta = rule
        self.system, self.rule, self.statistics = system, rule, statistics
        self.tolerance, self.iterations = float(limits[0]), int(limits[1])
        self.coefficients = 1.0, gamma / (h * beta), (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))
        self.weights = np.array(self.coefficients)
        size = system.model.size
        self.inverse_scale = np.zeros(padded(size))
        self.inverse_scale[system.free_dofs] = 1.0 / system.scale[system.free_dofs]
        self.differences, self.change = np.zeros(difference_rows(size)), np.zeros(padded(size))
        self.multipliers, self.dt = system.connectors.multipliers, float(h)
        self.factors: Factorised | None = None

    @property
    def why(self) -> str:
        """Why a step has failed."""
        return not_converged(self.statistics)

    def take(self, state: np.ndarray, before: np.ndarray, prescribed: np.ndarray, time: float) -> bool:
        """See `single_steps.Step`."""
        if not self._solve(state, before, prescribed, time):
            return False
        dofs, statistics = self.system.prescribed_dofs, self.statistics
        differences, scale, order = self.differences, self.inverse_scale, statistics[6:8]
        size = self.system.model.size
        change = complete(size, len(dofs), state, before, differences, scale, dofs, self.rule, order)
        statistics[8] = change / self.coefficients[2]
        return True

    def _solve(self, state: np.ndarray, before: np.ndarray, prescribed: np.ndarray, time: float) -> bool:
        """Iterate for the end of a step: with the last tangent, with a new one, and then with one for each iterate.

        The iteration starts from the previous acceleration or the previous positions, first from those that were
        nearer.
        """
        order = float(self.statistics[6])
        near = -1.0 if order < 0.0 or self.statistics[7] == 0.0 else 0.0  # nothing is known before the first step
        ways = [(order, False, True), (near, True, True), (-1.0 - near, True, True)]
        if self.statistics[4] >= 0.0 and self.factors is not None:
            ways.insert(0, (order, False, False))
        return any(_Iteration(self, state, prescribed, time, *way).converges(before) for way in ways)

    def correction(
        self, state: np.ndarray, time: float, renew: bool, stresses: tuple[np.ndarray, ...] | None
    ) -> np.ndarray:
        """Return the correction (unknown,) of p, with a new tangent or the previous one. Raises LinAlgError.

        stresses: for a new tangent, see `linearise`.
        """
        p, v, a, _ = state
        if renew or self.factors is None:
            self.factors = None  # frees memory before the new factorisation
            unbalanced, tangent = linearise(self.system, p, v, a, time, self.coefficients, stresses, None, self.dt)
            self.factors = tangent.factorised(self.system.rotated)
            self.statistics[5] += 1
        else:
            unbalanced = residual(self.system, p, v, a, time, self.dt)
        return self.factors.solve(-unbalanced[self.system.free_dofs])


class _Iteration:
    """The iteration for the end of a step, from an extrapolated acceleration.

    order: of the extrapolation, see `extrapolation.predict`; full: whether there is a new tangent for each iterate;
    fresh: whether there is one for the first iterate.
    """

    def __init__(
        self,
        step: SparseStep,
        state: np.ndarray,
        prescribed: np.ndarray,
        time: float,
        order: float,
        full: bool,
        fresh: bool,
    ) -> None:
        self.step, self.state, self.prescribed, self.time = step, state, prescribed, time
        self.order, self.full, self.fresh = order, full, fresh
        self.rate = np.array([1.0 if fresh else max(step.statistics[4], SMALLEST_RATE) ** 0.8, 0.0])
        self.number, self.size, self.first, self.far, self.renewed = 0, 0.0, 0.0, 0, False
        self.stresses: tuple[np.ndarray, ...] | None = None

    def converges(self, before: np.ndarray) -> bool:
        """Iterate from the state (4, n) before the step, and return whether the error is small enough."""
        self._predict(before)
        statistics, most = self.step.statistics, self.step.iterations
        done = iterate(self, most if self.full else min(_MOST, most)).ended.good
        statistics[1] = max(statistics[1], self.number)
        slow = self.number > _MANY or (self.number > 1 and self.rate[0] > _SLOW)
        statistics[4] = -1.0 if not done or slow else self.rate[0]
        return done

    def correct(self) -> Correction:
        """Take the next correction. Raises LinAlgError."""
        step, system, state = self.step, self.step.system, self.state
        self.renewed = self.fresh or self.full or step.factors is None
        right = step.correction(state, self.time, self.renewed, self.stresses)
        free, size = system.free_dofs, system.model.size
        if self.full:
            step.change[free] = right
            rates = state[1], step.coefficients
            self.stresses = predicted_stresses(system, state[0], step.change[:size], self.time, rates=rates, dt=step.dt)
        last = self.size
        self.size = correct(size, len(free), -1, state, right, free, step.inverse_scale, step.weights, step.change)
        state[1:, step.multipliers] = 0.0  # multipliers have no rates
        self.number += 1
        step.statistics[0] += 1
        step.statistics[2] = self.size
        if self.number == 1:
            self.first, self.far = max(self.size, step.statistics[8]), int(self.size > FAR)
        return Correction(self.number, self.size, last, 0)

    def check(self, correction: Correction) -> Termination | None:
        """See `loop.Problem`."""
        number, size, last, _ = correction
        flags, noise = (int(self.full), int(self.renewed), self.far), self.step.statistics[9:]
        outcome = check_convergence(number, *flags, size, last, self.first, self.step.tolerance, self.rate, noise)
        self.fresh = outcome == RENEW
        if outcome == CONVERGED and (self.full or self.first > FAR):
            inverted = not self.step.system.assembler().smallest_jacobian(self.state[0]) > 0.0
            return Termination.INVERTED if inverted else Termination.CONVERGED
        if outcome == CONVERGED:
            return Termination.CONVERGED
        if outcome == DIVERGED:
            return Termination.DIVERGED
        slow = not self.full and number > 1 and self.rate[0] >= 0.5
        return Termination.EXHAUSTED if slow and not self.fresh else None

    def _predict(self, before: np.ndarray) -> None:
        """Set the state with which the iteration begins."""
        step, system, state, dofs = self.step, self.step.system, self.state, self.step.system.prescribed_dofs
        size = system.model.size
        state[:] = before
        predict(size, len(dofs), self.order, state, before, step.differences, dofs, self.prescribed, step.rule)
        first, normal = system.rotated
        stay_on_planes(size, len(first), first, normal, system.free_dofs, state, before)
        state[0, step.multipliers] = before[0, step.multipliers]
