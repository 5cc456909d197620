"""Marching through the time steps of a motion: stretches of equal steps, stored states, and failures."""

import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.sparse import csc_array

from beamfem.assembly.connectors import Motion
from beamfem.assembly.equations import INERTIA, linearise, residual
from beamfem.assembly.motion_workspace import motion_workspace
from beamfem.assembly.system import System
from beamfem.assembly.viscosity import viscous_tangent
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.linalg.tangent import UNROTATED, SparseTangent, Tangent
from beamfem.progress import progress
from beamfem.solve.motion.compiled_steps import CompiledSteps
from beamfem.solve.motion.constraints import constrained_acceleration
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.integrators import Scheme, is_scheme
from beamfem.solve.motion.stored_states import Saving
from beamfem.solve.motion.time_steps import Stretch
from beamfem.solve.motion.user_integrators import OwnSteps

_CHUNK_SECONDS = 0.25
_FIRST_CHUNK = 200_000  # coordinates times steps
_NEGLIGIBLE = 0.1  # of the inertia forces at the start: those that depend on the velocity after a step


@dataclass(frozen=True)
class Record:
    """Stored states (rows, 3, n) of every n-th whole step, and of the last one in the row after them.

    pairs (m, 2): see `full_turns.rotation_pairs`; rotations (rows, m) [rad]:
    of the stored states.
    """

    states: np.ndarray
    every: int
    statistics: MotionStatistics
    pairs: np.ndarray
    rotations: np.ndarray


@dataclass
class Last:
    """The last whole step that was completed: its number, state (3, n) and rotations (m,) [rad]."""

    step: tuple[int, np.ndarray, np.ndarray]
    _spare: np.ndarray | None = None

    def reach(self, done: int, state: np.ndarray, rotations: np.ndarray) -> None:
        """Record another step by a single assignment, so that the record is complete even after an interruption."""
        before, buffer = self.step[1], np.empty_like(state) if self._spare is None else self._spare
        buffer[:] = state
        self.step = done, buffer, rotations.copy()
        self._spare = before


@dataclass(frozen=True)
class Failure:
    """The step that could not be completed: its beginning and end [s], and why."""

    begin: float
    end: float
    why: str


def march(
    system: System,
    integrator: Scheme | Integrator,
    parts: tuple[Stretch, ...],
    prescribed: np.ndarray,
    state: np.ndarray,
    record: Record,
    last: Last,
) -> Failure | None:
    """March from p, p', p'' and the auxiliary acceleration (4, n), in place, through stretches of steps.

    prescribed (m + 1, 3, nh): see `prescribed_motion`, at the ends of all steps; last: updated after each step. Return
    where and why it failed, or None.
    """
    statistics, done, row, failed = record.statistics, 0, 0, None
    damped = system.damped or bool(system.connectors.items)
    # see initial_acceleration; laws with history know rates by differences only
    relaxed = is_scheme(integrator) and (bool(system.history.laws) or (damped and not _keeps_rates(integrator)))
    # a user-defined integrator may raise any exception; the states reached before are kept
    calls_python = bool(system.called.items) or any(block.law is not None for block in system.blocks)
    first_chunk = _FIRST_CHUNK // 50 if calls_python else _FIRST_CHUNK
    size = max(first_chunk // system.model.size, 1) if is_scheme(integrator) else 1
    rotations = record.rotations[0].copy()
    counting = record.pairs, rotations, record.rotations
    with progress("time [s]", float(parts[-1].times[-1])) as report:
        for number, part in enumerate(parts):
            if number > 0:
                if is_scheme(integrator):
                    _keep_momentum(integrator.rule(parts[number - 1].step), state)
                _begin_anew(system, part, state, _kept(record, done, part))
                statistics.begin_anew()
            if relaxed:
                state[2] = state[3] = initial_acceleration(system, state, part.loads_from, part.step)
            if is_scheme(integrator):
                state[2] = state[3] = mean_acceleration(system, state, part.loads_from, part.step)
            load_times = np.append(part.times[1:-1], part.loads_to)
            begun, steps = 0, len(load_times)
            with _steps(system, integrator, part, statistics) as motion:
                while begun < steps and failed is None:
                    chunk = min(size, steps - begun) if part.whole else steps
                    rows = slice(begun, begun + chunk)
                    which = (done + 1, record.every) if part.whole else (1, steps + 1)
                    saving = Saving(record.states, *which, *counting)
                    started = clock.perf_counter()
                    completed = motion.advance(state, prescribed[row + 1 : row + chunk + 1], load_times[rows], saving)
                    spent = clock.perf_counter() - started
                    row, begun = row + completed, begun + completed
                    done += completed if part.whole else 0
                    if completed < chunk:
                        failed = Failure(float(part.times[begun]), float(part.times[begun + 1]), motion.why)
                    if part.whole and completed:
                        last.reach(done, state[:3], rotations)
                        report(float(part.times[begun]))
                    motion.raise_error()
                    if part.whole and spent < _CHUNK_SECONDS and is_scheme(integrator):
                        size *= 4
            if failed is not None:
                break
            if part.ends_whole and not part.whole:
                done += 1
                last.reach(done, state[:3], rotations)
                if done % record.every == 0:
                    record.states[done // record.every], record.rotations[done // record.every] = last.step[1:]
    return failed


def _kept(record: Record, done: int, part: Stretch) -> np.ndarray | None:
    """Return the row (3, n) that was stored at the beginning of a stretch, if there is one."""
    return record.states[done // record.every] if part.begins_whole and done % record.every == 0 else None


@contextmanager
def _steps(
    system: System, integrator: Scheme | Integrator, part: Stretch, statistics: MotionStatistics
) -> Iterator[CompiledSteps | OwnSteps]:
    """Provide the object that takes the steps of a stretch."""
    if not is_scheme(integrator):
        solved = np.zeros(1, dtype=np.int64)
        try:
            yield OwnSteps(system, cast("Integrator", integrator), part.loads_from, solved)
        finally:
            statistics.iterations += int(solved[0])
        return
    with motion_workspace(system) as space:
        yield CompiledSteps(system, space, integrator.rule(part.step), statistics)


def _keeps_rates(scheme: Scheme) -> bool:
    """Return whether 1 / 2 = beta / gamma, as of the trapezoidal rule."""
    *_, gamma, beta = scheme.rule(1.0)
    return bool(2.0 * beta == gamma)


def _keep_momentum(rule: np.ndarray, state: np.ndarray) -> None:
    """Add to p' the remaining contribution of the auxiliary acceleration a at the end of a stretch; rule: of its steps.

    Over equal steps p' + h (1 - alpha_m - gamma) (a - p'') changes by h times a mean of p'' at both ends, the
    arithmetic one in methods of second order. With this correction the same holds across stretches, and momentum is
    conserved.
    """
    step, alpha_m, _, gamma, _ = rule
    state[1] += step * (1.0 - alpha_m - gamma) * (state[3] - state[2])


def _begin_anew(system: System, part: Stretch, state: np.ndarray, kept: np.ndarray | None) -> None:
    """Begin a stretch with accelerations that satisfy the equations under the loads there."""
    begin = float(part.times[0])
    if kept is not None and part.loads_from > begin:
        kept[2] = initial_acceleration(system, state, begin)
    state[2] = initial_acceleration(system, state, part.loads_from)
    state[3] = state[2]


def initial_acceleration(system: System, state: np.ndarray, time: float, step: float = 0.0) -> np.ndarray:
    """Return p'' (n,) that satisfies the equations of motion at the start; state: p, p', p'' of prescribed coordinates.

    Multipliers among p are set as well. With a step [s] it solves (M + step D) p'' = unbalanced forces, the mean over
    a step. In a beam with strong damping D, p'' itself decays within an instant, and from it the generalized-alpha
    method would move by step^2 (1 / 2 - beta / gamma) p''. To first order in the step both are the same.
    """
    motion = state[:3].copy()
    p, v, a = motion
    free = system.free_dofs
    multipliers = system.connectors.multipliers
    a[free] = p[multipliers] = v[multipliers] = 0.0
    unbalanced, mass = residual(system, p, v, a, time), _mass(system, (p, v, a), time, step)
    if len(multipliers):
        a[free] = constrained_acceleration(system, (p, v, a), unbalanced, mass, time)
        state[0, multipliers], state[1, multipliers], a[multipliers] = a[multipliers], 0.0, 0.0
        return a
    a[free] = mass.solve(-unbalanced[free], system.rotated)
    return a


def mean_acceleration(system: System, state: np.ndarray, time: float, step: float) -> np.ndarray:
    """Return p'' (n,) at the start, or its mean over the first step [s] where p'' itself is not representative.

    A sudden load accelerates vibrations that the steps do not resolve as if nothing held them back. That does no harm
    in a linear system. But where inertia forces depend on velocities, those of the velocity gained in one step, which
    is step p'', may be as large as M p'' itself (both in the norm of M^-1). Unless they are negligible, the result a
    satisfies (M + step^2 / 4 K) a = M p'', as the mean of the trapezoidal rule does.
    """
    p, v, start = state[:3]
    free, zeros = system.free_dofs, np.zeros(len(start))
    if len(system.connectors.multipliers):
        return start
    slower, resting, faster = (residual(system, p, v + way * step * start, zeros, time) for way in (-1.0, 0.0, 1.0))
    quadratic, inertia = (
        (0.5 * (slower + faster) - resting)[free],
        (residual(system, p, v, start, time) - resting)[free],
    )
    mass = linearise(system, p, v, zeros, time, INERTIA)[1]
    if quadratic @ mass.solve(quadratic, system.rotated) <= _NEGLIGIBLE**2 * (inertia @ start[free]):
        return start
    stiff = linearise(system, p, v, zeros, time, (0.25 * step**2, 0.0, 1.0))[1]
    mean = start.copy()
    mean[free] = stiff.solve(inertia, system.rotated)
    return mean


def _mass(system: System, motion: Motion, time: float, step: float) -> Tangent:
    """Return M + step D in p, p', p'' at a time, with the damping D of materials, connectors and laws with history."""
    if not step > 0.0:
        return linearise(system, *motion, time, INERTIA)[1]
    p, v, zeros = *motion[:2], np.zeros(len(motion[0]))
    mass = linearise(system, p, zeros, zeros, time, (0.0, step, 1.0))[1]
    viscous = viscous_tangent(system, p, v, time, step)
    return mass if viscous is None else SparseTangent(csc_array(mass.sparse(UNROTATED) + viscous))
