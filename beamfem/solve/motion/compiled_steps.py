"""Time steps of the generalized-alpha family; one compiled call takes many steps."""

import numpy as np

from beamfem.assembly.callbacks import Deferred
from beamfem.assembly.motion_workspace import MotionWorkspace
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.motion_record import CORRECTION, TIME_STEP, MotionLimits
from beamfem.kernels.pointers import address_of
from beamfem.kernels.time_loop import march
from beamfem.solve.motion.coupled_stages import CoupledStages, is_weak
from beamfem.solve.motion.stored_states import Saving

BAND = MotionLimits()
SPARSE = MotionLimits(most=24, many=16, slow=0.5)  # a factorisation costs as much as ten iterations
BORDERED = MotionLimits(most=12, many=6, slow=0.2)  # with the tangents of connectors, as much as four


def not_converged(statistics: np.ndarray, limits: MotionLimits) -> str:
    """Return why a step has failed; statistics: see `kernels.motion_record`."""
    return (
        f"the last correction was {statistics[CORRECTION]:.2e} of the model after {limits.iterations} iterations at "
        "most. A smaller step may help"
    )


class CompiledSteps:
    """Marches through time steps; keeps tangent and differences of the acceleration between calls.

    space: its own workspace; rule: step, alpha_m, alpha_f, gamma, beta; statistics: see
    `kernels.motion_record`.
    """

    def __init__(self, system: System, space: MotionWorkspace, rule: np.ndarray, statistics: np.ndarray) -> None:
        self._system, self._space, self._statistics, self._step = system, space, statistics, float(rule[TIME_STEP])
        sparse, connected = system.unknowns.pattern is not None, bool(system.called.items)
        bordered = system.unknowns.border_size > 0
        self._limits = SPARSE if sparse else BORDERED if connected or bordered else BAND
        h, alpha_m, alpha_f, gamma, beta = rule
        space.arrays[record.RULE][: len(rule)], space.arrays[record.LIMITS][:] = rule, self._limits
        space.arrays[record.DIFFERENCES][:] = 0.0
        space.assembler.weigh((1.0, gamma / (h * beta), (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))), self._step)
        space.assembler.require("tangent", "prediction")
        space.solver[record.STATISTICS] = address_of(statistics)
        self._coupled = CoupledStages(system, space) if sparse or connected else None
        self._untried = bordered and self._coupled is None
        self._deferred: Deferred | None = None
        self._error: BaseException | None = None

    @property
    def why(self) -> str:
        """Why a step has failed."""
        return not_converged(self._statistics, self._limits)

    def advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        prescribed (steps, 3, nh): prescribed coordinates and their rates at the times (steps,) [s].
        """
        history = self._system.history
        if not len(history.numbers):
            return self._advance(state, prescribed, times, saving)
        for number, time in enumerate(times.tolist()):
            step, here = slice(number, number + 1), saving.after(number)
            if not self._advance(state, prescribed[step], times[step], here):
                return number
            state[0] = history.committed((state[0], state[1], state[2]), time, self._system.imposing(time), self._step)
            here.keep_state(0, state)
            if self._deferred is not None and self._deferred.interrupted:
                return number + 1
        return len(times)

    def _advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """Do what `advance` does in one compiled call."""
        space, unknowns = self._space, self._system.unknowns
        if self._untried:
            self._untried = False
            p, v, a, _ = state
            weak = is_weak(self._system, (p, v, a), float(times[0]), space.assembler.weights, self._step)
            self._coupled = CoupledStages(self._system, space) if weak else None
        body, values, imposing = _sample_loads(self._system, times)
        varying = len(body) > 1
        assembler, solver = space.assembler, space.solver
        places = assembler.load(body, values)
        natural = np.array(assembler.impose(imposing), dtype=np.int64)
        load_addresses = np.array(places[1:], dtype=np.int64)
        n, address = state.shape[1], address_of(state)
        states = address, address + 8 * n, address + 16 * n
        assembler.place_at(states, space.residual, space.rows, space.arrays[record.ROWS].size)
        arrays = {
            record.PRESCRIBED_VALUES: prescribed,
            record.SAVED: saving.states,
            record.ROTATION_TABLE: saving.pairs,
            record.ROTATED_BY: saving.rotations,
            record.SAVED_ROTATIONS: saving.saved_rotations,
            record.LOAD_VALUES: load_addresses,
            record.NATURALS: natural,
        }
        if not all(array.flags.c_contiguous for array in arrays.values()):
            raise ValueError("compiled code takes contiguous arrays")
        numbers = {
            record.STATE: address,
            record.BODIES: places[0],
            record.BODY_STRIDE: body[0].size if varying else 0,
            record.LOADS_VARY: int(varying),
            record.NATURALS_VARY: int(varying),
            record.STEPS: len(prescribed),
            record.FIRST_STEP: saving.first,
            record.EVERY: saving.every,
            record.ROTATION_COUNT: len(saving.pairs),
            # stages in Python factorise the border themselves
            record.EDGE: len(unknowns.border) if self._coupled is None else 0,
            record.CONDITIONS: unknowns.border_size - len(unknowns.border) if self._coupled is None else 0,
        }
        for field, value in (numbers | {field: address_of(array) for field, array in arrays.items()}).items():
            solver[field] = value
        calls = self._system.solver_table.routines(moving=True)
        if self._coupled is None and not assembler.calls_python:
            return int(march(assembler.address, solver, calls))
        with Deferred() as self._deferred:
            if self._coupled is None:
                completed = int(march(assembler.address, solver, calls))
            else:
                completed = self._coupled.march(assembler.address, solver, state, times, self._deferred)
        errors = () if self._coupled is None else (self._coupled.take_error(),)
        self._error = next((error for error in (*errors, assembler.take_error()) if error is not None), None)
        return completed if self._deferred.lost is None else 0

    def raise_error(self) -> None:
        """Raise what has ended the last call early, if it was an error or a Ctrl-C."""
        if self._deferred is not None:
            self._deferred.deliver()
        if self._error is not None:
            raise self._error


def _sample_loads(system: System, times: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...], np.ndarray]:
    """Return body forces (steps, beams, 4), point values of each block (steps, nl, 3), factors (steps, k) of strains.

    The last are those of imposed strains. There is one row only if nothing varies.
    """
    if not system.varying:
        times = times[:1]
    loads = [system.loads_at(time) for time in times]
    points = tuple(np.array([sample.points[i] for sample in loads]) for i in range(len(system.blocks)))
    return np.array([sample.body for sample in loads]), points, np.array([sample.imposing for sample in loads])
