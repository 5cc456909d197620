"""Time steps of methods with stages; one compiled call takes many steps."""

from collections.abc import Callable

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import csr_array

from beamfem.equations.callbacks import Deferred
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import System
from beamfem.errors import ConvergenceError
from beamfem.kernels.complex_band import complex_band
from beamfem.kernels.explicit_steps import march_explicit
from beamfem.kernels.motion_record import MotionLimits, MotionStatistics
from beamfem.kernels.predictor import padded
from beamfem.kernels.records import aligned
from beamfem.kernels.stage_record import StageRoutines, Stages
from beamfem.kernels.stage_steps import march_stages, predict
from beamfem.solve.motion.compiled_steps import StepsInCalls
from beamfem.solve.motion.coupled_planes import CoupledPlanes, is_coupled
from beamfem.solve.motion.coupled_stages import PythonRoutines
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion
from beamfem.solve.motion.stage_coefficients import Coefficients
from beamfem.solve.motion.stored_states import Saving

_KEPT = 0.1  # rate of convergence up to which factors are kept for the next step
_WORKSPACE = ("begin", "p", "v", "a", "last", "change", "forces", "right", "planes", "matrices", "rotations")
_TOGETHER = 1e-11  # of the model: correction that ends an iteration on all stages


class StageSteps(StepsInCalls):
    """Marches through time steps; keeps factors and accelerations of the stages between calls.

    begin, step [s]: time at the start of the first step, and size of the steps.
    """

    def __init__(
        self,
        system: System,
        space: MotionWorkspace,
        rule: Coefficients,
        begin: float,
        step: float,
        statistics: MotionStatistics,
    ) -> None:
        super().__init__(system, space, statistics, step)
        self._rule, self._time, h = rule, begin, step
        self._routine = march_explicit if rule.explicit else march_stages
        found = space.stages.pop(rule, None)
        self._stages = own = space.stages[rule] = workspace_of(system, space, rule) if found is None else found
        own.fill(elapsed=0.0, accuracy=0.0, per_work=0.0, rate=0.0, known=0, factored=0, solved=0)
        if own.time_step != h:
            _fill_step(own, rule, h)
        self._coupled = CoupledPlanes(system, space, own) if is_coupled(system) else None
        self._in_python: tuple[PythonRoutines, ...] = () if self._coupled is None else (self._coupled,)
        space.solver.fill(limits=MotionLimits(), statistics=statistics)
        space.assembler.weigh((1.0, 1.0, 1.0), h, moving=True)
        space.assembler.require("tangent")

    @property
    def why(self) -> str:
        """Why a step has failed."""
        size = self._statistics.correction
        if self._rule.explicit:
            return "it moves the model by more than its size, so that it is too long to be stable"
        of = ", which leave vibrations that steps do not resolve undamped, unlike Radau," if self._undamped else ""
        return f"the iteration on its stages{of} did not converge; the last correction was {size:.2e} of the model"

    @property
    def _undamped(self) -> bool:
        """Whether the end of a step is no stage, as in Gauss methods."""
        return len(self._rule.samples) > len(self._rule.nodes)

    def _advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """Do what `advance` does in one compiled call."""
        system, rule, space, own = self._system, self._rule, self._space, self._stages
        solver, begins = space.solver, np.append(self._time, times[:-1])
        sampled = (begins[:, None] + np.outer(times - begins, rule.samples)).ravel()
        self._fill(state, self._prescribed(begins, times), sampled, saving)
        solver.fill(conditions=len(system.connectors.multipliers))
        if not (self._in_python or space.assembler.calls_python):
            done = self._march(state, begins, times, lambda: self._routine(space.assembler.record, solver, own))
        else:
            with Deferred() as self._deferred:
                done = self._march(state, begins, times, lambda: self._called(state, sampled))
        self._time = float(times[done - 1]) if done else self._time
        return done

    def _called(self, state: np.ndarray, times: np.ndarray) -> int:
        """March with routines in Python, and keep the first error in them."""
        space, coupled = self._space, self._coupled
        if coupled is None:
            done = int(self._routine(space.assembler.record, space.solver, self._stages))
        else:
            done = coupled.march(self._routine, state, times, self._deferred or Deferred())
        errors = [each.take_error() for each in self._in_python]
        self._error = next((each for each in (*errors, space.assembler.take_error()) if each is not None), None)
        return done

    def _march(self, state: np.ndarray, begins: np.ndarray, ends: np.ndarray, march: Callable[[], int]) -> int:
        """March through steps between times [s]; a step that fails is solved with the tangents of all its stages."""
        done, self._stages.steps = 0, len(ends)
        while True:
            self._stages.first = done
            done = march()
            if (
                done == len(ends)
                or self.broken
                or self._rule.explicit
                or not self._solved_together(state, done, begins, ends)
            ):
                return done

    def _prescribed(self, begins: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Return prescribed coordinates and their rates (rows, 3, nh) at the stages of steps, and at their ends [s]."""
        system, rule = self._system, self._rule
        result = np.zeros((len(ends), len(rule.samples), 3, len(system.prescribed_dofs)))
        result[:, :, 0] = system.prescribed_values(0.0)
        if any(callable(item.value) for item in system.prescribed):
            for own, begin, end in zip(result, begins.tolist(), ends.tolist(), strict=True):
                own[:] = rule.moved(system, begin, end, self._step)
            result[:, :, 0] += system.reference[system.prescribed_dofs]
        return result.reshape(len(ends) * len(rule.samples), *result.shape[2:])

    def _solved_together(self, state: np.ndarray, step: int, begins: np.ndarray, ends: np.ndarray) -> bool:
        """Solve for the stages of a step by Newton's method on all of them; return whether it has converged.

        Each stage has a tangent of its own.
        """
        system, own, counted, n = self._system, self._stages, np.zeros(1, dtype=np.int64), state.shape[1]
        motion = EquationsOfMotion(system, counted, float(begins[step]))
        times = (begins[step] + (ends[step] - begins[step]) * self._rule.nodes).tolist()
        p, v, a = (rows[:, :n] for rows in (own.p, own.v, own.a))
        stages = range(len(times))
        weights = [[(float(own.of_p[i, j]), float(own.of_v[i, j]), float(i == j)) for j in stages] for i in stages]

        def linearised() -> tuple[np.ndarray, list[list[csr_array]]]:
            states = list(zip(p, v, a, times, strict=True))
            left = np.array([motion.residual(*each) for each in states])
            return left, [[motion.tangent(*states[i], weights[i][j]) for j in stages] for i in stages]

        def move(change: np.ndarray) -> np.ndarray:
            a[:, motion.free] += change
            p[:, motion.free] += own.of_p @ change
            v[:, motion.free] += own.of_v @ change
            return own.of_p @ change

        for attempt in (1, 2):
            predict(self._space.assembler.record, self._space.solver, own, step, attempt)
            try:
                motion.iterate(linearised, move, _TOGETHER)
                own.solved = 1
            except (ConvergenceError, LinAlgError):
                continue
            finally:
                self._statistics.iterations += int(counted[0])
                counted[0] = 0
            return True
        return False


def _fill_step(own: Stages, rule: Coefficients, h: float) -> None:
    """Set the size of the steps [s], and what follows from it."""
    own.fill(
        time_step=h,
        of_p=h * h * rule.of_p,
        of_v=h * rule.of_v,
        of_begin=rule.of_begin * (h * h, h),
        at_end=rule.at_end * [[h * h], [h], [1.0]],
        weights=rule.weights(h),
    )


def workspace_of(system: System, space: MotionWorkspace, rule: Coefficients) -> Stages:
    """Return a method with workspace, for steps of any size."""
    solver = space.solver
    own = Stages(
        stages=len(rule.nodes),
        real=rule.real,
        samples=len(rule.samples),
        stride=padded(solver.size),
        height=padded(solver.unknown),
        entries=0 if rule.explicit else system.unknowns.entries,
        turned=2 * solver.node_stride,
        error_factor=rule.error[0],
        error_power=rule.error[1],
        kept_rate=_KEPT,
    )
    factors = complex_band(solver.half)
    own.fill(
        routines=StageRoutines.usual(factor_complex=factors.factor, solve_complex=factors.solve),
        nodes=rule.nodes,
        ahead=rule.ahead,
        into=rule.into,
        back=rule.of_p @ rule.back,
        to_accelerations=rule.of_p if rule.explicit else np.linalg.inv(rule.of_p),
        **aligned(own.shapes(*_WORKSPACE)),
    )
    return own
