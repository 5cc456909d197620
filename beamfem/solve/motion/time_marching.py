"""Marching through the time steps of a motion: stretches of equal steps, stored states, and failures."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.equations.system import System
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.progress import progress
from beamfem.solve.motion.cut_steps import Rows, StepCutter, keep_momentum
from beamfem.solve.motion.energy_judgement import BROKEN, CHUNK, EnergyJudge
from beamfem.solve.motion.energy_momentum import EnergyMomentum
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.generalized_alpha import GeneralizedAlpha, Scheme, is_scheme
from beamfem.solve.motion.saved_rows import SavedRows
from beamfem.solve.motion.stage_coefficients import has_stages, is_explicit
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.motion.time_steps import Stretch

_FIRST_CHUNK = 200_000  # coordinates times steps
_LARGEST_CHUNK = 3_200_000
_AFTER_JUMP = 4 * CHUNK  # steps of the first call if loads act at points: energy often refuses their sudden start


@dataclass
class Record:
    """Stored states (rows, 3, n) of every n-th whole step, and of the last one in the row after them.

    pairs (m, 2): see `full_turns.rotation_pairs`; show: shows states (3, n) at times [s]; cuts, further: see
    `StepCutter`.
    """

    rows: Rows
    every: int
    statistics: MotionStatistics
    pairs: np.ndarray
    show: Callable[[float, np.ndarray], None] = lambda time, state: None
    cuts: int = 0
    further: int = 0


@dataclass
class Last:
    """The last whole step that was completed: its number, state (3, n), rotations (m,) [rad] and exchanged (2,) [J]."""

    step: tuple[int, np.ndarray, np.ndarray, np.ndarray]
    _spare: np.ndarray | None = None

    def reach(self, done: int, state: np.ndarray, rotations: np.ndarray, exchanged: np.ndarray) -> None:
        """Record another step by a single assignment, so that the record is complete even after an interruption."""
        before, buffer = self.step[1], np.empty_like(state) if self._spare is None else self._spare
        buffer[:] = state
        self.step = done, buffer, rotations.copy(), exchanged.copy()
        self._spare = before


@dataclass(frozen=True)
class Failure:
    """The step that could not be completed: its beginning and end [s], and what happened to it."""

    begin: float
    end: float
    why: str

    def sentence(self, second: str) -> str:
        """Return a sentence that says so; second: name of the unit of time."""
        return f"the step from {self.begin:.6g} {second} to {self.end:.6g} {second} {self.why}"


def march(
    system: System,
    integrator: Scheme | Integrator,
    parts: tuple[Stretch, ...],
    prescribed: np.ndarray,
    state: np.ndarray,
    record: Record,
    last: Last,
    saved: SavedRows | None = None,
) -> Failure | None:
    """March from p, p', p'' and the auxiliary acceleration (4, n), in place, through stretches of steps.

    prescribed (m + 1, 3, nh): see `prescribed_motion`, at the ends of all steps; last: updated after each step; saved:
    takes all steps. Return where and why it failed, or None.
    """
    row, rotations = 0, record.rows.rotations[0].copy()
    cutter = cutter_of(system, integrator, parts, state, record)
    with progress("time [s]", float(parts[-1].times[-1])) as report:
        for number, part in enumerate(parts):
            steps, first = len(part.times) - 1, last.step[0]
            if number > 0:
                if is_scheme(integrator):
                    keep_momentum(integrator.rule(parts[number - 1].step), state)
                state[2] = state[3] = initial_acceleration(system, state, part.loads_from)
                record.statistics.begin_anew()
            direct = part.whole and record.every == 1

            def reached(done: int, rows: Rows, part: Stretch = part, first: int = first) -> bool:
                record.cuts, record.further = cutter.cuts, cutter.further
                if saved is not None:
                    saved.keep(part.times[done - len(rows.states) + 1 : done + 1], rows)
                stop = saved is not None and saved.stopped
                if not part.whole or len(rows.states) == 1:
                    return stop
                _store(record, rows, first + done - len(rows.states) + 1)
                last.reach(first + done, *(values[-1] for values in rows))
                report(float(part.times[done]))
                record.show(float(part.times[done]), rows.states[-1])
                return stop

            table = record.rows.between(first, first + steps) if direct else None
            if not part.whole:
                table = Rows.empty(steps, state, rotations)
            done = cutter.take(part, prescribed[row + 1 : row + steps + 1], state, rotations, table, reached)
            row += done
            if cutter.stopped:
                return None
            if done < steps:
                return Failure(float(part.times[done]), float(part.times[done + 1]), cutter.why)
            if part.ends_whole and not part.whole:
                last.reach(first + 1, state[:3], rotations, cutter.exchanged)
                if (first + 1) % record.every == 0:
                    for own, values in zip(record.rows, last.step[1:], strict=True):
                        own[(first + 1) // record.every] = values
    return None


def _store(record: Record, rows: Rows, first: int) -> None:
    """Store every n-th state of the rows of whole steps from step `first` on, unless they are the record's own."""
    if record.every > 1:
        inside = np.arange(-first % record.every, len(rows.states), record.every)
        inside = inside[inside > 0]
        stored = (first + inside) // record.every
        for own, values in zip(record.rows, rows, strict=True):
            own[stored] = values[inside]


def cutter_of(
    system: System, integrator: Scheme | Integrator, parts: tuple[Stretch, ...], state: np.ndarray, record: Record
) -> StepCutter:
    """Return what takes the steps of a motion from a state (4, n)."""
    damped = system.damped or bool(system.connectors.items)
    # see initial_acceleration; laws with history know rates by differences only
    relaxed = is_scheme(integrator) and (bool(system.history.laws) or (damped and not _keeps_rates(integrator)))
    # a user-defined integrator may raise any exception; the states reached before are kept
    calls_python = bool(system.called) or any(block.law is not None for block in system.blocks)
    first_chunk = _FIRST_CHUNK // 50 if calls_python else _FIRST_CHUNK
    size, end = 1, float(parts[-1].times[-1])
    judge, largest = None, 1
    if is_scheme(integrator) or has_stages(integrator) or isinstance(integrator, EnergyMomentum):
        size, largest = max(first_chunk // system.model.size, 1), max(_LARGEST_CHUNK // system.model.size, 1)
        if any(actions.unit.any() for actions in system.loads.actions):
            size = min(size, _AFTER_JUMP)
    judged: Scheme | None = integrator if is_scheme(integrator) else None
    if is_explicit(integrator):  # by its damping alone
        judged = GeneralizedAlpha(0.0 if integrator.order > 2 else 1.0)
    elif has_stages(integrator) and system.kinked:
        judged = GeneralizedAlpha(0.0 if integrator.removed else 1.0)
    if judged is not None:
        judge = EnergyJudge(system, judged.rule(parts[0].step), end, state[:3], implicit=judged is integrator)
    elif has_stages(integrator) and not integrator.removed:  # Gauss; Radau damps what steps do not resolve
        judge = EnergyJudge(system, GeneralizedAlpha(1.0).rule(parts[0].step), end, state[:3], BROKEN)
        judge = judge if judge.conservative else None
    return StepCutter(system, integrator, record.statistics, record.pairs, end, size, largest, judge, relaxed)


def _keeps_rates(scheme: Scheme) -> bool:
    """Return whether 1 / 2 = beta / gamma, as of the trapezoidal rule."""
    *_, gamma, beta = scheme.rule(1.0)
    return bool(2.0 * beta == gamma)
