"""Steps of a motion that fail, or that energy refuses, are redone with shorter ones."""

import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple, cast

import numpy as np

from beamfem.equations.motion_workspace import motion_workspace
from beamfem.equations.system import System
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.results.energy_balance import unseen
from beamfem.results.solution_checks import advice
from beamfem.solve.motion.compiled_steps import CompiledSteps, StepsInCalls
from beamfem.solve.motion.constraints import stopped_by_conditions
from beamfem.solve.motion.energy_judgement import CHUNK, MOST_CUTS, EnergyJudge, motion_of
from beamfem.solve.motion.energy_momentum import ConservingSteps, EnergyMomentum
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.generalized_alpha import Scheme, is_scheme
from beamfem.solve.motion.marching_by_step import Memory, OwnSteps
from beamfem.solve.motion.marching_stages import StageSteps
from beamfem.solve.motion.prescribed_motion import prescribed_motion
from beamfem.solve.motion.stage_coefficients import coefficients, has_stages
from beamfem.solve.motion.start_acceleration import initial_acceleration, mean_acceleration
from beamfem.solve.motion.stored_states import Saving
from beamfem.solve.motion.time_steps import PARTS, Stretch

_CHUNK_SECONDS = 0.25  # of a call of compiled code, which the next call is made to last at least
_REFUSED = "changes the energy by more than work and damping explain"


class Rows(NamedTuple):
    """States (m + 1, 3, n) at the ends of m steps, and rotations (m + 1, pairs) [rad] that are counted.

    exchanged (m + 1, 2): see `Solution`.
    """

    states: np.ndarray
    rotations: np.ndarray
    exchanged: np.ndarray

    @classmethod
    def empty(cls, steps: int, state: np.ndarray, rotations: np.ndarray) -> "Rows":
        """Return rows for a number of steps, of which the first one is a state (4, n)."""
        states, turned = np.empty((steps + 1, 3, state.shape[1])), np.empty((steps + 1, len(rotations)))
        states[0], turned[0] = state[:3], rotations
        return cls(states, turned, np.zeros((steps + 1, 2)))

    def between(self, first: int, last: int) -> "Rows":
        """Return the rows from one to another; they share memory."""
        return Rows(*(values[first : last + 1] for values in self))


@dataclass(frozen=True)
class _Window:
    """Steps `first` to `last` of a stretch that are to be redone.

    begin (4, n): state at their beginning; rows (last - first + 1,): its states; kept: how many of its steps are good
    if redoing them fails too.
    """

    first: int
    last: int
    begin: np.ndarray
    rows: Rows
    kept: int


@dataclass
class StepCutter:
    """Takes steps; those that do not converge, or that energy refuses, are redone with a quarter of their size.

    What is redone begins `CHUNK` steps before a step that fails, as its start is often spoiled already. After it, steps
    have their size again.

    pairs (m, 2): see `full_turns.rotation_pairs`; end [s]: of the motion; size: of a call of compiled code, in steps,
    which grows up to `largest`; judge: of energies, if there is one; relaxed: whether a motion starts with mean
    accelerations, see `initial_acceleration`; cuts: how many times steps were redone; further: how many steps more
    than without cuts there are; exchanged (2,) [J]: see `Solution`; why: the reason of a failure; stopped: whether the
    motion was stopped; memory: of an integrator with steps of its own.
    """

    system: System
    integrator: Scheme | Integrator
    statistics: MotionStatistics
    pairs: np.ndarray
    end: float
    size: int
    largest: int
    judge: EnergyJudge | None
    relaxed: bool
    cuts: int = 0
    further: int = 0
    exchanged: np.ndarray = field(default_factory=lambda: np.zeros(2))
    why: str = ""
    stopped: bool = False
    memory: Memory | None = None

    def take(
        self,
        part: Stretch,
        prescribed: np.ndarray,
        state: np.ndarray,
        rotations: np.ndarray,
        table: Rows | None,
        reached: Callable[[int, Rows], bool] = lambda done, rows: False,
        level: int = 0,
        jumps: bool = True,
        goes_on: bool = False,
    ) -> int:
        """March a state (4, n) and rotations (m,) through a stretch in place; return how many steps were completed.

        prescribed (steps, 3, nh): prescribed coordinates and their rates at the ends of the steps; table: rows for the
        states, None if only `reached` needs them, which takes how many steps are done and the rows of the last ones,
        and returns whether to stop there; level: how many times steps were cut; jumps: whether the acceleration may
        jump at the beginning; goes_on: whether the steps before were equal, so that both accelerations remain.
        """
        done, steps = 0, len(part.times) - 1
        size = self.size if level == 0 else steps
        while done < steps:
            continued = goes_on and done == 0
            own: np.ndarray | None = state[[2, 3 if continued else 2]]
            window: _Window | None = None
            if not continued:
                self._start(part.after(done), state, jumps and done == 0)
            with _steps(self.system, self.integrator, part, self.statistics) as motion:
                motion.recall(self.memory, state)
                while done < steps and window is None:
                    count, begin, started = min(size, steps - done), state.copy(), clock.perf_counter()
                    if own is not None:
                        begin[2:], own = own, None
                    rows = Rows.empty(count, state, rotations) if table is None else table.between(done, done + count)
                    good, window = self._advance(motion, part, prescribed, (begin, state, rotations), rows, done, level)
                    done += good
                    self.stopped = reached(done, rows.between(0, good))
                    motion.raise_error()
                    if self.stopped:
                        return done
                    if good < count and window is None:
                        second, at = self.system.model.unit("s"), float(part.times[done])
                        self.why += f", also with steps of {part.step:.3g} {second} from {at:.6g} {second} on"
                        self.why += advice(self.system.model, rows.states[good, 0])
                        return done
                    if level == 0:
                        size = self._next_size(size, count, clock.perf_counter() - started, window)
                self.memory = motion.memory(state)
            if window is not None:
                good = self._redo(window, part, state, rotations, level, jumps)
                done = window.first + good
                self.stopped = reached(done, window.rows.between(0, good))
                if done < window.last or self.stopped:
                    return done
        if level == 0:
            self.size = max(size, self.size)
        return done

    def judged(self) -> dict[str, np.ndarray]:
        """Return what the judge of energies keeps."""
        return {} if self.judge is None else self.judge.memory()

    def _start(self, part: Stretch, state: np.ndarray, jumps: bool) -> None:
        """Set the accelerations p'' and a that steps start with, where p'' satisfies the equations of motion."""
        if jumps and self.relaxed:
            state[2] = state[3] = initial_acceleration(self.system, state, part.loads_from, part.step)
        if is_scheme(self.integrator):
            state[2] = state[3] = mean_acceleration(self.system, state, part.loads_from, part.step)

    def _next_size(self, size: int, count: int, spent: float, window: _Window | None) -> int:
        """Return the size of the next call after one of `count` steps."""
        if window is not None:
            return min(CHUNK, self.largest)
        if size < self.size:
            return min(4 * size, self.size)  # after a cut
        return min(4 * size, self.largest) if spent < _CHUNK_SECONDS and count == size else size

    def _advance(
        self,
        motion: StepsInCalls | OwnSteps,
        part: Stretch,
        prescribed: np.ndarray,
        states: tuple[np.ndarray, np.ndarray, np.ndarray],
        rows: Rows,
        first: int,
        level: int,
    ) -> tuple[int, _Window | None]:
        """Take steps from `first` on into rows; return how many are good, and what is to be redone.

        states: the one (4, n) to begin with if steps are redone, the one to march, and its rotations.
        """
        begin, state, rotations = states
        count, which = len(rows.states) - 1, slice(first, first + len(rows.states) - 1)
        loads_at = np.append(part.times[1:-1], part.loads_to)[which]
        saving = Saving(rows.states, 1, 1, self.pairs, rotations, rows.rotations)
        rows.exchanged[:] = self.exchanged
        done = motion.advance(state, prescribed[which], loads_at, saving)
        if motion.broken:
            return done, None
        final = level == MOST_CUTS
        good = done if done == count or final else max(done - CHUNK, 0)
        last, self.why = min(good + 2 * CHUNK, count), f"did not converge: {motion.why}"
        if self.judge is not None and good > 0:
            times = np.append(part.times[first] if first else part.loads_from, loads_at[:good])
            judged = self.judge.accept(times, rows.states[: good + 1], level > 0, good < count, final)
            if judged < good:
                good, last, self.why = judged, min(judged + CHUNK, count), _REFUSED
                done = good if self.judge.refuses_jumps else done
        if good == count or final:
            return good, None
        if good > 0:
            mean = self._mean(part.step, begin[3], rows.states[: good + 1, 2])
            begin = np.concatenate([rows.states[good], mean[None]])
        return good, _Window(first + good, first + last, begin, rows.between(good, last), min(done, last) - good)

    def _mean(self, step: float, mean: np.ndarray, accelerations: np.ndarray) -> np.ndarray:
        """Return the auxiliary acceleration (n,) after steps with accelerations p'' (m + 1, n), from the first one."""
        if not is_scheme(self.integrator):
            return accelerations[-1]
        _, alpha_m, alpha_f, _, _ = self.integrator.rule(step)
        for before, after in pairwise(accelerations):
            mean = ((1.0 - alpha_f) * after + alpha_f * before - alpha_m * mean) / (1.0 - alpha_m)
        return mean

    def _redo(
        self, window: _Window, part: Stretch, state: np.ndarray, rotations: np.ndarray, level: int, jumps: bool
    ) -> int:
        """Take the steps of a window again, with a quarter of their size; return how many are good."""
        self.cuts += 1
        shorter, count, jumps = (
            part.cut(window.first, window.last),
            window.last - window.first,
            jumps and not window.first,
        )
        state[:], rotations[:] = window.begin, window.rows.rotations[0]
        self.change_size(part, state)
        self._put_onto_conditions(shorter, state)
        rows, given = Rows.empty(PARTS * count, state, rotations), self.prescribed(shorter, part.step)
        done = self.take(shorter, given, state, rotations, rows, level=level + 1, jumps=jumps)
        good, complete = done // PARTS, done == PARTS * count
        if complete or good > window.kept:
            taken = rows.between(0, PARTS * good)
            taken.exchanged[::PARTS] += self._unseen(shorter, taken.states)
            for own, values in zip(window.rows, taken, strict=True):
                own[1 : good + 1] = values[PARTS::PARTS]
        good = good if complete else max(good, window.kept)
        self.exchanged = window.rows.exchanged[good].copy()
        if not complete:
            state[:3], rotations[:] = window.rows.states[good], window.rows.rotations[good]
            return good
        self.further += (PARTS - 1) * count
        self.change_size(shorter, state)
        return good

    def _unseen(self, shorter: Stretch, states: np.ndarray) -> np.ndarray:
        """Return what steps of states (m + 1, 3, n) exchange beyond what every fourth row tells (m / 4 + 1, 2) [J]."""
        times = np.concatenate([[shorter.loads_from], shorter.times[1:-1], [shorter.loads_to]])
        return unseen(motion_of(self.system, times[: len(states)], states), PARTS)

    def _put_onto_conditions(self, shorter: Stretch, state: np.ndarray) -> None:
        """Put the rates of a state (4, n) onto the conditions of joints, before shorter steps.

        Steps satisfy conditions of positions. Errors in those of rates, and multipliers, alternate from step to step
        without numerical damping, and the shorter the steps are, the larger are the forces that stop them.
        """
        if is_scheme(self.integrator) and len(self.system.connectors.multipliers):
            time, step = shorter.loads_from, shorter.step if self.relaxed else 0.0
            state[1] += stopped_by_conditions(self.system, state[0], state[1], time)
            state[2] = state[3] = initial_acceleration(self.system, state, time, step)

    def change_size(self, part: Stretch, state: np.ndarray) -> None:
        """Prepare a state (4, n) after steps of a stretch for steps of another size."""
        if is_scheme(self.integrator):
            keep_momentum(self.integrator.rule(part.step), state)
        state[3] = state[2]
        self.statistics.begin_anew()

    def prescribed(self, part: Stretch, before: float) -> np.ndarray:
        """Return prescribed coordinates (steps, 3, nh) at the ends of the steps between longer ones of a size [s]."""
        beside = before * np.arange(1.0, 3.0)
        earlier, later = part.times[0] - beside[::-1], part.times[-1] + beside
        earlier = earlier[earlier > -1e-9 * before]
        later = later[later < self.end + 1e-9 * before]
        ends = np.concatenate([earlier, part.times, later])
        return prescribed_motion(self.system, ends)[len(earlier) + 1 : len(earlier) + len(part.times)]


def keep_momentum(rule: np.ndarray, state: np.ndarray) -> None:
    """Add to p' the remaining contribution of the auxiliary acceleration a at the end of a stretch; rule: of its steps.

    Over equal steps p' + h (1 - alpha_m - gamma) (a - p'') changes by h times a mean of p'' at both ends, the
    arithmetic one in methods of second order. With this correction the same holds across stretches, and momentum is
    conserved.
    """
    step, alpha_m, _, gamma, _ = rule
    state[1] += step * (1.0 - alpha_m - gamma) * (state[3] - state[2])


@contextmanager
def _steps(
    system: System, integrator: Scheme | Integrator, part: Stretch, statistics: MotionStatistics
) -> Iterator[StepsInCalls | OwnSteps]:
    """Provide the object that takes the steps of a stretch."""
    if has_stages(integrator):
        with motion_workspace(system) as space:
            begin, step = part.loads_from, part.step
            yield StageSteps(system, space, coefficients(integrator), begin, step, statistics)
        return
    if isinstance(integrator, EnergyMomentum):
        with motion_workspace(system) as space:
            yield ConservingSteps(system, space, part.loads_from, part.step, statistics)
        return
    if not is_scheme(integrator):
        solved = np.zeros(1, dtype=np.int64)
        try:
            yield OwnSteps(system, cast("Integrator", integrator), part.loads_from, solved)
        finally:
            statistics.iterations += int(solved[0])
        return
    with motion_workspace(system) as space:
        yield CompiledSteps(system, space, integrator.rule(part.step), statistics)
