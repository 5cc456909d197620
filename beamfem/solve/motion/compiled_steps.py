"""Time steps of the generalized-alpha family; one compiled call takes many steps."""

import numpy as np

from beamfem.equations.callbacks import Deferred
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import System
from beamfem.kernels.motion_record import MotionLimits, MotionStatistics, Rule
from beamfem.kernels.time_loop import march
from beamfem.solve.motion.coupled_stages import CoupledStages
from beamfem.solve.motion.stored_states import Saving

BAND = MotionLimits()
SPARSE, BORDERED = MotionLimits(most=24, tangent=10.0), MotionLimits(most=12, tangent=4.0)


class StepsInCalls:
    """Takes time steps, many in one compiled call; step [s]: their size; space: its own workspace."""

    def __init__(self, system: System, space: MotionWorkspace, statistics: MotionStatistics, step: float) -> None:
        self._system, self._space, self._statistics, self._step = system, space, statistics, step
        self._deferred: Deferred | None = None
        self._error: BaseException | None = None
        space.solver.remembers = system.history.compiled

    @property
    def why(self) -> str:
        """Why a step has failed."""
        raise NotImplementedError

    @property
    def broken(self) -> bool:
        """Whether an error or a Ctrl-C has ended the last call early."""
        return self._error is not None or (
            self._deferred is not None and (self._deferred.interrupted or self._deferred.lost is not None)
        )

    def _fill(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> None:
        """Hand a state, what is prescribed and the loads at times, and where rows are saved to compiled code."""
        every, assembler = self._system.loads, self._space.assembler
        loads = every.of_rows(times) if every.varying else every.at(float(times[0]))
        assembler.load(loads.body, loads.points, loads.imposing)
        assembler.place(state[0], state[1], state[2], self._space.residual, self._space.solver.rows)
        self._space.solver.fill(
            state=state,
            steps=len(prescribed),
            times=np.ascontiguousarray(times),
            prescribed_values=prescribed,
            varies=every.varying and len(times) > 1,
            body_size=4 * len(self._system.model.beams),
            bodies=loads.body,
            first_step=saving.first,
            every=saving.every,
            saved=saving.states,
            rotation_count=len(saving.pairs),
            rotation_table=saving.pairs,
            rotated_by=saving.rotations,
            saved_rotations=saving.saved_rotations,
        )

    def advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        prescribed (steps, 3, nh): prescribed coordinates and their rates at the times (steps,) [s].
        """
        history = self._system.history
        if not len(history.numbers) or self._space.solver.remembers:
            return self._advance(state, prescribed, times, saving)
        for number, time in enumerate(times.tolist()):
            step, here = slice(number, number + 1), saving.after(number)
            if not self._advance(state, prescribed[step], times[step], here):
                return number
            state[0] = history.committed((state[0], state[1], state[2]), time, self._step)
            here.keep_state(0, state)
            if self._deferred is not None and self._deferred.interrupted:
                return number + 1
        return len(times)

    def _advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """Do what `advance` does in one compiled call."""
        raise NotImplementedError

    def memory(self, state: np.ndarray) -> None:
        """Return None: the state (4, n) is all that the next steps need."""

    def recall(self, memory: object, state: np.ndarray) -> None:
        """Recall nothing."""

    def raise_error(self) -> None:
        """Raise what has ended the last call early, if it was an error or a Ctrl-C."""
        if self._deferred is not None:
            self._deferred.deliver()
        if self._error is not None:
            raise self._error


class CompiledSteps(StepsInCalls):
    """Marches through time steps; keeps tangent and differences of the acceleration between calls.

    rule: step, alpha_m, alpha_f, gamma, beta.
    """

    def __init__(self, system: System, space: MotionWorkspace, rule: np.ndarray, statistics: MotionStatistics) -> None:
        h, alpha_m, alpha_f, gamma, beta = map(float, rule)
        super().__init__(system, space, statistics, h)
        sparse, bordered = system.unknowns.pattern is not None, system.unknowns.border_size > 0
        self._limits = SPARSE if sparse else BORDERED if bordered or system.called else BAND
        space.solver.fill(
            rule=Rule(time_step=h, alpha_m=alpha_m, alpha_f=alpha_f, gamma=gamma, beta=beta),
            limits=self._limits,
            statistics=statistics,
        )
        space.solver.differences[:] = 0.0
        space.assembler.weigh((1.0, gamma / (h * beta), (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))), self._step)
        space.assembler.require("tangent", "prediction")
        self._coupled = CoupledStages(system, space) if sparse else None

    @property
    def why(self) -> str:
        """Why a step has failed."""
        size, most = self._statistics.correction, self._limits.iterations
        if size <= self._limits.tolerance:  # they end, but `kernels.time_loop` refuses where
            return "its iterations end in a state in which beams are turned inside out"
        return f"the last correction was {size:.2e} of the model after {most} iterations at most"

    def _advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """Do what `advance` does in one compiled call."""
        space, unknowns = self._space, self._system.unknowns
        assembler, solver = space.assembler, space.solver
        self._fill(state, prescribed, times, saving)
        conditions = len(solver.multipliers) if self._coupled is None else 0  # stages in Python keep them themselves
        solver.fill(bordered=self._coupled is None and unknowns.border_size > 0, conditions=conditions)
        if self._coupled is None and not assembler.calls_python:
            return int(march(assembler.record, solver))
        with Deferred() as self._deferred:
            if self._coupled is None:
                completed = int(march(assembler.record, solver))
            else:
                completed = self._coupled.march(state, self._deferred)
        errors = () if self._coupled is None else (self._coupled.take_error(),)
        self._error = next((error for error in (*errors, assembler.take_error()) if error is not None), None)
        return completed if self._deferred.lost is None else 0
