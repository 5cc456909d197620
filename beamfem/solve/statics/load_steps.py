"""Load steps that stay on the path: by load factor if that is safe, otherwise by arc length."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.equations import linearise_at_rest, load_change, predicted_stresses
from beamfem.equations.redundant_conditions import in_words
from beamfem.equations.system import Proven, System
from beamfem.errors import ConvergenceError, LimitPointError
from beamfem.parts.pretension import Pretension
from beamfem.physics.stations import FOLLOWING, STRETCHING
from beamfem.precision.roundoff import ENOUGH, digits_of, largest_force
from beamfem.progress import progress
from beamfem.results.solution_checks import advice, may_turn_back, turned_back
from beamfem.solve.continuation.steps import leaves_arc
from beamfem.solve.newton.newton import Newton, NewtonResult, Termination, largest_change, solve_equilibrium
from beamfem.solve.start.mechanisms import NEGLIGIBLE, free_when_open, lost_at
from beamfem.solve.statics.load_path import (
    BESIDE,
    BifurcatesError,
    OutOfReachError,
    PathFollower,
    PathLostError,
    TurnsBackError,
    leave,
    rest_state,
    same_point,
)
from beamfem.solve.statics.static_record import StaticRecord, is_unstable

# of the lesser rise of the load per movement at the ends of a step: with less in between it may fall there
_FRACTION = 0.3
_SLOPE_WIDTH = 1e-3  # of the load step; loads are evaluated within it only, since functions may end with it


def leaves_path(system: System, start: tuple[np.ndarray, float], end: tuple[np.ndarray, float]) -> bool:
    """Return whether no smooth path leads from one equilibrium, p (n,) and its load factor, to another.

    Along an arc the chord deviates from the tangents at its ends by half the angle between them; between states on two
    pieces of a path, on either side of limit points, it deviates from one of them by more. Where a short snap leads on
    in the same direction, the load rises less over the step than at both its ends, see `_dips`.
    """
    (p, before), (q, after) = start, end
    width = _SLOPE_WIDTH * (after - before)
    try:
        first = _tangent(system, p, before, before + width, width)
        last = _tangent(system, q, after, after - width, width)
    except LinAlgError:
        return True
    chord = (q - p) / system.scale
    turn = _angle(first, last)
    if any(leaves_arc(_angle(chord, tangent), turn) for tangent in (first, last)):
        return True
    along = [(after - before) * float(chord @ tangent) for tangent in (first, last)]
    return min(along) > 0.0 and _dips(*(float(chord @ chord) / each for each in along))


def _dips(first: float, last: float) -> bool:
    """Return whether the load falls, or nearly does, on a cubic with these slopes at its ends and a mean slope of 1.

    Only a structure that is softer in between than at both ends is meant: where it softens or stiffens all the way,
    one slope is below the mean.
    """
    if min(first, last) <= 1.0:
        return False
    return first - (2.0 * first + last - 3.0) ** 2 / (3.0 * (first + last - 2.0)) < _FRACTION * min(first, last)


def _tangent(system: System, p: np.ndarray, load_factor: float, middle: float, width: float) -> np.ndarray:
    """Return the scaled derivative of p (n,) by the load factor, by a difference centred at `middle`."""
    prescribed = system.prescribed_dofs
    _, stiffness = linearise_at_rest(system, p, load_factor)
    result = np.zeros(len(p))
    slope = load_change(system, p, middle - width, middle + width)[system.free_dofs] / (2.0 * width)
    result[system.free_dofs] = stiffness.factorised(system.rotated).solve(-slope)
    change = system.prescribed_values(middle + width) - system.prescribed_values(middle - width)
    result[prescribed] = change / (2.0 * width)
    if not np.isfinite(result).all():
        raise LinAlgError("the tangent is singular")
    return result / system.scale


def _angle(a: np.ndarray, b: np.ndarray) -> float:
    """Return the angle [rad] between two changes (n,), zero if one of them vanishes."""
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(np.arccos(np.clip(float(a @ b) / size, -1.0, 1.0))) if size > 0.0 else 0.0


# Ratio of the first correction to the whole step, and of the speeds of two steps; it is larger near a limit point.
_OVERSHOOT = 3.0
_SHORT = 1e-2  # of the movement so far
# Iterations. Most models under constant forces start at rest and reach the end in one long step.
_SLOW, _SLOW_FROM_REST = 7, 12
_TURNED = 2.0  # [rad] of sections in a step, from which on they may have turned the other way round


def skips_limit_points(system: System, done: StaticRecord, target: float, result: NewtonResult, newton: Newton) -> bool:
    """Return whether a load step to `target` may have passed limit points.

    This is so if linearised stability predicts a critical point before its end, or if the tangent at its start leads
    far beyond its end, as near a limit point; this is not tested from the reference, where it also happens to a
    straight beam that is stiffened by its own tension. If the iteration was slow, it is also so if sections turn far,
    as weak ones may stay wound up by a correction that is far too large, if the state half-way has another count of
    negative pivots, or, in models without history, whose path has no kinks, if the step has another direction than the
    tangents at its ends.
    """
    if result.linear is not None:
        done.iterations += 1
        if result.linear != done.negative_pivots:
            return True
    if done.reached > 0.0:
        moved = largest_change(system, result.state - done.state)
        if result.first > _OVERSHOOT * moved + newton.tolerance:
            return True
    if result.iterations < _SLOW:
        return False
    if largest_change(system, result.state - done.state) > _TURNED:
        return True
    if result.iterations < _SLOW_FROM_REST and done.reached == 0.0 and _constant_forces(system, target):
        return False
    if _differs_half_way(system, done, target, result.state):
        return True
    if len(system.history.numbers) or len(system.connectors.one_sided):
        return False  # the tangent of a committed state is that of unloading, not of the path, which may have kinks
    done.iterations += 2
    return leaves_path(system, (done.state, done.reached), (result.state, target))


def is_short(system: System, done: StaticRecord, target: float, state: np.ndarray | None = None) -> bool:
    """Return whether a step moves little and continues the last one, so that no snap lies within it.

    A snap moves a structure far in a step of any size. In contrast, the count of negative pivots may change while an
    iteration yields too far. state (n,): at the end of the step; by default, it is as fast as the last one.
    """
    if len(done.rows) < 2:
        return False
    (before, last, _), (at, now, _) = done.rows[-2:]
    expected = largest_change(system, now - last) * (target - at) / (at - before) if at > before else 0.0
    moved = expected if state is None else largest_change(system, state - now)
    return moved <= min(_SHORT * largest_change(system, now - system.reference), _OVERSHOOT * expected)


def _constant_forces(system: System, load_factor: float) -> bool:
    """Return whether forces alone act, which neither follow the beam nor come from imposed strains and supports."""
    if any(item.change(load_factor, system.static) for item in system.prescribed):
        return False
    if Proven.CONSTANT_LOADS not in system.proven:
        follow = any(np.isin(each.kind, (FOLLOWING, STRETCHING)).any() for each in system.stations)
        if follow or any(block.imposed is not None for block in system.blocks):
            return False
        system.proven.add(Proven.CONSTANT_LOADS)
    return True


def _differs_half_way(system: System, done: StaticRecord, target: float, end: np.ndarray) -> bool:
    """Return whether the state half-way, with the mean stress resultants of both ends, has another count.

    Its own stress resultants would be those of a chord.
    """
    done.iterations += 1
    zeros = np.zeros(len(end))
    ends = (predicted_stresses(system, p, zeros, at) for p, at in ((done.state, done.reached), (end, target)))
    mean = tuple(0.5 * (one + other) for one, other in zip(*ends, strict=True))
    middle = 0.5 * (done.state + end)
    _, tangent = linearise_at_rest(system, middle, 0.5 * (done.reached + target), mean)
    try:
        return tangent.factorised(system.rotated).negative_pivots != done.negative_pivots
    except LinAlgError:
        return True


Snap = Literal["error", "jump"]
Unstable = Literal["keep", "leave"]

_CUTS = 4  # in succession, before the path is followed by arc length
_SHORTEST_OF_PAST = 2.0**-16  # of a requested step, for models with history, whose path is not followed
_EASY_ITERATIONS = 8
_LARGEST_TURN = 1.0  # [rad] of a prescribed rotation in one load step
SAME = 1e-12  # of the load factor: smaller differences count as zero
_SHORTEST_TURN = 1e-9  # of the load factor: a larger rotation within this is a jump


def reach(
    system: System,
    done: StaticRecord,
    step: float,
    newton: Newton,
    snap: Snap,
    stops: Sequence[float] = (),
    end: float = 1.0,
) -> None:
    """Add the rows from the last one to the load factor `end`, at most 1; `step` is the first load step.

    stops: load factors that get a row of their own, except those skipped by a jump.
    Raises LimitPointError and ConvergenceError with the solution so far.
    """
    remembers = len(system.history.numbers) > 0
    # with history, the result depends on the steps, so the end of each requested step is a stop, even if it is cut
    requested = [*stops, *(step * np.arange(1, round(1.0 / step))).tolist()] if remembers else stops
    ahead = sorted({stop for stop in requested if SAME < stop < end - SAME} | {end})
    follower = PathFollower(system, newton, done, (done.state, done.reached), leaves=snap == "jump")
    cuts, refused = 0, done.reached
    longest = step if remembers else 1.0
    with progress("load factor", end) as report:
        while done.reached < end:
            step = _within_a_turn(system, done, step)
            stop = next((stop for stop in ahead if stop > done.reached + SAME), end)
            target = stop if done.reached + step > stop - SAME else done.reached + step
            if follower.leaves and done.lost_stability:
                _follow(done, follower, (target, stop), snap)
                continue
            result, accepted = _attempt(system, done, target, newton)
            if accepted:
                state = system.history.in_equilibrium(result.state, target)
                done.add(target, state, result.negative_pivots, result.ended, result.digits)
                if target >= refused:
                    cuts = 0
                if result.iterations <= _EASY_ITERATIONS:
                    step = min(2.0 * step, longest)
            elif result.ended is Termination.NO_DIGITS:
                # round-off that hides a load hides the smaller ones of shorter steps as well
                raise ConvergenceError(f"at load factor {target:.6g} {result.ended.value}", done.solution())
            elif step > longest * _SHORTEST_OF_PAST if remembers else cuts < _CUTS:
                cuts += 1
                done.cuts += 1
                refused = max(refused, target)
                step *= 0.5
            elif holders := system.history.holders:
                _refuse_sliding(system, done, target)
                raise ConvergenceError(
                    f"no load step from load factor {done.reached:.6g} to {target:.6g} found an equilibrium: "
                    f"{result.ended.value}; models with {holders[0][0]} that have history are not followed along a "
                    "path, but simulate shows how they move",
                    done.solution(),
                )
            else:
                # beyond the point that the load step could not pass, a longer one is tried once
                _follow(done, follower, (target, stop), snap)
                refused = 1.0
                step *= 2.0
            report(done.reached)


def _refuse_sliding(system: System, done: StaticRecord, target: float) -> None:
    """Raise LimitPointError if connectors that stick begin to slip on the way to a load factor, and nothing stops them.

    While they slip, the tangent is no longer that of a stable equilibrium.
    """
    ahead, memory = target - done.reached, system.connectors.memory
    try:
        rate = _tangent(system, done.state, done.reached, done.reached + 0.5 * ahead, 0.5 * ahead)
        p = done.state + ahead * rate * system.scale
        slips = memory[system.history.in_equilibrium(p, target)[memory] != done.state[memory]]
        tangent = linearise_at_rest(system, p, target)[1]
        if tangent.factorised(system.rotated).negative_pivots == done.negative_pivots:
            return
    except LinAlgError:
        return
    parts = [item for item in system.connectors.items if np.isin(item.memory, slips).any()]
    if not parts:
        return
    raise LimitPointError(
        f"a limit load of friction at load factor {done.reached:.6g}: beyond it {in_words(parts)} slips, nothing else "
        "stops the motion, and there is no equilibrium nearby",
        done.reached,
        done.solution(),
        remedy="simulate shows how it moves; a spring, a stop or a prescribed displacement (Prescribed) instead of the "
        "load lets statics go on",
    )


def _attempt(system: System, done: StaticRecord, target: float, newton: Newton) -> tuple[NewtonResult, bool]:
    """Return the result of a load step, and whether it is the next row of the path."""
    result = solve_equilibrium(system, done.state, target, newton, done.negative_pivots)
    done.iterations += result.iterations
    if result.digits < ENOUGH:
        result = _with_digits_of_path(system, done, target, result)
    if result.ended is Termination.LOST and len(system.history.numbers) and is_short(system, done, target):
        again = solve_equilibrium(system, done.state, target, newton)
        done.iterations += again.iterations
        same = again.ended.good and again.negative_pivots == done.negative_pivots
        if same and is_short(system, done, target, again.state):
            return again, True
    good = result.ended.good and not _turns_back(system, result.state)
    return result, good and not skips_limit_points(system, done, target, result, newton)


def _turns_back(system: System, p: np.ndarray) -> bool:
    """Return whether the axis of a beam has a cusp in a state p (n,), to which only too long a step leads."""
    if not any(map(may_turn_back, system.model.groups)):
        return False
    meshes = (mesh for mesh in system.model.meshes if may_turn_back(mesh.beam.element))
    return any(turned_back(mesh, p[None]).min() < 0.0 for mesh in meshes)


def _with_digits_of_path(system: System, done: StaticRecord, target: float, result: NewtonResult) -> NewtonResult:
    """Return a result whose digits are those of the largest force of the path, as where a structure is unloaded."""
    largest = max(largest_force(system, state, at) for at, state, _ in done.rows)
    digits = digits_of(system, result.state, target, largest)
    if digits < max(result.digits, 1.0):
        return result
    good = result.ended is Termination.NO_DIGITS
    return result._replace(digits=digits, ended=Termination.ROUND_OFF if good else result.ended)


def _within_a_turn(system: System, done: StaticRecord, step: float) -> float:
    """Return a load step in which no prescribed rotation exceeds the largest allowed turn. Raises ConvergenceError."""
    while system.largest_turn(done.reached, min(done.reached + step, 1.0)) > _LARGEST_TURN:
        step *= 0.5
        if step < _SHORTEST_TURN:
            require_no_jump_of_rotations(system, done, min(done.reached + 2.0 * step, 1.0))
    return step


def require_no_jump_of_rotations(system: System, done: StaticRecord, after: float) -> None:
    """Raise ConvergenceError if a prescribed rotation changes too much up to a load factor just after the last row."""
    if system.largest_turn(done.reached, after) > _LARGEST_TURN:
        raise ConvergenceError(
            f"a prescribed rotation jumps by more than {_LARGEST_TURN:g} rad just after load factor "
            f"{done.reached:.6g}; let it turn over a part of the load factor, so that turns can be counted",
            done.solution(),
        )


def _follow(done: StaticRecord, follower: PathFollower, to: tuple[float, float], snap: Snap) -> None:
    """Add the rows along the path or, if the path turns back, up to the state after the jump.

    to: the load factor to reach, and the largest one allowed for rows.
    """
    try:
        for point in follower.follow(*_start(done, follower), *to):
            if point.load_factor > done.reached:
                done.add(point.load_factor, point.y[:-1], point.negative_pivots, Termination.CONVERGED)
    except BifurcatesError as bifurcation:
        leave(follower.system, done, bifurcation, to[1], follower.newton)
    except TurnsBackError as turn:
        if not _merges(follower, done, turn.limit, turn.beyond, to[1]):
            _jump(follower, done, turn, snap)
    except PathLostError as lost:
        reached = np.append(done.state, done.reached)
        lost_near_by = len(done.rows) > 1 and not isinstance(lost, OutOfReachError)
        if lost_near_by and _merges(follower, done, reached, 2.0 * reached - np.append(done.rows[-2][1], 0.0), to[1]):
            return
        message = f"the path could not be followed beyond load factor {done.reached:.6g}: {lost}"
        message = lost_at(follower.system, done.reached, message + advice(done.model, done.state))
        raise ConvergenceError(message, done.solution()) from lost


def _start(done: StaticRecord, follower: PathFollower) -> tuple[np.ndarray, float]:
    """Return the state (n,) and load factor from which the path is followed.

    Where unstable paths are left, that is just below the last row, or at the row before it: a bifurcation that is the
    last row itself lies in no step that begins there, and its tangent has pivots of any sign.
    """
    before, below = done.rows[-2:][0], (1.0 - BESIDE) * done.reached
    if not follower.leaves or before[0] >= below or is_unstable(done.symmetric, before[2]):
        return done.state, done.reached
    result = solve_equilibrium(follower.system, done.state, below, follower.newton)
    done.iterations += result.iterations
    if result.ended.good and not is_unstable(done.symmetric, result.negative_pivots):
        return result.state, below
    return before[1], before[0]


def _merges(follower: PathFollower, done: StaticRecord, point: np.ndarray, beyond: np.ndarray, end: float) -> bool:
    """Add a row beyond a critical point (n + 1,) at which a branch merges into a stable path; return whether it does.

    In this case the structure comes to rest as close as it moved over an equally small part of the load before; beyond
    a limit point it moves far.
    """
    load_factor = float(point[-1])
    target = min((1.0 + BESIDE) * load_factor, end)
    below = [(state, count) for at, state, count in done.rows if at <= 2.0 * load_factor - target]
    if not below or below[-1][1] != 0 or target <= load_factor:
        return False
    farthest = largest_change(follower.system, below[-1][0] - point[:-1])
    if farthest == 0.0:  # at rest until the load jumps: no movement before to compare with
        return False
    result = rest_state(follower.system, np.append(point[:-1], target), beyond, follower.newton, farthest)
    done.iterations += result.iterations
    if result.ended.good:
        done.add(target, result.state, 0, result.ended, result.digits)
    return result.ended.good


def _jump(follower: PathFollower, done: StaticRecord, turn: TurnsBackError, snap: Snap) -> None:
    """Add the state of rest after a limit point. Raises LimitPointError unless jumps are allowed."""
    load_factor = float(turn.limit[-1])
    where = f"a limit point at load factor {load_factor:.6g}: beyond it there is no equilibrium nearby"
    if abs(load_factor) <= NEGLIGIBLE and (opened := free_when_open(follower.system)):
        raise LimitPointError(where + opened, load_factor, done.solution())
    if snap == "error":
        loads, loaded = follower.system.model.loads, follower.system.loads.at(1.0).any
        unstable = [at for at, _, count in done.rows if is_unstable(done.symmetric, count)]
        if unstable:
            where += f"; the path is unstable from load factor {unstable[0]:.6g} on"
        remedy = 'unstable="leave" follows the stable branch instead'
        if not unstable:
            remedy = (
                'trace_equilibrium follows the path around it; snap="jump" goes to the state in which the structure '
            )
            remedy += (
                f"comes to rest{'; or prescribe a displacement (Prescribed) instead of the load' if loaded else ''}"
            )
        if any(isinstance(load, Pretension) and not load.scale for load in loads) and any(
            load.scale and load.amplitude is None for load in loads
        ):
            remedy = (
                f"Pretension acts fully at load factor 0; let weight do so, too: Gravity(scale=False). Or else {remedy}"
            )
        raise LimitPointError(where, load_factor, done.solution(), remedy=remedy)
    if follower.left is not None and same_point(follower.system, follower.left, turn.limit):
        raise LimitPointError(
            f"{where}, and the structure comes back to it each time it leaves it", load_factor, done.solution()
        )
    follower.left = turn.limit
    done.add(load_factor, turn.limit[:-1], 0, Termination.CONVERGED)
    result = rest_state(follower.system, turn.limit, turn.beyond, follower.newton)
    done.iterations += result.iterations
    if not result.ended.good:
        raise LimitPointError(f"{where}, and no state of rest was found beyond it", load_factor, done.solution())
    done.add(load_factor, result.state, result.negative_pivots, result.ended, result.digits)
