"""Motion in time."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from os import PathLike
from typing import Any

import numpy as np

from beamfem.equations.rigid_velocity import RigidVelocity
from beamfem.errors import ConvergenceError, EnergyWarning, InputError, warn
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.model.model import Model
from beamfem.progress import ends_as_a_whole, kept, returned_on_interrupt
from beamfem.results.full_turns import first_turns
from beamfem.results.solution import Solution, State
from beamfem.results.solution_checks import warned, warned_motion
from beamfem.results.status import Statistics, Status
from beamfem.solve.accuracy.adapted_mesh import prepared, refined_until
from beamfem.solve.accuracy.carried_start import carried
from beamfem.solve.accuracy.coarse_mesh import warned_of_coarse_motion
from beamfem.solve.accuracy.quantity_change import Quantity
from beamfem.solve.motion.consistent_rows import finished_rows
from beamfem.solve.motion.constraints import change_of_velocity, impact, require_met, stopped_by_conditions
from beamfem.solve.motion.cut_steps import Rows
from beamfem.solve.motion.error_control import march_to_tolerance
from beamfem.solve.motion.events import Event
from beamfem.solve.motion.initial_velocity import (
    put_onto_supports,
    require_joined,
    require_on_supports,
    start_velocity,
)
from beamfem.solve.motion.motion_error import LOOSE, MOST_MESHES, motion_attempt, rows_of, with_estimate_of
from beamfem.solve.motion.motion_plan import AnyIntegrator, MotionPlan, planned, settings_of, usual_integrator
from beamfem.solve.motion.period_error import detuned
from beamfem.solve.motion.prescribed_motion import prescribed_motion
from beamfem.solve.motion.saved_rows import SavedRows
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.motion.time_marching import Last, Record, cutter_of, march
from beamfem.solve.motion.time_steps import SIDE
from beamfem.solve.motion.undamped_rows import undamped_rows
from beamfem.solve.start.functions_of_time import name_unresolved
from beamfem.solve.start.start_state import last_state, start_state, transferred_turns
from beamfem.validation import flag, positive


@returned_on_interrupt
def simulate(
    model: Model,
    duration: float,
    step: float | None = None,
    integrator: AnyIntegrator | None = None,
    start: State | Solution | None = None,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None = None,
    save_every: int = 1,
    *,
    tolerance: float | None = None,
    save_at: Sequence[float] | np.ndarray | None = None,
    events: Sequence[Event] = (),
    file: str | PathLike[str] | None = None,
    accuracy: float | None = None,
    quantity: Quantity = None,
    watch: bool = False,
) -> Solution:
    """Integrate the equations of motion over time, with a fixed step, or with steps that follow a tolerance.

    Steps that do not converge, or that change the energy by more than work explains, are repeated with a quarter of
    their size, from up to 8 steps before; after them the step has its size again. `statistics.rejected` counts them.

    Parameters
    ----------
    model : Model
        Beams, supports and loads.
    duration : float, [s]
        Time to simulate; the last step ends at or just after it.
    step : float, [s], optional
        Time step; with a tolerance, the time between rows, if it is given.
    integrator : GeneralizedAlpha, Gauss, Radau, Scheme or Integrator, optional
        Time integration method, by default `GeneralizedAlpha()`, with a tolerance `Radau()`, from 1e-3 on `Radau(2)`,
        up to 1e-7 `Radau(4)`, unless all history is that of sections, user-defined parts or friction in hinges; a
        user-defined one is a `Scheme` of the same family, such as Newmark's method, or any other `Integrator`.
    start : State or Solution, optional
        State to start from: a state of any solution, static or a motion, or a solution for its last state; by default
        the reference at rest. It may come from a model with other supports or connectors, if the state satisfies those
        of this model; velocities that they prevent are lost at once, as in a plastic impact.
    velocity : RigidVelocity or callable, optional
        Initial velocity: of a rigid motion, or a function of the reference position (2,) [m] of the axis, which returns
        (vx, vy) [m/s]. With a function, sections do not rotate at first, unless their element ties them to the axis.
        What joints and supports prevent is lost at once, too.
    save_every : int, default 1
        Keep every n-th state and the last one.
    tolerance : float, [-], optional
        Largest error of positions relative to the size of the model, as the sum of the estimates of all steps. Steps
        are as long as it allows; each is a row, unless `step` or `save_at` is given. A user-defined `Integrator` must
        have an attribute `order`.
    save_at : array, [s], (rows,), optional
        Ascending times of the rows; they need not be ends of steps.
    events : sequence of Event, optional
        Functions of the state whose crossings of zero are recorded in the `events` of the solution, or end the motion.
    accuracy : float, [-], optional
        Refine the mesh, as `solve_static` does, until positions at all rows are off by at most this number times the
        size of the model, or the quantity by this number times its largest value; this is an estimate of the error of
        the mesh alone, and each mesh costs two motions.
    quantity : callable or Point, optional
        What is to be accurate: a function of the motion that returns a number or numbers, such as a reaction at all
        rows or the time of an event, or a point for its displacements at all rows; by default all positions.
    file : path, optional
        HDF5 file for the rows, which then take no memory while the motion runs; `resume` continues an interrupted
        motion, and `load` reads the file at any time. Tangents are factorised anew every 1000 steps at the latest, so
        the last digits differ from those of a motion without a file.
    watch : bool, default False
        Whether to show the motion while it runs, in a window or below the cell of a notebook, updated as often as 5 %
        of the run time allow. Without a display and a notebook nothing is shown.

    Returns
    -------
    Solution
        One row for each saved time; with `file` as many of its rows as fit into memory.

    Raises
    ------
    InputError
        Before the solve, for invalid arguments, such as a support that would jump from the start, or a file with a
        motion that has not ended, or into which another process writes.
    ConvergenceError
        If a step does not converge, however short; its `solution` has all states so far. So has any other exception
        during the solve.
    KeyboardInterrupt
        On Ctrl-C within the first 5 seconds, in a sweep, and from the command line. Later, Ctrl-C ends the motion only:
        what is done is returned, and a second Ctrl-C ends the program.
    FileError
        If the file cannot be written; it then holds the motion up to where it could.

    Warns
    -----
    LongRunWarning
        If Ctrl-C has ended the motion.
    TimeStepWarning
        If steps detune a resonance, or if rows have forces of vibrations that they do not resolve.
    RoundOffWarning
        If round-off of a very stiff part changes the energy.
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
    last_state(start)
    own = model
    model, accuracy = prepared(model, accuracy, start, quantity)
    if accuracy is not None and file is not None:
        raise InputError(
            "a motion in a file has one mesh; find it first, by motion = simulate(model, ..., accuracy=...)",
            remedy="Then simulate model.meshed(motion)" + (", with start=motion[0]" if start is not None else ""),
        )
    if accuracy is not None or (own.automatic and file is None):
        asked: dict[str, Any] = {"duration": duration, "save_every": save_every, "save_at": save_at, "events": events}
        others: dict[str, Any] = {"step": step, "integrator": integrator, "velocity": velocity, "watch": watch}
        loose = tolerance
        if tolerance is not None and accuracy is not None:
            # errors of steps far below those of the mesh would cost many steps on every mesh
            loose = max(positive("tolerance", tolerance), LOOSE * accuracy)

        def solve(model: Model, like: Solution | None = None) -> Solution:
            rows = asked
            if like is not None and ((step is None and save_at is None) or any(event.stop for event in events)):
                lasts = duration if quantity is not None else max(float(like.time[-1]), step or 0.0)
                rows = rows_of(like, lasts, events)
            return simulate(model, start=carried(start, model), tolerance=loose, **others, **rows)

        if accuracy is None:
            return warned_of_coarse_motion(solve(model), solve)
        with ends_as_a_whole():
            refined = refined_until(model, accuracy, lambda model: motion_attempt(model, solve, quantity), MOST_MESHES)
            if loose == tolerance:
                return warned_motion(refined)
            final = simulate(refined.model, start=carried(start, refined.model), tolerance=tolerance, **others, **asked)
            return with_estimate_of(refined, final)
    integrator = usual_integrator(model, tolerance) if integrator is None else integrator
    settings = settings_of(duration, step, integrator, save_every, tolerance, save_at, events)
    settings = replace(settings, watch=flag("watch", watch))
    plan = planned(model, settings, in_memory=file is None)
    settings, system, times, parts, acting = plan.settings, plan.system, plan.times, plan.parts, plan.acting
    collects = save_at is not None or tolerance is not None or len(settings.events) > 0
    every, second = len(times) if collects else settings.save_every, model.unit("s")
    prescribed = prescribed_motion(system, plan.ends if file is None else plan.ends[:20])
    unresolved = [] if tolerance is not None else name_unresolved(acting, plan.ends, SIDE * plan.rows_at, second)
    state = np.zeros((4, model.size))
    start = last_state(start)
    state[0] = start_state(system, start)
    state[1] = start_velocity(system, state[0], velocity, start)
    if start is not None:
        require_joined(system, start, moving=velocity is None)
    if start is not None or system.moved:
        require_on_supports(system, state[0], prescribed[0, 0], start is not None)
    stopped = put_onto_supports(system, state, prescribed[0])
    if stopped.any():
        state[1] += impact(system, state[0], stopped)
    if len(system.connectors.multipliers):
        require_met(system, state[0], parts[0].loads_from)
        if velocity is not None or start is not None or system.connectors.conditions_follow_time:
            given = state[1].copy()
            state[1] += stopped_by_conditions(system, state[0], given, parts[0].loads_from)
            if velocity is not None and (lost := change_of_velocity(system, state[0], given, state[1])):
                warn(lost, EnergyWarning)
    state[2] = initial_acceleration(system, state, parts[0].loads_from)
    state[3] = state[2]
    turned = first_turns(model, state[0], transferred_turns(start, model, "start"))
    if file is not None:
        from beamfem.solve.motion.long_runs import into_file  # needs h5py, and takes a while to import

        return into_file(plan, state, turned, file)
    rows, pairs = -(-(len(times) - 1) // every) + 1, model.numbered.rotation_pairs
    record = Record(Rows.empty(rows - 1, state, turned), every, MotionStatistics(), pairs, plan.live_view())
    record.show(0.0, state[:3])
    last = Last((0, state[:3].copy(), turned.copy(), np.zeros(2)))
    saved = plan.saved_rows() if collects else None
    if saved is not None:
        saved.begin(state[:3], turned)

    def found(complete: bool = False) -> Solution | None:
        if saved is not None:
            return _collected(plan, saved, record, last.step[0], unresolved, complete)
        return _solution(plan, record, last, unresolved)

    with kept(found):
        if settings.tolerance is not None and saved is not None:
            cutter = cutter_of(system, settings.integrator, parts, state, record)
            failed = march_to_tolerance(cutter, parts, state, turned, settings.tolerance, saved, record)
        else:
            failed = march(system, settings.integrator, parts, prescribed, state, record, last, saved)
    solution = found(failed is None)
    if failed is not None:
        raise ConvergenceError(failed.sentence(second), solution)
    if solution is None:
        raise InputError("the motion has ended before the first time of save_at")
    if tolerance is not None:
        return warned(solution)
    doubts = (*detuned(solution, system, acting), *undamped_rows(solution, system))
    return warned_motion(solution.with_statistics(warnings=doubts))


def _collected(
    plan: MotionPlan, saved: SavedRows, record: Record, done: int, unresolved: list[str], complete: bool
) -> Solution | None:
    """Return the rows that were saved, if there are any; done: whole steps of a fixed size; complete: whether all."""
    if not saved.times:
        return None
    times, (states, turned, exchanged), events = saved.take_out(0)
    events = tuple(replace(event, row=min(event.row, len(times) - 1)) for event in events)
    if saved.stopped:  # steps are taken some at a time
        done = min(done, int(np.ceil(times[-1] / plan.rows_at - 1e-9)))
    steps, fixed = record.further + done, plan.settings.tolerance is None
    status = Status.COMPLETED if complete else Status.STOPPED
    ended, rule = (_ended(plan, done, unresolved), plan.rule) if fixed else (f"{steps} steps", ())
    summary = Statistics(record.statistics.iterations, steps, record.cuts, ended, status, rule=rule)
    p, v, a = states.swapaxes(0, 1)
    others: dict[str, Any] = {"turned": turned, "exchanged": exchanged, "events": events}
    return Solution(saved.system.model, False, times, p, v, a, summary, **others)


def _solution(plan: MotionPlan, record: Record, last: Last, unresolved: list[str]) -> Solution:
    system, times, (done, *of_last) = plan.system, plan.times, last.step
    stored_steps = np.append(np.arange(0, done, record.every), done)
    rows = record.rows.between(0, len(stored_steps) - 1)
    if done % record.every:
        for own, values in zip(rows, of_last, strict=True):
            own[-1] = values
    status = Status.COMPLETED if done == len(times) - 1 else Status.STOPPED
    taken, ended = done + record.further, _ended(plan, done, unresolved)
    summary = Statistics(record.statistics.iterations, taken, record.cuts, ended, status, rule=plan.rule)
    p, v, a = finished_rows(system, times[stored_steps].tolist(), rows.states, plan.jumps).swapaxes(0, 1)
    others: dict[str, Any] = {"turned": rows.rotations, "exchanged": rows.exchanged}
    return Solution(system.model, False, times[stored_steps], p, v, a, summary, **others)


def _ended(plan: MotionPlan, done: int, unresolved: list[str]) -> str:
    """Return how many steps were completed; unresolved: names of functions that vary within them."""
    second, further = plan.system.model.unit("s"), len(plan.ends) - len(plan.times)
    ended = f"{done} step{'' if done == 1 else 's'} of {plan.times[1]:g} {second}"
    if further:
        ended += f", divided {further} times at kinks of loads"
    for name in unresolved:
        ended += f"; the {name} varies within steps, which do not resolve it"
    return ended
