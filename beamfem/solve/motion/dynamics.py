"""Motion in time."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from beamfem.assembly.compilation_notice import announce_compilation
from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.assembly.system import System, system_of
from beamfem.errors import ConvergenceError, EnergyWarning, InputError, warn
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.model.model import Model
from beamfem.progress import kept
from beamfem.results.energy_balance import energy_warnings
from beamfem.results.full_turns import first_turns
from beamfem.results.motion_state import Occurrence
from beamfem.results.solution import Solution, State
from beamfem.results.solution_checks import warned
from beamfem.results.status import Statistics, Status
from beamfem.solve.motion.constraints import impact, require_met, stopped_by_conditions
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.error_control import march_to_tolerance
from beamfem.solve.motion.events import Event, Watch
from beamfem.solve.motion.initial_velocity import put_onto_supports, require_on_supports, start_velocity
from beamfem.solve.motion.integrators import GeneralizedAlpha, Scheme, is_scheme, require_rule
from beamfem.solve.motion.period_error import detuned
from beamfem.solve.motion.prescribed_motion import prescribed_motion
from beamfem.solve.motion.saved_rows import SavedRows
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.motion.time_marching import Last, Record, cutter_of, march
from beamfem.solve.motion.time_steps import SIDE, stretches
from beamfem.solve.start.functions_of_time import functions_of_time, name_unresolved
from beamfem.solve.start.start_checks import refuse_frame, require_memory
from beamfem.solve.start.start_state import last_state, start_state, transferred_turns
from beamfem.validation import count, positive, shown

_PARTS = 1000  # of a motion whose steps follow a tolerance, within which kinks of loads are found


def simulate(
    model: Model,
    duration: float,
    step: float | None = None,
    integrator: Scheme | Integrator | None = None,
    start: State | Solution | None = None,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None = None,
    save_every: int = 1,
    *,
    tolerance: float | None = None,
    save_at: Sequence[float] | np.ndarray | None = None,
    events: Sequence[Event] = (),
) -> Solution:
    """Integrate the equations of motion over time, with a fixed step, or with steps that follow a tolerance.

    Steps that do not converge, or that change the energy by more than work explains, are redone with a quarter of their
    size, from up to 8 steps before; afterwards they have their size again. `statistics.rejected` counts how often.

    Parameters
    ----------
    model : Model
        Beams, supports and loads.
    duration : float, [s]
        Time to simulate; the last step ends at or just after it.
    step : float, [s], optional
        Time step; with a tolerance, the time between rows, if it is given.
    integrator : GeneralizedAlpha, Gauss, Radau, Scheme or Integrator, optional
        Time integration method, by default `GeneralizedAlpha()`; a user-defined one is a `Scheme` of the same family,
        such as Newmark's method, or any other `Integrator`.
    start : State or Solution, optional
        State to start from: a state of any solution, static or a motion, or a solution for its last state; by default
        the reference at rest. It may come from a model with other supports or connectors, which have to hold its points
        where they are; velocities that they stop are lost at once, as in a plastic impact.
    velocity : RigidVelocity or callable, optional
        Initial velocity: of a rigid motion, or a function of the reference position (2,) [m] of the axis, which returns
        (vx, vy) [m/s]. With a function, sections do not rotate at first, unless their element ties them to the axis.
    save_every : int, default 1
        Keep every n-th state and the last one.
    tolerance : float, [-], optional
        Error of positions that estimates of all steps add up to at most, relative to the size of the model. The steps
        are as long as it allows; each is a row, unless `step` or `save_at` is given. A user-defined `Integrator` needs
        the attribute `order` for it.
    save_at : array, [s], (rows,), optional
        Times of the rows, ascending, between the ends of steps as well.
    events : sequence of Event, optional
        Functions of the state whose crossings of zero are recorded in the `events` of the solution, or end the motion.

    Returns
    -------
    Solution
        One row for each saved time.

    Raises
    ------
    InputError
        Before the solve, for invalid arguments, such as a support that would jump from the start.
    ConvergenceError
        If a step does not converge, however short; its `solution` has all states so far. Any other exception during the
        solve, such as KeyboardInterrupt, carries the states so far as its `solution` too.

    Warns
    -----
    LockingWarning
        If locking changes displacements by 1 % or more.
    LargeStrainWarning
        If strains of a linear law exceed 0.2, or the utilisation of a strength exceeds 1.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001)
    >>> round(float(motion.displacement(beam.end)[-1, 1]), 4)
    -0.0569
    """
    duration, save_every = positive("duration", duration), count("save_every", save_every)
    if step is None and tolerance is None:
        raise InputError("simulate needs a step [s], or a tolerance that steps follow")
    step, tolerance = (None if x is None else positive(n, x) for n, x in (("step", step), ("tolerance", tolerance)))
    if step is not None and step > duration:
        raise InputError(f"step ({step:g}) must not exceed duration ({duration:g})")
    integrator = GeneralizedAlpha() if integrator is None else integrator
    user_defined = not is_scheme(integrator)
    steps = any(callable(getattr(integrator, name, None)) for name in ("step", "run"))
    if isinstance(integrator, type) or (user_defined and not steps):
        raise InputError(
            "integrator must be a GeneralizedAlpha(rho_inf=...), an object with rule(step) as it has, or one with "
            f"step(motion, begin, end) as bf.Integrator describes it, got {shown(integrator)}"
        )
    events = tuple(events)
    if not all(isinstance(event, Event) for event in events):
        raise InputError(f"events must be Events, got {shown(events)}")
    if user_defined and tolerance is not None and not isinstance(getattr(integrator, "order", None), int):
        raise InputError(
            f"{type(integrator).__name__} needs an attribute order, of its error, to follow a tolerance; give a step"
        )
    system = system_of(model, static=False)
    refuse_frame(system, "simulate")
    rows_at = duration / _PARTS if step is None else step
    rule = require_rule(integrator, rows_at) if is_scheme(integrator) else ()
    require_memory(model.size, duration, rows_at, save_every)
    announce_compilation()
    times = rows_at * np.arange(int(np.ceil(duration / rows_at - 1e-9)) + 1)
    wanted = _wanted(save_at, step, times, save_every, tolerance)
    collects = save_at is not None or tolerance is not None or len(events) > 0
    every = len(times) if collects else save_every
    acting, second = functions_of_time(system), system.model.unit("s")
    parts = stretches(times, [function for function in acting if function.amplitude])
    ends = np.concatenate([times[:1], *(part.times[1:] for part in parts)])
    prescribed = prescribed_motion(system, ends)
    unresolved = [] if tolerance is not None else name_unresolved(acting, ends, SIDE * rows_at, second)
    state = np.zeros((4, model.size))
    start = last_state(start)
    state[0] = start_state(system, start)
    state[1] = start_velocity(system, state[0], velocity, start)
    if start is not None or system.moved:
        require_on_supports(system, state[0], prescribed[0, 0], start is not None)
    stopped = put_onto_supports(system, state, prescribed[0])
    if stopped.any():
        state[1] += impact(system, state[0], stopped)
    if len(system.connectors.multipliers):
        if start is not None and velocity is None:
            state[1] += stopped_by_conditions(system, state[0], state[1])
        require_met(system, state[0], state[1], duration)
    state[2] = initial_acceleration(system, state, parts[0].loads_from)
    state[3] = state[2]
    rows, pairs = -(-(len(times) - 1) // every) + 1, model.numbered.rotation_pairs
    table = np.empty((rows, 3, model.size))
    record = Record(table, every, MotionStatistics(), pairs, np.empty((rows, len(pairs))))
    near = transferred_turns(start, model, "start")
    record.states[0], record.rotations[0] = state[:3], first_turns(model, state[0], near)
    further = len(ends) - len(times)
    last = Last((0, state[:3].copy(), record.rotations[0].copy()))
    saved = SavedRows(system, pairs, wanted, Watch(system, events), user_defined) if collects else None
    if saved is not None:
        saved.begin(state[:3], record.rotations[0])

    def found() -> Solution | None:
        if saved is not None:
            whole = not saved.stopped and tolerance is None
            return _collected(
                saved, record, f"{last.step[0]} steps of {rows_at:g} {second}" if whole else "", times[-1]
            )
        return _solution(system, times, record, last, further, unresolved, rule)

    with kept(found):
        if tolerance is not None and saved is not None:
            cutter = cutter_of(system, integrator, parts, state, record)
            failed = march_to_tolerance(cutter, parts, state, record.rotations[0].copy(), tolerance, saved, record)
        else:
            failed = march(system, integrator, parts, prescribed, state, record, last, saved)
    solution = found()
    if failed is not None:
        raise ConvergenceError(
            f"the iteration of the step from {failed.begin:.6g} {second} to {failed.end:.6g} {second} did not "
            f"converge: {failed.why}",
            solution,
        )
    if solution is None:
        raise InputError("the motion has ended before the first time of save_at")
    if saved is not None:
        return warned(solution)
    for sentence in solution.computed(energy_warnings):
        warn(sentence, EnergyWarning)
    sentences = detuned(solution, system, acting)
    if sentences:
        solution = replace(solution, statistics=replace(solution.statistics, warnings=sentences))
    return warned(solution)


def _wanted(
    save_at: Sequence[float] | np.ndarray | None,
    step: float | None,
    times: np.ndarray,
    save_every: int,
    tolerance: float | None,
) -> np.ndarray | None:
    """Return the times (rows,) [s] at which states are wanted, None for all steps. Raises InputError."""
    if save_at is None:
        if tolerance is not None and step is None:
            if save_every != 1:
                raise InputError("save_every counts fixed steps; give a step or save_at for rows at given times")
            return None
        return np.unique(np.append(times[::save_every], times[-1]))
    at = np.array(save_at, dtype=float)
    if at.ndim != 1 or not len(at) or not np.isfinite(at).all() or np.any(np.diff(at) <= 0.0):
        raise InputError(f"save_at must be times in ascending order, got {shown(save_at)}")
    near = 1e-9 * times[-1]
    if at[0] < -near or at[-1] > times[-1] + near:
        raise InputError(f"save_at must lie within the motion, from 0 to {times[-1]:g}, got {at[0]:g} to {at[-1]:g}")
    if save_every != 1:
        raise InputError("save_every and save_at exclude each other")
    return np.clip(at, 0.0, times[-1])


def _collected(saved: SavedRows, record: Record, ended: str, end: float) -> Solution | None:
    """Return the rows that were saved, if there are any."""
    if not saved.times:
        return None
    times, states = np.array(saved.times), np.array(saved.states)
    steps = record.further + (int(ended.split()[0]) if ended else 0)
    complete = saved.stopped or times[-1] >= end * (1.0 - 1e-9)
    status = Status.COMPLETED if complete else Status.STOPPED
    summary = Statistics(record.statistics.iterations, steps, record.cuts, ended or f"{steps} steps", status)
    p, v, a = states.swapaxes(0, 1)
    turned, rows = np.array(saved.rotations), np.searchsorted(times, [time for _, time in saved.watch.found])
    events = tuple(Occurrence(*each, row) for each, row in zip(saved.watch.found, rows.tolist(), strict=True))
    return Solution(saved.system.model, False, times, p, v, a, summary, turned=turned, events=events)


def _solution(
    system: System,
    times: np.ndarray,
    record: Record,
    last: Last,
    further: int,
    unresolved: list[str],
    rule: tuple[float, ...],
) -> Solution:
    done, state, last_rotations = last.step
    stored_steps = np.append(np.arange(0, done, record.every), done)
    states, rotations = record.states[: len(stored_steps)], record.rotations[: len(stored_steps)]
    if done % record.every:
        states[-1], rotations[-1] = state, last_rotations
    ended = f"{done} step{'' if done == 1 else 's'} of {times[1]:g} {system.model.unit('s')}"
    if further:
        ended += f", divided {further} times at kinks of loads"
    for name in unresolved:
        ended += f"; the {name} varies within steps, which do not resolve it"
    status = Status.COMPLETED if done == len(times) - 1 else Status.STOPPED
    taken = done + record.further
    summary = Statistics(record.statistics.iterations, taken, record.cuts, ended, status, rule=rule)
    p, v, a = states.swapaxes(0, 1)
    return Solution(system.model, False, times[stored_steps], p, v, a, summary, turned=rotations)
