"""Time steps of models whose tangent is not a narrow band, or with history: those of `kernels.march` one by one.

A step is solved to the same tolerances, but a factorisation is kept longer, since it costs as much as ten iterations.
"""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import linearise, predicted_stresses, residual
from beamfem.assembly.system import System
from beamfem.kernels.extrapolation import complete, difference_rows, padded, predict
from beamfem.kernels.motion_steps import FAR, SMALLEST_RATE, check_convergence, correct
from beamfem.kernels.rollers import stay_on_planes
from beamfem.linalg.tangent import Factorised
from beamfem.solve.motion.limits import not_converged

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
        self._weights = np.array(self.coefficients)
        size = system.model.size
        self._inverse_scale = np.zeros(padded(size))
        self._inverse_scale[system.free_dofs] = 1.0 / system.scale[system.free_dofs]
        self._differences, self._size, self._number = np.zeros(difference_rows(size)), size, np.zeros(2)
        self._change = np.zeros(padded(size))
        self._multipliers, self.dt = system.connectors.multipliers, float(h)
        self._factors: Factorised | None = None

    @property
    def why(self) -> str:
        """Why a step has failed."""
        return not_converged(self.statistics)

    def take(self, state: np.ndarray, before: np.ndarray, prescribed: np.ndarray, time: float) -> bool:
        """See `single_steps.Step`."""
        if not self._solve(state, before, prescribed, time):
            return False
        dofs, statistics = self.system.prescribed_dofs, self.statistics
        differences, scale, order = self._differences, self._inverse_scale, statistics[6:8]
        change = complete(self._size, len(dofs), state, before, differences, scale, dofs, self.rule, order)
        statistics[8] = change / self.coefficients[2]
        return True

    def _solve(self, state: np.ndarray, before: np.ndarray, prescribed: np.ndarray, time: float) -> bool:
        """Iterate for the end of a step: with the last tangent, with a new one, and then with one for each iterate.

        The iteration starts from the previous acceleration or the previous positions, first from those that were
        nearer.
        """
        order = float(self.statistics[6])
        reusable = self.statistics[4] >= 0.0 and self._factors is not None
        if reusable and self._iterate(state, before, prescribed, time, order, full=False, fresh=False):
            return True
        solved = self._iterate(state, before, prescribed, time, order, full=False, fresh=True)
        near = -1.0 if order < 0.0 or self.statistics[7] == 0.0 else 0.0  # nothing is known before the first step
        return solved or any(
            self._iterate(state, before, prescribed, time, low, full=True, fresh=True) for low in (near, -1.0 - near)
        )

    def _iterate(
        self,
        state: np.ndarray,
        before: np.ndarray,
        prescribed: np.ndarray,
        time: float,
        order: float,
        full: bool,
        fresh: bool,
    ) -> bool:
        """Iterate and return whether the error is small enough; full: a new tangent for each iterate.

        order: of the extrapolation of the acceleration, see `extrapolation.predict`.
        """
        statistics, most = self.statistics, self.iterations if full else min(_MOST, self.iterations)
        free = self.system.free_dofs
        rate = 1.0 if fresh else max(statistics[4], SMALLEST_RATE) ** 0.8
        size, first_size, done, iteration, far = 0.0, 0.0, False, 0, 0
        stresses: tuple[np.ndarray, ...] | None = None
        state[:] = before
        dofs = self.system.prescribed_dofs
        predict(self._size, len(dofs), order, state, before, self._differences, dofs, prescribed, self.rule)
        first, normal = self.system.rotated
        stay_on_planes(self._size, len(first), first, normal, free, state, before)
        state[0, self._multipliers] = before[0, self._multipliers]
        while iteration < most and not done:
            renew = fresh or full or self._factors is None
            try:
                right = self._correction(state, time, renew, stresses)
            except LinAlgError:
                break
            if full:
                self._change[free] = right
                rates = state[1], self.coefficients
                step = self._change[: self._size]
                stresses = predicted_stresses(self.system, state[0], step, time, rates=rates, dt=self.dt)
            scale = self._inverse_scale
            last, size = (
                size,
                correct(self._size, len(free), -1, state, right, free, scale, self._weights, self._change),
            )
            state[1:, self._multipliers] = 0.0  # multipliers have no rates
            iteration += 1
            statistics[0] += 1
            statistics[2] = size
            if iteration == 1:
                first_size, far = max(size, statistics[8]), int(size > FAR)
            self._number[0] = rate
            outcome = check_convergence(
                *(
                    iteration,
                    int(full),
                    int(renew),
                    far,
                    size,
                    last,
                    first_size,
                    self.tolerance,
                    self._number,
                    statistics[9:],
                )
            )
            if (
                outcome == 1
                and (full or first_size > FAR)
                and not self.system.assembler().smallest_jacobian(state[0]) > 0.0
            ):
                outcome = -1  # an element is inverted, which no motion can lead to
            done, fresh, rate = outcome == 1, outcome == 2, float(self._number[0])
            if not fresh and (outcome < 0 or (not full and iteration > 1 and rate >= 0.5)):
                break
        statistics[1] = max(statistics[1], iteration)
        statistics[4] = -1.0 if not done or iteration > _MANY or (iteration > 1 and rate > _SLOW) else rate
        return done

    def _correction(
        self, state: np.ndarray, time: float, renew: bool, stresses: tuple[np.ndarray, ...] | None
    ) -> np.ndarray:
        """Return the correction (unknown,) of p, with a new tangent or the previous one. Raises LinAlgError.

        stresses: for a new tangent, see `linearise`.
        """
        p, v, a, _ = state
        if renew or self._factors is None:
            self._factors = None  # frees memory before the new factorisation
            unbalanced, tangent = linearise(self.system, p, v, a, time, self.coefficients, stresses, None, self.dt)
            self._factors = tangent.factorised(self.system.rotated)
            self.statistics[5] += 1
        else:
            unbalanced = residual(self.system, p, v, a, time, self.dt)
        return self._factors.solve(-unbalanced[self.system.free_dofs])
