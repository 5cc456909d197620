"""Motions that are written into a file while they run, so that a run that was killed goes on from there.

A run is divided into sections of equal numbers of steps. Each begins with what a checkpoint holds and nothing else, so
that it is the same, bit for bit, in the process that began the motion and in one that resumes it.
"""

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, is_dataclass, replace
from os import PathLike
from typing import Any, cast

import numpy as np

from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, FileError, InputError, LongRunWarning, warn
from beamfem.installed_memory import USABLE_FRACTION, in_gib, installed_memory
from beamfem.io.description import NotImportedError, class_of
from beamfem.io.motion_file import MotionFile, created
from beamfem.io.results_hdf5 import load
from beamfem.kernels.motion_record import MotionStatistics
from beamfem.model.model import Model
from beamfem.progress import kept, progress, returned_on_interrupt
from beamfem.public_names import public
from beamfem.results.solution import Solution
from beamfem.results.solution_checks import warned, warned_motion
from beamfem.results.status import Statistics, Status
from beamfem.solve.motion.cut_steps import Rows, StepCutter, keep_momentum
from beamfem.solve.motion.energy_judgement import CHUNK
from beamfem.solve.motion.error_control import Reached, march_to_tolerance
from beamfem.solve.motion.events import Event
from beamfem.solve.motion.generalized_alpha import Scheme, is_scheme
from beamfem.solve.motion.marching_by_step import Memory
from beamfem.solve.motion.motion_plan import AnyIntegrator, MotionPlan, MotionSettings, planned, settings_of
from beamfem.solve.motion.period_error import detuned
from beamfem.solve.motion.prescribed_motion import prescribed_motion
from beamfem.solve.motion.saved_rows import SavedRows
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.motion.time_marching import Failure, Record, cutter_of
from beamfem.solve.motion.undamped_rows import undamped_rows
from beamfem.validation import flag, positive

_STEPS = 1000  # of a section
_COORDINATES = 500_000  # times steps of a section, at most
_BESIDE = 20  # steps on both sides of a section on which prescribed coordinates in it depend
_SECONDS = 1.0  # between writing
_BYTES = 2**22  # of rows that wait to be written
_OF_STATE = ("state", "rotations", "exchanged", "values", "counts")


@dataclass(frozen=True)
class Checkpoint:
    """What a motion goes on from.

    reached: see `error_control`; state (4, n); rotations (m,) [rad]; exchanged (2,) [J]: see `Solution`; values (k,):
    of the functions of events; counts: iterations, cuts, further steps, rows and events so far; ended: whether an event
    has ended the motion; judge and memory: what the judge of energies and an integrator keep.
    """

    reached: Reached
    state: np.ndarray
    rotations: np.ndarray
    exchanged: np.ndarray
    values: np.ndarray
    counts: np.ndarray
    ended: bool
    judge: Mapping[str, np.ndarray]
    memory: Mapping[str, np.ndarray]

    def arrays(self) -> dict[str, np.ndarray]:
        """Return everything as arrays by name."""
        where = self.reached
        return {
            "reached": np.array([where.time, where.step, where.count, where.saved, self.ended], dtype=float),
            **{name: getattr(self, name) for name in _OF_STATE},
            **{f"judge_{name}": np.asarray(values) for name, values in self.judge.items()},
            **{f"memory_{name}": np.asarray(values) for name, values in self.memory.items()},
        }

    @classmethod
    def of(cls, arrays: Mapping[str, np.ndarray]) -> "Checkpoint":
        """Return the checkpoint of `arrays`."""
        time, step, many, allowed, ended = arrays["reached"].tolist()
        judge, memory = (
            {name.removeprefix(prefix): values for name, values in arrays.items() if name.startswith(prefix)}
            for prefix in ("judge_", "memory_")
        )
        known = {"exchanged": np.zeros(2), **arrays}  # older files do not have it
        of_state: dict[str, Any] = {name: known[name] for name in _OF_STATE}
        reached = Reached(time, step, int(many), allowed)
        return cls(reached, ended=bool(ended), judge=judge, memory=memory, **of_state)


def into_file(plan: MotionPlan, state: np.ndarray, rotations: np.ndarray, file: str | PathLike[str]) -> Solution:
    """Run a motion from a state (4, n) and rotations (m,) [rad] at its start; its rows go into a file."""
    saved, settings = plan.saved_rows(), plan.settings
    saved.begin(state[:3], rotations)
    first = saved.take_out(0)
    counts = np.array([0, 0, 0, len(first[0]), 0])
    values = np.array(saved.watch.values)
    judged = _cutter(plan, state).judged()
    begin = Checkpoint(Reached(), state, rotations, np.zeros(2), values, counts, False, judged, {})
    names = [event.name for event in settings.events]
    statistics = _statistics(plan, begin, False)
    create = created(
        plan.system.model, _sampled(plan), _described(settings, True), begin.arrays(), statistics, names, first
    )
    open_file = MotionFile(file, create)
    try:
        return _run(open_file, plan, begin, saved)
    finally:
        open_file.close()


@returned_on_interrupt
def resume(
    file: str | PathLike[str],
    model: Model | None = None,
    *,
    events: Sequence[Event] = (),
    integrator: AnyIntegrator | None = None,
    duration: float | None = None,
    watch: bool = False,
) -> Solution:
    """Continue a motion that `simulate` wrote into a file, to its end or beyond.

    A run that was interrupted or killed continues from the last checkpoint in its file, written about once a second,
    and ends with the same numbers as an uninterrupted one. Functions of time, user-defined integrators and events are
    not in the file: pass the same ones as to `simulate`.

    Parameters
    ----------
    file : path
        The file.
    model : Model, optional
        The model, by default that of the file if it has no functions of time.
    events : sequence of Event, optional
        The events, by the same names.
    integrator : Scheme or Integrator, optional
        The integrator, by default that of the file. A user-defined one that keeps more than the state from step to step
        needs methods `memory()`, which returns arrays by name, and `recall(memory)`.
    duration : float, [s], optional
        Total time to simulate; a longer one than that of the file extends the motion.
    watch : bool, default False
        Whether to show the motion while it runs, see `simulate`.

    Returns
    -------
    Solution
        As `simulate` returns it.

    Raises
    ------
    InputError
        For a file of another model, other events, or without a motion, and if another process writes it.
    FileError
        If the system refuses to read or write; the file then holds the motion up to the last checkpoint.
    ConvergenceError
        See `simulate`.

    Warns
    -----
    LongRunWarning
        If the motion was already complete (it is returned unchanged), and as in `simulate`.

    Examples
    --------
    >>> begun = bf.simulate(model, duration=0.01, step=0.001, file="long.h5")
    >>> motion = bf.resume("long.h5", model, duration=0.02)
    >>> len(motion)
    21
    """
    if model is not None:
        system_of(model, static=False)
    open_file = MotionFile(file)
    try:
        begun = open_file.settings
        model = open_file.model(model)
        settings = replace(_settings_in(begun, integrator, events), watch=flag("watch", watch))
        further = settings.duration if duration is None else positive("duration", duration)
        name, unfinished = open_file.path, bool(begun["unfinished"])
        if further < settings.duration:
            raise InputError(f"{name} holds a motion of {settings.duration:g} s, which is not made shorter")
        checkpoint = Checkpoint.of(open_file.checkpoint)
        if not unfinished and (further == settings.duration or checkpoint.ended):
            why = "an event has ended it" if checkpoint.ended else f"{further:g} s of {further:g} s"
            warn(f"{name} holds a complete motion: {why}", LongRunWarning)
            return _loaded(open_file)
        if unfinished:
            found = _go_on(open_file, planned(model, settings, in_memory=False), checkpoint)
        if further > settings.duration:
            if settings.save_at is not None:
                raise InputError(f"{name} has rows at given times, save_at; begin another motion from its last state")
            plan, checkpoint = (
                planned(model, replace(settings, duration=further), in_memory=False),
                Checkpoint.of(open_file.checkpoint),
            )
            if not checkpoint.ended:
                open_file.describe(model, _sampled(plan))
                found = _go_on(open_file, plan, checkpoint)
        return found
    finally:
        open_file.close()


def _go_on(file: MotionFile, plan: MotionPlan, checkpoint: Checkpoint) -> Solution:
    """Run a motion from its last checkpoint on."""
    _, _, _, rows, events = checkpoint.counts.tolist()
    file.shorten(rows, events)
    saved = plan.saved_rows()
    saved.watch.values = checkpoint.values.tolist()
    return _run(file, plan, checkpoint, saved)


def _run(file: MotionFile, plan: MotionPlan, checkpoint: Checkpoint, saved: SavedRows) -> Solution:
    """Run a motion from a checkpoint to its end."""
    end, before = float(plan.times[-1]), checkpoint.counts[3:] - saved.waiting
    failed: Failure | None = None
    begun: dict[str, Any] | None = _described(plan.settings, True)
    show = plan.live_view()
    written = clock.monotonic()

    def commit() -> None:
        nonlocal before, begun, written
        added, rows = saved.waiting, saved.take_out(int(before[0]))
        before = before + added
        file.commit(rows, _statistics(plan, checkpoint, False), checkpoint.arrays(), begun)
        begun, written = None, clock.monotonic()

    def found() -> Solution | None:
        try:
            commit()
        except FileError:
            return None
        return _loaded(file) if before[0] else None

    with kept(found), progress("time [s]", end) as report:
        commit()
        while failed is None and checkpoint.reached.time < end and not checkpoint.ended:
            failed, checkpoint = _section(plan, checkpoint, saved, before)
            report(checkpoint.reached.time)
            show(checkpoint.reached.time, checkpoint.state[:3])
            waiting = 24 * plan.system.model.size * len(saved.times)
            if clock.monotonic() - written > _SECONDS or waiting > _BYTES:
                commit()
        commit()
    if failed is not None:
        unit, solution = plan.system.model.unit("s"), _loaded(file)
        raise ConvergenceError(failed.sentence(unit), solution)
    file.describe(plan.system.model)
    no_rows, arrays = saved.take_out(int(before[0])), checkpoint.arrays()
    file.commit(no_rows, _statistics(plan, checkpoint, True), arrays, _described(plan.settings, False))
    solution = replace(_loaded(file), model=plan.system.model)  # functions of time in a file are known at rows only
    if plan.settings.tolerance is not None:
        return warned(solution)
    doubts = (*detuned(solution, plan.system, plan.acting), *undamped_rows(solution, plan.system))
    solution = solution.with_statistics(warnings=doubts)
    if solution.statistics.warnings:
        file.commit(no_rows, solution.statistics, arrays)
    return warned_motion(solution)


def _section(
    plan: MotionPlan, checkpoint: Checkpoint, saved: SavedRows, before: np.ndarray
) -> tuple[Failure | None, Checkpoint]:
    """Take the steps of a section; return where it failed, if it did, and where to go on, from the same place then.

    before (2,): numbers of rows and events that were written.
    """
    state, rotations = checkpoint.state.copy(), checkpoint.rotations.copy()
    cutter = _cutter(plan, state, checkpoint)
    reached, steps = replace(checkpoint.reached), _steps(plan)
    tolerance, iterations = plan.settings.tolerance, checkpoint.counts[0]
    if tolerance is not None:
        failed = march_to_tolerance(
            cutter, plan.parts, state, rotations, tolerance, saved, _record(plan, cutter.statistics), reached, steps
        )
    else:
        failed = _fixed_steps(plan, cutter, state, rotations, saved, reached, steps)
    if failed is not None:
        return failed, checkpoint
    counts = np.array(
        [iterations + cutter.statistics.iterations, cutter.cuts, cutter.further, *(before + saved.waiting)]
    )
    memory = {} if cutter.memory is None else {"p": cutter.memory.p, **cutter.memory.kept}
    values = np.array(saved.watch.values)
    of_state = (state, rotations, cutter.exchanged, values, counts)
    return None, Checkpoint(reached, *of_state, saved.stopped, cutter.judged(), memory)


def _fixed_steps(
    plan: MotionPlan,
    cutter: StepCutter,
    state: np.ndarray,
    rotations: np.ndarray,
    saved: SavedRows,
    reached: Reached,
    most: int,
) -> Failure | None:
    """Take up to `most` steps of one stretch from where a motion is."""
    ends = np.array([part.times[-1] for part in plan.parts])
    number = int(np.searchsorted(ends, reached.time, side="right"))
    part = plan.parts[number]
    first = int(np.searchsorted(part.times, reached.time))
    last = min(first - first % most + most, len(part.times) - 1)
    begin, end = float(part.times[first]), float(part.times[last])
    if first == 0 and number > 0:
        if is_scheme(plan.settings.integrator):
            keep_momentum(plan.settings.integrator.rule(plan.parts[number - 1].step), state)
        state[2] = state[3] = initial_acceleration(plan.system, state, part.loads_from)
    section = replace(
        part,
        times=part.times[first : last + 1],
        loads_from=part.loads_from if first == 0 else begin,
        loads_to=part.loads_to if last == len(part.times) - 1 else end,
    )

    def keep(done: int, rows: Any) -> bool:
        saved.keep(section.times[done - len(rows.states) + 1 : done + 1], rows)
        return saved.stopped

    given = _prescribed(plan, sum(len(other.times) - 1 for other in plan.parts[:number]) + first, last - first)
    done = cutter.take(section, given, state, rotations, None, keep, jumps=first == 0, goes_on=first > 0)
    reached.time = float(section.times[done])
    if done < last - first and not cutter.stopped:
        return Failure(reached.time, float(section.times[done + 1]), cutter.why)
    return None


def _prescribed(plan: MotionPlan, first: int, steps: int) -> np.ndarray:
    """Return prescribed coordinates (steps, 3, nh) at the ends of steps from number `first` on."""
    begin = max(first - _BESIDE, 0)
    values = prescribed_motion(plan.system, plan.ends[begin : first + steps + 1 + _BESIDE])
    return values[first - begin + 1 : first - begin + steps + 1]


def _steps(plan: MotionPlan) -> int:
    """Return the number of steps of a section."""
    return min(_STEPS, max(_COORDINATES // plan.system.model.size, 2 * CHUNK))


def _record(plan: MotionPlan, statistics: MotionStatistics) -> Record:
    """Return a record without rows."""
    pairs, size = plan.system.model.numbered.rotation_pairs, plan.system.model.size
    none = Rows(np.empty((0, 3, size)), np.empty((0, len(pairs))), np.empty((0, 2)))
    return Record(none, 1, statistics, pairs)


def _cutter(plan: MotionPlan, state: np.ndarray, checkpoint: Checkpoint | None = None) -> StepCutter:
    """Return what takes the steps of a section; how many at a time does not depend on the time that they take."""
    integrator = plan.settings.integrator
    cutter = cutter_of(plan.system, integrator, plan.parts, state, _record(plan, MotionStatistics()))
    if is_scheme(integrator):
        cutter.size = cutter.largest = _steps(plan)
    if checkpoint is not None:
        cutter.cuts, cutter.further = checkpoint.counts[1:3].tolist()
        cutter.exchanged = checkpoint.exchanged
        if cutter.judge is not None and checkpoint.judge:
            cutter.judge.recall(checkpoint.judge)
        memory = dict(checkpoint.memory)
        cutter.memory = Memory(memory.pop("p"), memory) if memory else None
    return cutter


def _statistics(plan: MotionPlan, checkpoint: Checkpoint, complete: bool) -> Statistics:
    """Return how a run went."""
    unit, (iterations, cuts, further, _, _) = plan.system.model.unit("s"), checkpoint.counts.tolist()
    time, steps = checkpoint.reached.time, further
    rule: tuple[float, ...] = ()
    if plan.settings.tolerance is None:
        done, rule = int(np.searchsorted(plan.times, time, side="right")) - 1, plan.rule
        steps, ended = done + further, f"{done} steps of {plan.rows_at:g} {unit}"
    else:
        ended = f"{steps} steps"
    if not complete:
        ended += f", to {time:.6g} {unit} of {plan.times[-1]:g} {unit}; bf.resume goes on from there"
    status = Status.COMPLETED if complete else Status.STOPPED
    return Statistics(iterations, steps, cuts, ended, status, rule=rule)


def _sampled(plan: MotionPlan) -> np.ndarray:
    """Return the times [s] at which functions of time are saved."""
    return plan.times if plan.wanted is None else np.union1d(plan.wanted, plan.times[[0, -1]])


def _described(settings: MotionSettings, unfinished: bool) -> dict[str, Any]:
    """Return settings in numbers and names; unfinished: whether the motion has not come to its end."""
    integrator = settings.integrator
    kind = type(integrator)
    fields: dict[str, Any] = asdict(integrator) if is_dataclass(integrator) else {}
    return {
        **{name: getattr(settings, name) for name in ("duration", "step", "save_every", "tolerance", "save_at")},
        "integrator": [f"{kind.__module__}:{kind.__qualname__}", fields if _is_plain(fields) else {}],
        "events": [[event.name, event.rising, event.stop] for event in settings.events],
        "unfinished": unfinished,
    }


def _is_plain(fields: dict[str, Any]) -> bool:
    return all(isinstance(value, bool | int | float | str | None) for value in fields.values())


def _settings_in(begun: dict[str, Any], integrator: AnyIntegrator | None, events: Sequence[Event]) -> MotionSettings:
    """Return the settings of a file, with what it cannot hold. Raises InputError for another integrator, or events."""
    name, fields = begun["integrator"]
    if integrator is None:
        public("solve.motion")  # loads the modules in which those of the package are found by name
        try:
            integrator = cast("Scheme", class_of(name)(**fields))
        except NotImportedError:
            raise InputError(f"the motion was begun with the integrator {name}; give it to resume") from None
    numbers = ("duration", "step", "save_every", "tolerance", "save_at")
    duration, step, save_every, tolerance, save_at = (begun[key] for key in numbers)
    settings = settings_of(duration, step, integrator, save_every, tolerance, save_at, events)
    described = _described(settings, True)
    if described["integrator"] != [name, fields]:
        raise InputError(f"the motion was begun with the integrator {name} {fields or ''}, give the same")
    if described["events"] != begun["events"]:
        names = ", ".join(repr(each[0]) for each in begun["events"]) or "no events"
        raise InputError(f"the motion was begun with {names}; give the same events")
    return settings


def _loaded(file: MotionFile) -> Solution:
    """Return the motion in a file; of one that does not fit into memory, every k-th row."""
    rows, memory = file.rows, installed_memory()
    needed = 24 * file.size * rows
    if memory is None or needed <= 0.5 * USABLE_FRACTION * memory:
        return load(file.path)
    stride = int(needed // (0.5 * USABLE_FRACTION * memory)) + 1
    warn(
        f"the rows of {file.path} need {in_gib(needed)}; every {stride}th is returned, and "
        "bf.load(path, rows=slice(...)) returns others",
        LongRunWarning,
    )
    return load(file.path, slice(None, None, stride))
