"""Steps whose size follows an estimate of their error."""

from dataclasses import dataclass, replace

import numpy as np

from beamfem.equations.motion_workspace import motion_workspace
from beamfem.progress import progress
from beamfem.results.solution_checks import advice
from beamfem.solve.motion.cut_steps import Rows, StepCutter
from beamfem.solve.motion.energy_judgement import CHUNK
from beamfem.solve.motion.generalized_alpha import is_scheme
from beamfem.solve.motion.kinks import first_kink
from beamfem.solve.motion.marching_doubled import DoubledSteps
from beamfem.solve.motion.saved_rows import SavedRows
from beamfem.solve.motion.stable_step import stable_step
from beamfem.solve.motion.stage_coefficients import Implicit, coefficients, is_explicit, is_implicit
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.motion.time_marching import Failure, Record
from beamfem.solve.motion.time_steps import Stretch

_SAFETY = 0.8  # of the step that would have the error allowed
_SAME = 1.25  # times the step, up to which it is kept, with its tangent
_LARGEST, _SMALLEST = 4.0, 0.2  # changes of the step at once
_ROUND_OFF = 2e-14  # of the model: error of a step that may be round-off
_MEAN = 16  # steps whose errors are added
_CANCELLED = 4.0  # times the tolerance that the estimates add up to: errors turn with the motion, and partly cancel
_SUM = 2.0  # times the tolerance that the same of methods of stages add up to
_SAVED = 1.0  # times the tolerance: error that one step may make of what earlier ones have not
_TO_KINK = 8  # steps of the first call, and of that after a kink: what follows one is lost
_REDONE = 8  # times at most that steps up to a kink end at an earlier one, where these show that it is
_LONGEST = 64  # steps of equal size, at the end of which the error is judged
_SHORTEST = 1e-12  # of the motion: a step that fails however short it is


@dataclass
class Reached:
    """Where a motion is: its time [s], the size [s] of the next steps and how many of them to judge together.

    saved: error that earlier steps were allowed and have not made, as far as it counts.
    """

    time: float = 0.0
    step: float = 0.0
    count: int = CHUNK
    saved: float = np.inf


def march_to_tolerance(
    cutter: StepCutter,
    parts: tuple[Stretch, ...],
    state: np.ndarray,
    rotations: np.ndarray,
    tolerance: float,
    saved: SavedRows,
    record: Record,
    reached: Reached | None = None,
    most: float = np.inf,
) -> Failure | None:
    """March a state (4, n) and rotations (m,) through stretches of time, in place; return where it failed, or None.

    reached: where to go on from, updated; most: number of steps after which to pause.

    The error of a step h is estimated by p - p0 - h p0' - h^2 (p0'' / 3 + p'' / 6), as accelerations that are linear in
    it would have none (Zienkiewicz and Xie 1991). It may be the share of the tolerance that the step is of the motion,
    so that errors add up to the tolerance at most. That of an integrator with steps of its own is the difference of two
    steps and one of double size, over 2^k - 1 with its order k.
    """
    history = cutter.system.history
    if is_implicit(cutter.integrator) and (history.compiled or not len(history.numbers)):
        return _march_pairs(
            cutter, cutter.integrator, parts, state, rotations, tolerance, saved, record, reached or Reached(), most
        )
    reached, duration, order = reached or Reached(), cutter.end, getattr(cutter.integrator, "order", 2)
    time, step, count, taken = reached.time, reached.step, reached.count, 0
    rule, longest = is_scheme(cutter.integrator), np.inf
    if is_explicit(cutter.integrator):  # the step of double size tells the error, and has to be stable, too
        longest = 0.5 * stable_step(cutter.system, cutter.integrator)
    with progress("time [s]", duration) as report:
        for number, part in enumerate(parts):
            end, jumps = float(part.times[-1]), time == part.times[0]
            if jumps and number > 0:
                state[2] = state[3] = initial_acceleration(cutter.system, state, part.loads_from)
                step *= _SMALLEST
            if jumps:
                count = CHUNK if rule else 2
            while time < end:
                if taken >= most:
                    return None
                step = min(step or _first_step(cutter, state, tolerance), 0.25 * (end - part.times[0]), longest)
                target = part.end_of_steps(time)
                steps = min(count, int(np.ceil((target - time) / step * (1.0 - 1e-9)))) if rule else 2
                last = time + 1.001 * steps * step >= target
                size = (target - time) / steps if last else step
                times = time + size * np.arange(steps + 1.0)
                times[-1] = target if last else times[-1]
                stretch = Stretch(
                    times, size, False, False,
                    part.loads_from if jumps else time, part.loads_to if times[-1] == end else float(times[-1]),
                )  # fmt: skip
                before, turned, rows = state.copy(), rotations.copy(), Rows.empty(steps, state, rotations)
                counted = cutter.cuts, cutter.further, cutter.exchanged
                done = cutter.take(stretch, cutter.prescribed(stretch, size), state, rotations, rows, jumps=jumps)
                if done < steps:
                    saved.keep(times[: done + 1], rows.between(0, done))
                    return Failure(float(times[done]), float(times[done + 1]), cutter.why)
                allowed = max(_CANCELLED * tolerance * size / duration, _ROUND_OFF)
                if rule:
                    ratio = _error(cutter, rows.states, size) / allowed
                else:
                    ratio = _difference(cutter, stretch, before, turned, rows) / (2.0**order - 1.0) / allowed
                best = _SAFETY * size / max(ratio, 1e-4) ** (1.0 / order)
                if ratio > 1.0 and size > _SHORTEST * duration:
                    state[:], rotations[:] = before, turned
                    cutter.cuts, cutter.further, cutter.exchanged = counted[0] + 1, *counted[1:]
                    record.cuts, step = cutter.cuts, max(best, _SMALLEST * size)
                    count = CHUNK if rule else 2
                    continue
                cutter.further += steps
                cutter.change_size(stretch, state)
                record.cuts, record.further = cutter.cuts, cutter.further
                time, jumps = float(times[-1]), False
                saved.keep(times, rows)
                report(time)
                record.show(time, state[:3])
                if saved.stopped:
                    return None
                if rule:
                    count = min(2 * count, _LONGEST) if best < _SAME * step else CHUNK
                if best > _SAME * step or best < step:
                    step = min(best, _LARGEST * size)
                reached.time, reached.step, reached.count, taken = time, step, count, taken + steps
    return None


def _march_pairs(
    cutter: StepCutter,
    method: Implicit,
    parts: tuple[Stretch, ...],
    state: np.ndarray,
    rotations: np.ndarray,
    tolerance: float,
    saved: SavedRows,
    record: Record,
    reached: Reached,
    most: float,
) -> Failure | None:
    """Do what `march_to_tolerance` does with a method of stages, in compiled pairs of steps."""
    system, taken = cutter.system, 0
    largest = 2 if saved.watch.events else max(cutter.size, 2)  # what follows an error in an event is lost
    kinks, kink, size, redone = bool(system.kinked), 0.0, 0.0, 0
    room = min(_TO_KINK, largest) if kinks else largest
    with progress("time [s]", cutter.end) as report, motion_workspace(system) as space:
        motion = DoubledSteps(system, space, coefficients(method), method.order, cutter.statistics)
        own = motion.record
        own.fill(time=reached.time, step=reached.step, duration=cutter.end, rate=_SUM * tolerance / cutter.end)
        own.shortest, own.most_saved = _SHORTEST * cutter.end, _SAVED * tolerance
        own.saved = min(reached.saved, own.most_saved)
        for number, part in enumerate(parts):
            end = float(part.times[-1])
            if own.time == part.times[0]:
                own.fine.known, own.before = 0, 0.0
                if number > 0:
                    state[2] = state[3] = initial_acceleration(system, state, part.loads_from)
                    own.step *= _SMALLEST
            own.step, own.longest = own.step or _first_step(cutter, state, tolerance), 0.125 * (end - part.times[0])
            while own.time < end:
                if taken >= most:
                    return None
                target = part.end_of_steps(own.time)
                refused, ahead = own.refused, own.time < kink < target
                until = replace(part, times=np.array([own.time, kink if ahead else target]))
                times, rows = motion.follow(until, state, rotations, max(int(min(room, most - taken)), 2))
                room = min(2 * room, largest)
                found = first_kink(system, times, rows.states) if kinks and redone < _REDONE else None
                if found is not None:
                    first, kink = found[0] // 2 * 2, found[1]  # the pair of steps is redone up to the kink
                    room, own.time, own.step = min(_TO_KINK, largest), float(times[first]), float(np.diff(times)[first])
                    redone, size = (redone + 1, size) if ahead else (0, own.step)
                    times, rows = times[: first + 1], rows.between(0, first)
                    state[:3], state[3], rotations[:] = rows.states[-1], rows.states[-1, 2], rows.rotations[-1]
                    own.failed, own.fine.known, own.before = 0, 0, 0.0
                elif ahead and own.time == kink:
                    redone, own.step, own.fine.known, own.before = 0, max(own.step, size), 0, 0.0
                taken += len(times) - 1
                record.cuts = cutter.cuts = cutter.cuts + own.refused - refused
                record.further = cutter.further = cutter.further + len(times) - 1
                saved.keep(times, rows)
                motion.raise_error()
                if own.failed:
                    why = f"does not converge, however short it is{advice(system.model, state[0])}"
                    return Failure(own.time, own.time + own.step, why)
                report(own.time)
                record.show(own.time, state[:3])
                reached.time, reached.step, reached.saved = own.time, own.step, own.saved
                if saved.stopped:
                    return None
    return None


def _first_step(cutter: StepCutter, state: np.ndarray, tolerance: float) -> float:
    """Return a step [s] in which accelerations, and velocities, move the model by little."""
    scale, unknown = cutter.system.scale, cutter.system.free_dofs
    moved, pushed = (float(np.max(np.abs(row / scale)[unknown], initial=0.0)) for row in state[1:3])
    bounds = [0.01 * cutter.end]
    bounds += [np.sqrt(np.sqrt(tolerance) / pushed)] if pushed > 0.0 else []
    bounds += [np.sqrt(tolerance) / moved] if moved > 0.0 else []
    return float(min(bounds))


def _difference(cutter: StepCutter, part: Stretch, state: np.ndarray, rotations: np.ndarray, rows: Rows) -> float:
    """Return the largest difference between two steps, to the last of rows, and one from a state (4, n), per scale."""
    begin, end = float(part.times[0]), float(part.times[-1])
    whole = replace(part, times=np.array([begin, end]), step=end - begin)
    state, turned = state.copy(), rotations.copy()
    counted = cutter.cuts, cutter.further, cutter.exchanged, cutter.memory
    one, given = Rows.empty(1, state, turned), cutter.prescribed(whole, end - begin)
    done = cutter.take(whole, given, state, turned, one)
    cutter.cuts, cutter.further, cutter.exchanged, cutter.memory = counted
    if done == 0:
        return float(np.inf)
    error = (one.states[1, 0] - rows.states[-1, 0]) / cutter.system.scale
    error[cutter.system.connectors.multipliers] = error[cutter.system.history.numbers] = 0.0
    return float(np.max(np.abs(error[cutter.system.free_dofs]), initial=0.0)) / 2.0


def _error(cutter: StepCutter, states: np.ndarray, size: float) -> float:
    """Return the largest mean of the estimated errors of `_MEAN` steps between states (m + 1, 3, n), per scale.

    Errors of vibrations of a few steps a period cancel in it.
    """
    system = cutter.system
    p, v, a = states.swapaxes(0, 1)
    linear = size * v[:-1] + size**2 * (a[:-1] / 3.0 + a[1:] / 6.0)
    error = (np.diff(p, axis=0) - linear) / system.scale
    error[:, system.connectors.multipliers] = error[:, system.history.numbers] = 0.0
    error, steps = error[:, system.free_dofs], len(error)
    firsts = np.arange(0, max(steps - _MEAN // 2, 1), _MEAN)
    counts = np.diff(np.append(firsts, steps))
    return float(np.max(np.abs(np.add.reduceat(error, firsts, axis=0)) / counts[:, None], initial=0.0))
