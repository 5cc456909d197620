"""Pairs of time steps whose size follows a tolerance; one compiled call takes many of them."""

from ctypes import CFUNCTYPE, c_int64, c_void_p, cast

import numpy as np

from beamfem.equations.callbacks import Deferred, KeptErrors
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import System
from beamfem.kernels.doubled_steps import march_doubled
from beamfem.kernels.motion_record import MotionLimits, MotionStatistics
from beamfem.kernels.predictor import padded
from beamfem.kernels.stage_record import Doubled, DoubledRoutines, Stages
from beamfem.results.energy_balance import masses
from beamfem.solve.motion.compiled_steps import StepsInCalls
from beamfem.solve.motion.coupled_planes import CoupledPlanes, is_coupled
from beamfem.solve.motion.cut_steps import Rows
from beamfem.solve.motion.marching_stages import workspace_of
from beamfem.solve.motion.stage_coefficients import Coefficients
from beamfem.solve.motion.stored_states import Saving
from beamfem.solve.motion.time_steps import Stretch

_Sample = CFUNCTYPE(None, c_int64)


class DoubledSteps(StepsInCalls):
    """Marches through pairs of steps by a method of an order; keeps factors and accelerations between calls.

    record: its times, step and counts, see there.
    """

    def __init__(
        self, system: System, space: MotionWorkspace, rule: Coefficients, order: int, statistics: MotionStatistics
    ) -> None:
        super().__init__(system, space, statistics, 0.0)
        self._rule, self._errors = rule, KeptErrors()
        self._moved = any(callable(item.value) for item in system.prescribed)
        self._callback = _Sample(self._guarded)
        self.record = Doubled(fine=self._method("fine"), coarse=self._method("coarse"))
        varies = self._moved or system.loads.varying or bool(system.called)
        own, s, solver = self.record, len(rule.nodes), space.solver
        methods = (own.fine, own.coarse) if is_coupled(system) else ()
        self._coupled = [CoupledPlanes(system, space, each) for each in methods]
        scale = np.zeros(padded(solver.size))
        scale[: solver.size][system.positions] = 1.0 / system.extent
        powers = np.arange(2 * s)[:, None]
        known = np.append(rule.nodes, 1.0 + rule.nodes)
        gathered = np.linalg.solve(known**powers, (2.0 * rule.nodes) ** powers).T
        own.fill(
            routines=DoubledRoutines.usual(**({"sample": cast(self._callback, c_void_p).value} if varies else {})),
            fine_directions=solver.kept_directions,
            coarse_directions=np.zeros_like(solver.kept_directions),
            varies=varies,
            weights=rule.weights(1.0),
            shares=rule.samples,
            gathered=np.ascontiguousarray([gathered[:, :s], gathered[:, s:]]),
            divisor=2.0**order - 1.0,
            power=1.0 / order,
            scale=scale,
            at_begin=np.empty((4, solver.size)),
            **{name: np.ascontiguousarray(getattr(rule, name)) for name in ("of_p", "of_v", "of_begin", "at_end")},
        )
        solver.fill(limits=MotionLimits(), statistics=statistics)
        space.assembler.weigh((1.0, 1.0, 1.0), 0.0, moving=True)
        space.assembler.require("tangent")

    def _method(self, which: str) -> Stages:
        """Return the method, with workspace of its own, without a step yet."""
        space, key, s = self._space, (self._rule, which), len(self._rule.nodes)
        mass = 0.5 * float(self._system.table(masses)[self._system.positions].sum())
        own = space.stages.pop(key, None)
        own = space.stages[key] = workspace_of(self._system, space, self._rule) if own is None else own
        own.fill(
            time_step=0.0,
            elapsed=0.0,
            per_work=1.0 / (self._system.extent**2 * mass),
            rate=0.0,
            known=0,
            factored=0,
            solved=0,
            ahead=np.zeros((s, s + 1)),
            at_end=self._rule.at_end.copy(),
            of_p=np.zeros((s, s)),
            of_v=np.zeros((s, s)),
            of_begin=np.zeros((s, 2)),
            weights=np.zeros((s, 3)),
        )
        return own

    def follow(self, part: Stretch, state: np.ndarray, rotations: np.ndarray, room: int) -> tuple[np.ndarray, Rows]:
        """March a state (4, n) and rotations (m,) [rad] to the end of a stretch, in place, by `room` steps at most.

        Return the times (k + 1,) [s] of the beginning and of the ends of the steps, and rows.
        """
        system, solver, own = self._system, self._space.solver, self.record
        rows, times = Rows.empty(room, state, rotations), np.zeros(3 * len(self._rule.samples))
        held, pairs = np.zeros((len(times), 3, len(system.prescribed_dofs))), system.model.numbered.rotation_pairs
        held[:, 0] = system.prescribed_values(0.0)
        self._part = part
        self._fill(state, held, times, Saving(rows.states, 1, 1, pairs, rotations, rows.rotations))
        solver.fill(conditions=len(system.connectors.multipliers))
        own.fill(
            end=float(part.times[-1]),
            failed=0,
            filled=0,
            room=room,
            ends=np.full(room + 1, own.time),
            turned=np.empty(len(pairs)),
        )
        if not (self._coupled or self._space.assembler.calls_python or own.varies):
            march_doubled(self._space.assembler.record, solver, own)
        else:
            with Deferred() as self._deferred:
                self._called(state, self._deferred)
        return own.ends[: own.filled + 1].copy(), rows.between(0, own.filled)

    def _called(self, state: np.ndarray, deferred: Deferred) -> None:
        """March with routines in Python, and keep the first error in them."""
        space = self._space
        for each in self._coupled:
            each.take(state, space.solver.times, deferred)
        march_doubled(space.assembler.record, space.solver, self.record)
        found = [self._errors.take(), *(each.take_error() for each in self._coupled), space.assembler.take_error()]
        self._error = next((each for each in found if each is not None), None)

    def _guarded(self, solver: int) -> None:
        """Sample what changes with time; an error spoils the times, and ends the steps."""
        try:
            self._sample()
        except BaseException as error:
            self._errors.keep(error)
            self._space.solver.state[:] = np.nan

    def _sample(self) -> None:
        """Sample loads and prescribed coordinates for two steps and the double one."""
        system, solver, rule, part = self._system, self._space.solver, self._rule, self._part
        solver.times[:] = np.clip(solver.times, part.loads_from, part.loads_to)
        if system.loads.varying:
            loads = system.loads.of_rows(solver.times)
            self._space.assembler.load(loads.body, loads.points, loads.imposing)
            solver.bodies = loads.body
        if self._moved:
            begin, h, end = self.record.time, self.record.fine.time_step, self.record.end
            spans = ((begin, h), (begin + h, h), (begin, 2.0 * h))
            moved = np.concatenate([rule.moved(system, first, min(first + size, end), size) for first, size in spans])
            moved[:, 0] += system.reference[system.prescribed_dofs]
            solver.prescribed_values[:] = moved
