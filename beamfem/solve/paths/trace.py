"""Equilibrium paths by arc-length continuation, through limit points in load and in displacement."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.equations import residual_at_rest
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.model.model import Model
from beamfem.precision.roundoff import FEW_DIGITS, remainder
from beamfem.progress import kept, progress
from beamfem.results.full_turns import first_turns
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.results.solution_checks import advice, warned
from beamfem.results.status import Statistics, Status
from beamfem.solve.accuracy.adapted_mesh import prepared, refined_until
from beamfem.solve.accuracy.coarse_mesh import warned_of_coarse_mesh
from beamfem.solve.accuracy.quantity_change import Quantity
from beamfem.solve.continuation.continuation import Continuation, PathPoint, begin
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError
from beamfem.solve.continuation.steps import Refused, Step, longest_accepted, longest_step, take_step, too_small
from beamfem.solve.newton.newton import Newton, require_newton
from beamfem.solve.paths.path_error import path_attempt
from beamfem.solve.start.functions_of_time import SAME, Jump, functions_of_time, jumps_between, kinks_between
from beamfem.solve.start.mechanisms import lost_at, no_equilibrium_at_start, require_independent, require_support
from beamfem.solve.start.start_checks import left_over, refuse_memory
from beamfem.solve.statics.statics import first_equilibrium, nothing_acts
from beamfem.validation import count, finite, function_of_one, optional, positive, shown

_SAME_POINT = 1e-5  # lengths of the model, radians: bifurcations are located to about 1e-8


class PathRecord:
    """Results so far; rows: points y (n + 1,), whether they are stable, and counted rotations (m,) [rad].

    One call adds a row, so that rows are complete after an interruption.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        # for unsymmetric tangents the signs of pivots do not determine stability
        self.symmetric = system_of(model, static=True).symmetric
        self.rows: list[tuple[np.ndarray, bool, np.ndarray]] = []
        self.limit_points: list[PathState] = []
        self.bifurcations: list[Bifurcation] = []
        self.iterations = 0
        self.cuts = 0
        self.ended = "the path was not followed to its end"
        self.status = Status.STOPPED

    def add(self, y: np.ndarray, stable: bool, turned: np.ndarray | None = None) -> None:
        """Add a point y (n + 1,); turned (m,) [rad]: see `PathState`, by default continued from the last point."""
        self.rows.append((y, stable, self._turned(y) if turned is None else turned))

    def end(self, why: str) -> None:
        """Record that the path is complete, and why it ends there."""
        self.ended, self.status = why, Status.COMPLETED

    @property
    def last(self) -> PathState:
        y, stable, _ = self.rows[-1]
        return self.state(y, stable if self.symmetric else None)

    def add_critical(self, line: Continuation, step: Step, last: PathPoint) -> None:
        """Add the limit points and bifurcations of a step up to its last point."""
        segment = step.segment
        fraction = line.dot(last.y - segment.before.y, segment.chord) / line.dot(segment.chord, segment.chord)
        for x in step.limits:
            if x <= fraction:
                self.limit_points.append(self.state(segment.critical(x)))
        for crossing in step.crossings:
            if crossing.fraction <= fraction:
                state = vars(self.state(crossing.y))
                self.bifurcations.append(Bifurcation(**state, mode=crossing.mode[:-1], tangent=crossing.tangent))

    def state(self, y: np.ndarray, stability: bool | None = False) -> PathState:
        """Return the state of y (n + 1,), coordinates and load factor; stability: whether it is stable, if known."""
        zeros, (p,) = np.zeros(self.model.size), system_of(self.model, static=True).finished(y[None, :-1], [y[-1]])
        turned = self._turned(y)
        return PathState(p, zeros, zeros, float(y[-1]), self.model, stability=stability, turned=turned)

    def _turned(self, y: np.ndarray) -> np.ndarray:
        """Return the rotations (m,) [rad] of `first_turns` in y (n + 1,), continued from the last point."""
        last = self.rows[-1][2] if self.rows else np.zeros(len(self.model.numbered.uncounted))
        return first_turns(self.model, y[:-1], last)

    def path(self) -> Path:
        rows, stable, turned = map(np.array, zip(*self.rows, strict=True))
        system = system_of(self.model, static=True)
        digits = remainder(system, rows[-1, :-1], float(rows[-1, -1])).digits
        ended = self.ended
        if digits < FEW_DIGITS:
            ended += f"; round-off leaves {digits:.0f} digits of the forces"
        statistics = Statistics(self.iterations, len(rows) - 1, self.cuts, ended, self.status, digits=digits)
        zeros = np.zeros((len(rows), self.model.size))
        states = system.finished(rows[:, :-1], rows[:, -1].tolist()), zeros, zeros.copy()
        return Path(
            self.model,
            True,
            rows[:, -1],
            *states,
            statistics,
            stability=stable if self.symmetric else None,
            turned=turned,
            limit_points=tuple(self.limit_points),
            bifurcations=tuple(self.bifurcations),
        )


_FIRST_MODE = 0.02  # distance along the mode of the first search: lengths of the model, radians
_TRIES = 20
_ALIKE = 0.1  # [rad]: directions within this angle are the same, since branches bend
_ALONG = 1e-3  # of a mode: a smaller component normal to the path means that the path is tangential to it


def leave(
    line: Continuation, bifurcation: Bifurcation, direction: int, passed: Callable[[PathPoint], bool]
) -> PathPoint | str:
    """Return a point of the branch close to a bifurcation, or why there is none.

    passed: whether a point lies beyond the end of the path; then one closer to the bifurcation is looked for.
    It is the equilibrium in the plane normal to the mode at a small distance along it. The component of the mode along
    the path that was followed is removed, so that this path does not meet the plane. If several modes become soft at
    once, branches leave along some of their combinations only; an equilibrium found in the same direction at two
    distances is on a branch that starts here, however far it is from the mode.
    """
    start = np.append(bifurcation.p, bifurcation.at)
    try:
        way = direction * _other_way(line, start, bifurcation)
    except LinAlgError:
        return "the tangent is singular"
    distance, reason = _FIRST_MODE, ""
    others: list[np.ndarray] = []  # equilibria found away from the mode
    for _ in range(_TRIES):
        step = distance * way
        corrected = line.correct(start + step, line.stresses(start, step), way)
        reason = corrected.ended.value
        if corrected.ended.good:
            moved = corrected.y - start
            if line.length(moved) < 2.0 * distance:
                equilibria = [corrected.y]
            else:
                reason = "the equilibrium beside it is far away"
                way_there = moved / line.length(moved)
                ways = [(y - start) / line.length(y - start) for y in others]
                equilibria = [y for y, own in zip(others, ways, strict=True) if line.length(own - way_there) < _ALIKE]
                others.append(corrected.y)
            try:
                if equilibria:
                    found = line.linearised(equilibria[0], equilibria[0] - start)
                    if not passed(found):
                        return found
                    reason, others = "the path ends next to the bifurcation", []
            except LinAlgError:
                reason = "the tangent is singular"
        distance *= 0.5
    return reason


def _other_way(line: Continuation, start: np.ndarray, bifurcation: Bifurcation) -> np.ndarray:
    """Return the unit change of y (n + 1,) that is normal to the path and keeps the balance to first order.

    It is along the mode or, if the path itself is, towards larger load factors. Raises LinAlgError.
    """
    along = bifurcation.tangent / line.length(bifurcation.tangent)
    mode = np.append(bifurcation.mode, 0.0)
    mode /= line.length(mode)
    across = mode - line.dot(mode, along) * along
    if line.length(across) < _ALONG:
        across = line.linearised(start, line.load_axis).tangent
        across = across - line.dot(across, mode) * mode
    return np.asarray(across / line.length(across))


_FIRST_STEP = 2e-3  # along the path, see Continuation
_ITERATIONS = 15  # a shorter step is cheaper than more iterations
_AHEAD = 1.2  # of a step: kinks are looked for up to there, so that none is left next to its end
_NEAR_START = 0.01  # of the load factor: where an undeclared kink at load factor 0 is looked for

Until = float | Callable[[PathState], bool] | None


def trace_equilibrium(
    model: Model,
    until: Until = None,
    *,
    start: Bifurcation | None = None,
    direction: int | None = None,
    step: float | None = None,
    points: int = 500,
    newton: Newton | None = None,
    accuracy: float | None = None,
    quantity: Quantity = None,
) -> Path:
    """Trace the equilibrium path from load factor 0, past limit points, or a branch from a bifurcation.

    Steps along the path are cut and enlarged according to the iterations and the curvature of the path. Source: Riks
    1979; Wagner and Wriggers 1988 (bifurcations); Magisano, Leonetti and Garcea 2017 (stresses).

    Parameters
    ----------
    model : Model
        Beams, supports and loads; loads with scale=True grow with the load factor.
    until : float or callable, optional
        Final load factor, or a function of a state that returns True at the end of the path; without it the path ends
        after `points` points.
    start : Bifurcation, optional
        A bifurcation of a path of this model; the crossing branch is followed, on the mesh of that path.
    direction : {1, -1}, optional
        1 to start towards larger load factors, -1 towards negative ones; by default towards `until`. From a
        bifurcation: to the side of its mode (1, the default) or to the other side (-1); if the mode is along a branch
        that returns, towards larger (1) or smaller (-1) load factors.
    step : float, [-], optional
        Load factor of the second point.
    points : int, default 500
        Largest number of points.
    newton : Newton, optional
        Tolerances of the iteration.
    accuracy : float, [-], optional
        Refine the mesh, as `solve_static` does, until displacements are off by at most this number times the size of
        the model, and load factors by this number times the largest one, at every point of the path, and those of limit
        points and bifurcations by this number times the largest of them; or the quantity by this number times its
        largest value.
    quantity : callable or Point, optional
        What is to be accurate: a function of the path that returns a number or numbers, such as the load factor of its
        first limit point, or a point for its displacements; by default all displacements and load factors.

    Raises
    ------
    InputError
        Before the solve, for invalid arguments; for an accuracy and elements that lock.
    FreeMotionError
        If the model can move without resistance, and loads with scale=False do not stiffen it.
    ConvergenceError
        If the path cannot be continued, or no mesh reaches the accuracy; its `solution` has the path so far. Any other
        exception during the solve, such as one of `until` or KeyboardInterrupt, carries `solution` too.

    Warns
    -----
    LockingWarning
        If locking changes displacements by 1 % or more.
    LargeStrainWarning
        If strains of a linear law exceed 0.2, or the utilisation of a strength exceeds 1.

    Examples
    --------
    >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e6, 0.0))])
    >>> path = bf.trace_equilibrium(column, until=1.0)
    >>> round(path.bifurcations[0].load_factor, 3)  # Euler: 539.7 kN
    0.539
    """
    if callable(until):
        function_of_one("until", until, "a state of the path")
    else:
        until = optional(finite)("until", until)
    if step is not None:
        step = positive("step", step)
        if start is not None:
            raise InputError("step is the load factor of the second point of a path from 0; a branch finds its own")
    count("points", points)
    whole = isinstance(direction, int | np.integer) and not isinstance(direction, bool)
    if direction is not None and not (whole and direction in (1, -1)):
        raise InputError(f"direction must be 1 or -1, got {shown(direction)}")
    if direction is None:
        direction = -1 if start is None and isinstance(until, float) and until < 0.0 else 1
    newton = require_newton(newton, Newton(iterations=_ITERATIONS))
    chosen = False  # whether a branch has a mesh that was chosen for the path that it leaves
    if isinstance(start, Bifurcation):
        chosen = model.automatic
        model, start = _on_mesh_of(start, model, accuracy)
    model, accuracy = prepared(model, accuracy, quantity=quantity)

    def trace(model: Model) -> Path:
        return _traced(model, until, start, direction, step, points, newton)

    if accuracy is None:
        path = warned(trace(model))
        return warned_of_coarse_mesh(path, unseen=True) if chosen else path
    return warned(refined_until(model, accuracy, lambda model: path_attempt(trace(model), quantity, trace, accuracy)))


def _on_mesh_of(start: Bifurcation, model: Model, accuracy: float | None) -> tuple[Model, Bifurcation]:
    """Return a model whose elements follow from an accuracy on the mesh of a bifurcation of it, and that in this model.

    Raises InputError for an accuracy of the branch, and for a bifurcation of another model.
    """
    if accuracy is not None:
        raise InputError("a branch has the mesh of the path that it leaves; ask for the accuracy of that path")
    if model.automatic:
        model = model.meshed(start)
        start = replace(start, model=model)
        if left_over(system_of(model, static=True), start.p, start.at) > 0.0:
            raise InputError(_OTHER_MODEL)
    return model, start


_OTHER_MODEL = "start is a bifurcation of another model; trace the path of this one first"


def _traced(
    model: Model,
    until: Until,
    start: Bifurcation | None,
    direction: int,
    step: float | None,
    points: int,
    newton: Newton,
) -> Path:
    system = system_of(model, static=True)
    system.forget_digits()
    refuse_memory(system, "trace_equilibrium")
    if nothing_acts(system):
        require_support(system)
    require_independent(system, system.reference)
    if not len(system.free_dofs):
        raise InputError("the supports of this model prescribe all of its coordinates, so there is no path to follow")
    _require_load(system)
    if not isinstance(start, Bifurcation | None):
        raise InputError(f"start must be a bifurcation, such as path.bifurcations[0], got a {type(start).__name__}")
    if start is not None and start.model is not model:
        raise InputError(_OTHER_MODEL)
    record = PathRecord(model)
    with kept(lambda: record.path() if record.rows else None), progress("points of the path", points) as report:
        line, point = _first(system, newton, record, direction)
        size = _FIRST_STEP if step is None else step / abs(point.tangent[-1])
        if step is not None and too_small(line, point, size):
            raise InputError(f"step must be larger: {step:g} of the load factor moves the model by round-off only")
        if start is None:
            point = replace(point, tangent=direction * point.tangent)
            record.add(point.y, point.negative_pivots == 0)
            _require_no_jump_at_start(line, direction, record, point)
        else:
            record.add(np.append(start.p, start.at), stable=False, turned=start.turned)
            if points > 1:
                point, size = _branch(line, start, direction, record, until)
        landed, end = False, until if isinstance(until, float) else None
        while not (landed or _met(until, record.last)):
            if len(record.rows) >= points:
                record.end(f"the {points} points are used up")
                break
            line, kink, jump = _piece(line, point, size, end)
            taken, landing = _step(line, point, size, record, end, kink)
            size = taken.next_size
            landed = landing is not None
            point = taken.segment.after if landing is None else landing
            record.add(point.y, point.negative_pivots == 0)
            record.add_critical(line, taken, point)
            found = [np.append(other.p, other.at) for other in record.bifurcations if start is not None]
            if any(line.length(y - record.rows[0][0]) < _SAME_POINT for y in found):
                record.end("the branch is closed: it has come back to the bifurcation from which it starts")
                break
            if point.load_factor == kink and not landed:
                if jump is not None and _is_felt(jump, system, point):
                    _end_at(jump, record)
                line, point = _beyond(line, point)
            line, rescaled = line.rescaled(point)
            point, size = rescaled, size * line.length(point.tangent)
            report(len(record.rows))
        else:
            record.end("the path has reached the end that was asked for")
    return record.path()


def _require_load(system: System) -> None:
    """Raise InputError if nothing changes with the load factor."""
    if (system.model.frame is not None and system.model.frame.speed != 0.0) or system.connectors.follow_time:
        return
    kinks = [kink for function in functions_of_time(system) for kink in function.kinks]
    for at in (0.37, 1.0, *kinks):
        changes = [(system.prescribed_values(at), system.prescribed_values(0.0))]
        changes += zip(system.loads.at(at).arrays, system.loads.at(0.0).arrays, strict=True)
        if any(not np.array_equal(now, before) for now, before in changes):
            return
    raise InputError(
        "no load and no prescribed motion of this model changes with the load factor, so there is no path to follow"
    )


def _piece(
    line: Continuation, point: PathPoint, size: float, end: float | None
) -> tuple[Continuation, float | None, Jump | None]:
    """Return the continuation up to the next kink of a function, its load factor, and its jump, if a step may reach it.

    A kink that is found from samples at the end of the path is that end: a step between the two would be round-off.
    """
    if not line.functions_of_time:
        return line, None, None
    size = min(size, longest_step(line, point))
    ahead = point.load_factor + _AHEAD * size * float(point.tangent[-1])
    kink = next(iter(kinks_between(line.functions_of_time, point.load_factor, ahead)), None)
    jump = None
    if kink is not None:
        low, high = sorted((point.load_factor, ahead))
        jumps = (jump for jump in jumps_between(line.functions_of_time, low, high) if jump.before > low)
        jump = next((jump for jump in jumps if abs(jump.before - kink) <= SAME * (high - low)), None)
    if jump is not None:
        kink = jump.before if ahead > point.load_factor else jump.after
    elif kink is not None and end is not None and abs(kink - end) <= SAME * abs(ahead - point.load_factor):
        kink = end
    low, high = line.piece
    if kink is not None and kink > point.load_factor:
        high = kink
    elif kink is not None:
        low = kink
    return replace(line, piece=(low, high)), kink, jump


def _require_no_jump_at_start(line: Continuation, direction: int, record: PathRecord, point: PathPoint) -> None:
    """Raise ConvergenceError if a function jumps from its value at load factor 0."""
    with suppress(InputError):  # from a function that is not defined so far
        low, high = sorted((0.0, direction * _NEAR_START))
        for jump in jumps_between(line.functions_of_time, low, high):
            if 0.0 in (jump.before, jump.after) and _is_felt(jump, line.system, point):
                _end_at(jump, record)


_FELT = 1e-6  # of the largest force: change of those that supports do not take up; of a prescribed displacement


def _is_felt(jump: Jump, system: System, point: PathPoint) -> bool:
    """Return whether a jump moves the model, unlike that of a force which arrives at a support."""
    moved = [system.prescribed_changes(at) for at in (jump.before, jump.after)]
    if np.any(np.abs(moved[1] - moved[0]) > _FELT * np.abs(moved).max(axis=0)):
        return True
    ends = [residual_at_rest(system, point.y[:-1], at) for at in (jump.before, jump.after)]
    change, largest = np.abs(system.along_free(ends[1] - ends[0])), max(float(np.abs(end).max()) for end in ends)
    return bool(change.max(initial=0.0) > _FELT * largest)


def _end_at(jump: Jump, record: PathRecord) -> None:
    """Raise ConvergenceError with the path up to a jump."""
    (first, last), at = jump.values, round(jump.after, 12)
    raise ConvergenceError(
        f"the path ends at load factor {at:.6g}, where {jump.name} jumps from {first:.6g} to {last:.6g}; solve_static "
        "continues behind a jump",
        record.path(),
    )


def _beyond(line: Continuation, point: PathPoint) -> tuple[Continuation, PathPoint]:
    """Return the continuation and the point at a kink with the slopes behind it, in the direction of the path."""
    grows = float(np.sign(point.tangent[-1]))
    line = replace(line, piece=(point.load_factor, np.inf) if grows > 0.0 else (-np.inf, point.load_factor))
    try:
        return line, line.linearised(point.y, grows * line.load_axis)
    except LinAlgError:
        raise ConvergenceError(f"the path ends at the kink at load factor {point.load_factor:.6g}") from None


def _first(system: System, newton: Newton, record: PathRecord, direction: int) -> tuple[Continuation, PathPoint]:
    """Return the continuation and the point at load factor 0."""
    functions, piece = functions_of_time(system), (-np.inf, np.inf)
    with suppress(InputError):  # from a function that is not defined so far
        declared = any(0.0 in function.kinks for function in functions)
        if declared or kinks_between(functions, -_NEAR_START, 1.3 * _NEAR_START):
            piece = (0.0, np.inf) if direction > 0 else (-np.inf, 0.0)
    first = first_equilibrium(system, newton)
    record.iterations += first.iterations
    if not first.ended.good:
        record.add(np.append(system.reference, 0.0), stable=False)
        raise ConvergenceError(no_equilibrium_at_start(system, first.ended.value))
    try:
        return begin(system, first.state, 0.0, newton, piece)
    except LinAlgError:
        raise ConvergenceError("there is no path from load factor 0: the tangent is singular") from None


def _branch(
    line: Continuation, start: Bifurcation, direction: int, record: PathRecord, until: Until
) -> tuple[PathPoint, float]:
    """Return the first point of the branch that leaves a bifurcation, before its end, and the length of the step."""

    def passed(point: PathPoint) -> bool:
        if isinstance(until, float):
            return (point.load_factor - until) * (start.at - until) < 0.0
        stability = point.negative_pivots == 0 if record.symmetric else None
        return _met(until, record.state(point.y, stability))

    found = leave(line, start, direction, passed)
    if isinstance(found, str):
        raise ConvergenceError(f"no branch was found at the bifurcation at load factor {start.at:.6g}: {found}")
    record.add(found.y, found.negative_pivots == 0)
    return found, line.length(found.y - record.rows[0][0])


def _step(
    line: Continuation, point: PathPoint, size: float, record: PathRecord, end: float | None, kink: float | None
) -> tuple[Step, PathPoint | None]:
    """Return the longest accepted step from a point up to `size`, and the point on it with the load factor `end`.

    kink: load factor of the next kink of a function that acts, at which the step ends if it is that long. Raises
    ConvergenceError with the most frequent reason for rejections, since round-off decides the shortest steps.
    """
    to_kink = np.inf if kink is None else (kink - point.load_factor) / float(point.tangent[-1])

    def attempt(point: PathPoint, size: float) -> tuple[Step, PathPoint | None] | Refused:
        reaches = size >= to_kink / _AHEAD
        outcome = take_step(line, point, to_kink, kink) if reaches else take_step(line, point, size)
        record.iterations += outcome.iterations
        if isinstance(outcome, Refused):
            return outcome
        ends = outcome.segment.before.load_factor, outcome.segment.after.load_factor
        if kink is not None and (ends[0] - kink) * (ends[1] - kink) < 0.0:
            return Refused(f"a function has a kink at load factor {kink:.6g} within the step", outcome.iterations)
        try:
            return outcome, None if end is None else _landing(line, outcome, end)
        except SegmentLostError as error:
            return Refused(f"the load factor {end:g} was not found on the path: {error}", outcome.iterations)

    found, reasons, size = longest_accepted(line, point, min(size, longest_step(line, point, end)), attempt)
    record.cuts += len(reasons)
    if found is None:
        record.ended = max(reasons, key=reasons.count)
        message = (
            f"the path ends at load factor {point.load_factor:.6g} after {len(record.rows)} points: "
            f"{record.ended}, with steps along it down to {size:.1e}{advice(record.model, point.y[:-1])}"
        )
        raise ConvergenceError(lost_at(line.system, point.load_factor, message), record.path())
    step, landing = found
    return replace(step, next_size=min(step.next_size, size)) if reasons else step, landing


def _landing(line: Continuation, step: Step, load_factor: float) -> PathPoint | None:
    """Return the first point of a step with the load factor, None if the step does not reach it."""
    found = step.segment.found
    # close to limit points there are others, if they are interpolated themselves
    stops = [found[x] for x in (sorted(found) if step.limits else (0.0, 1.0))]
    for before, after in pairwise(stops):
        low, high = before.load_factor - load_factor, after.load_factor - load_factor
        if high == 0.0:
            return after
        if low * high < 0.0:
            return Segment(line, before, after).at_load(load_factor)
    return None


def _met(until: Until, state: PathState) -> bool:
    if not callable(until):
        return False
    try:
        answer = until(state)
    except Exception as error:
        error.add_note(
            f"raised by `until`, for the state at load factor {state.load_factor:.6g}; results of one state, such as "
            "state.displacement(point)[1], have no axis of rows"
        )
        raise
    if not isinstance(answer, bool | np.bool_):
        raise InputError(f"until must return True or False for a state of the path, got {answer!r}")
    return bool(answer)
