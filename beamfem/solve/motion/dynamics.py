"""Motion in time."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from beamfem.assembly.compilation_notice import announce_compilation
from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.assembly.system import System, system_of
from beamfem.errors import ConvergenceError, EnergyWarning, InputError, warn
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.model.model import Model
from beamfem.results.energy_balance import energy_warnings
from beamfem.results.full_turns import first_turns
from beamfem.results.solution import Solution, State
from beamfem.results.solution_checks import warned
from beamfem.results.status import Statistics, Status
from beamfem.solve.motion.constraints import impact, require_met, stopped_by_conditions
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.initial_velocity import put_onto_supports, require_on_supports, start_velocity
from beamfem.solve.motion.integrators import GeneralizedAlpha, Scheme, is_scheme, require_rule
from beamfem.solve.motion.period_error import detuned
from beamfem.solve.motion.prescribed_motion import prescribed_motion
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.motion.time_marching import Last, Record, march
from beamfem.solve.motion.time_steps import SIDE, stretches
from beamfem.solve.start.functions_of_time import functions_of_time, name_unresolved
from beamfem.solve.start.partial_results import kept
from beamfem.solve.start.start_checks import refuse_frame, require_memory
from beamfem.solve.start.start_state import last_state, start_state, transferred_turns
from beamfem.validation import count, positive, shown


def simulate(
    model: Model,
    duration: float,
    step: float,
    integrator: Scheme | Integrator | None = None,
    start: State | Solution | None = None,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None = None,
    save_every: int = 1,
) -> Solution:
    """Integrate the equations of motion over time with a fixed step, which is cut where it has to be.

    Steps that do not converge, or that change the energy by more than work explains, are redone with a quarter of their
    size, from up to 8 steps before; afterwards they have their size again. `statistics.rejected` counts how often.

    Parameters
    ----------
    model : Model
        Beams, supports and loads.
    duration : float, [s]
        Time to simulate; the last step ends at or just after it.
    step : float, [s]
        Time step.
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
    duration, step, save_every = positive("duration", duration), positive("step", step), count("save_every", save_every)
    if step > duration:
        raise InputError(f"step ({step:g}) must not exceed duration ({duration:g})")
    integrator = GeneralizedAlpha() if integrator is None else integrator
    user_defined = not is_scheme(integrator)
    steps = any(callable(getattr(integrator, name, None)) for name in ("step", "run"))
    if isinstance(integrator, type) or (user_defined and not steps):
        raise InputError(
            "integrator must be a GeneralizedAlpha(rho_inf=...), an object with rule(step) as it has, or one with "
            f"step(motion, begin, end) as bf.Integrator describes it, got {shown(integrator)}"
        )
    system = system_of(model, static=False)
    refuse_frame(system, "simulate")
    rule = require_rule(integrator, step) if is_scheme(integrator) else ()
    announce_compilation()
    require_memory(model.size, duration, step, save_every)
    times = step * np.arange(int(np.ceil(duration / step - 1e-9)) + 1)
    acting, second = functions_of_time(system), system.model.unit("s")
    parts = stretches(times, [function for function in acting if function.amplitude])
    ends = np.concatenate([times[:1], *(part.times[1:] for part in parts)])
    prescribed = prescribed_motion(system, ends)
    unresolved = name_unresolved(acting, ends, SIDE * step, second)
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
    rows, pairs = -(-(len(times) - 1) // save_every) + 1, model.numbered.rotation_pairs
    table = np.empty((rows, 3, model.size))
    record = Record(table, save_every, MotionStatistics(), pairs, np.empty((rows, len(pairs))))
    near = transferred_turns(start, model, "start")
    record.states[0], record.rotations[0] = state[:3], first_turns(model, state[0], near)
    further = len(ends) - len(times)
    last = Last((0, state[:3].copy(), record.rotations[0].copy()))
    with kept(lambda: _solution(system, times, record, last, further, unresolved, rule)):
        failed = march(system, integrator, parts, prescribed, state, record, last)
    solution = _solution(system, times, record, last, further, unresolved, rule)
    if failed is not None:
        raise ConvergenceError(
            f"the iteration of the step from {failed.begin:.6g} {second} to {failed.end:.6g} {second} did not "
            f"converge: {failed.why}",
            solution,
        )
    for sentence in solution.computed(energy_warnings):
        warn(sentence, EnergyWarning)
    found = detuned(solution, system, acting)
    if found:
        solution = replace(solution, statistics=replace(solution.statistics, warnings=found))
    return warned(solution)


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
