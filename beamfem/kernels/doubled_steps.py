"""Pairs of time steps of collocation whose size follows the error, many in one compiled call.

A step of double size beside each pair shows the error of both (Hairer, Norsett and Wanner 1993, II.4). It begins with
the accelerations of the pair, so that an iteration or two suffice.
"""

import math

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import System
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, zeros
from beamfem.kernels.stage_record import Doubled, Stages
from beamfem.kernels.stage_steps import end_step, solve_step, start_step

_SAFETY = 0.8  # of the step that would have the error allowed
_SAME = 1.25  # times the step, up to which it is kept, with its tangent
_LARGEST, _SMALLEST = 4.0, 0.2  # changes of the step at once
_RECOVERED = 1.25  # after a step was refused, the largest change grows by
_SHORTER = 0.7  # change of the step if its iterations do not converge
_ROUND_OFF = 2e-14  # of the model: error of a step that may be round-off
_ITERATED = 0.02  # of the error allowed: what iterations may move the model by up to the end
_FINEST = 1e-16  # of the model: error of iterations
_LINEAR = 0.1  # share of the difference, or of the one allowed, that is left to iterations
_FAST = 0.4  # rate of convergence of the next steps: it grows with their square, as sections turn within them
_USELESS = 0.5  # rate of convergence with which a tangent ends
_MOST = 5  # iterations


@routine()
def sample_nothing(solver: MotionSolver) -> None:
    """Sample no loads."""


@routine()
def resize(stages: Stages, doubled: Doubled, h: float) -> None:
    """Prepare a method for steps of another size."""
    small_code()
    s = stages.stages
    for i in range(s * s):
        stages.of_p[i], stages.of_v[i] = h * h * doubled.of_p[i], h * doubled.of_v[i]
    for i in range(s):
        stages.of_begin[2 * i] = h * h * doubled.of_begin[2 * i]
        stages.of_begin[2 * i + 1] = h * doubled.of_begin[2 * i + 1]
        stages.at_end[i], stages.at_end[s + i] = h * h * doubled.at_end[i], h * doubled.at_end[s + i]
        weights, unit = at(stages.weights, 3 * i), at(doubled.weights, 3 * i)
        weights[0], weights[1], weights[2] = h * h * unit[0], h * unit[1], unit[2]
    stages.time_step, stages.rate, stages.factored = h, 0.0, 0


@routine()
def look_ahead(stages: Stages, doubled: Doubled, ratio: float) -> None:
    """Extrapolate accelerations from a step to one of another size, the ratio of both.

    The polynomial goes through the stages, and the end of the step if it is no stage.
    """
    s, known = stages.stages, stages.samples
    for i in range(s):
        x = 1.0 + ratio * stages.nodes[i]
        stages.ahead[i * (s + 1) + s] = 0.0
        for j in range(known):
            value = 1.0
            for k in range(known):
                if k != j:
                    value *= (x - doubled.shares[k]) / (doubled.shares[j] - doubled.shares[k])
            stages.ahead[i * (s + 1) + j] = value


@inlined
def _gather(doubled, step):
    """Take the accelerations of a step of the pair to those that the double step begins with."""
    fine, coarse, s = doubled.fine, doubled.coarse, doubled.fine.stages
    own, to, shares = as_rows(fine.last), as_rows(coarse.last), at(doubled.gathered, step * s * s)
    for k in range(0, fine.stride, WIDTH):
        for i in range(s):
            total = zeros()
            if step > 0:
                total = to[i * fine.stride + k] + 0.0
            for j in range(s):
                total += shares[i * s + j] * own[j * fine.stride + k]
            to[i * fine.stride + k] = total


@routine(fastmath=FAST)
def difference(solver: MotionSolver, doubled: Doubled) -> float:
    """Return the largest difference of a position at the end of a pair and of the double step, of the model."""
    coarse, size, n = doubled.coarse, zeros(), solver.size
    s, stride, h, begin, a = coarse.stages, coarse.stride, coarse.time_step, coarse.begin, coarse.a
    found, scale, end = coarse.p, as_rows(doubled.scale), at(coarse.p, (coarse.stages - 1) * coarse.stride)
    for k in range(n):
        total = end[k] - solver.state[k]
        if coarse.samples > s:  # no stage is the end
            total = begin[k] + h * begin[stride + k] - solver.state[k]
            for j in range(s):
                total += coarse.at_end[j] * a[j * stride + k]
        found[k] = total
    for k in range(0, stride, WIDTH):
        size = larger(size, as_rows(found)[k] * scale[k])
    return largest(size)


@routine()
def compare(system: System, solver: MotionSolver, coarse: Stages, allowed: float) -> None:
    """Iterate on the double step until its corrections show its difference from the pair, or are far below the allowed.

    A kept tangent that shows too large a difference is replaced. Where iterations on a step of this size diverge, the
    first correction with a tangent of the pair shows the size of the difference.
    """
    small_code()
    own, fresh, done = coarse.routines, 1 if coarse.factored == 0 else 0, 0
    while done == 0:
        own.predict(system, solver, coarse, 2, 0)
        if fresh != 0:
            coarse.factored = own.factorise(system, solver, coarse, 2) > 0.0
            solver.statistics.tangents += 1
        size, first, rate, iteration = 0.0, 0.0, 1.0 if fresh != 0 else coarse.rate, 0
        while done == 0:
            coarse.iteration = iteration
            for i in range(coarse.stages):
                own.residual(system, solver, coarse, 2, i)
            own.solve(solver, coarse)
            before, size = size, own.correct(solver, coarse)
            solver.statistics.iterations += 1
            first = size if iteration == 0 else first
            if iteration > 0:
                rate = size / before if before > 0.0 else 0.0
                coarse.rate, coarse.factored = rate, rate <= _USELESS
            iteration += 1
            if not rate <= _USELESS and iteration > 1:
                break
            small = size <= _LINEAR * allowed or rate * size <= _LINEAR * first
            done = 1 if small or iteration == _MOST else 0
        if done == 0 and fresh != 0:
            for k in range(coarse.stages * coarse.height):
                coarse.planes[k] = -coarse.planes[k]
            own.correct(solver, coarse)
            done = 1
        elif fresh == 0 and not first <= allowed:
            done = 0
        fresh = 1


@routine()
def take_pair(system: System, solver: MotionSolver, doubled: Doubled, h: float) -> float:
    """Take two steps, and one of double size; return the difference, negative if they do not converge."""
    small_code()
    fine, coarse, samples, n = doubled.fine, doubled.coarse, doubled.fine.samples, solver.size
    allowed = max(2.0 * h * doubled.rate, _ROUND_OFF)
    # their error in a position is one in the velocity besides, in as many steps as there are
    fine.accuracy = max(_ITERATED * allowed * h / doubled.duration, _FINEST)
    for step in range(3):
        begin, size = doubled.time + step % 2 * h, 2.0 * h if step == 2 else h
        for i in range(samples):
            solver.times[step * samples + i] = begin + size * doubled.shares[i]
    if doubled.varies != 0:
        doubled.routines.sample(solver)
    for row in range(3):
        for k in range(n):
            coarse.begin[row * coarse.stride + k] = solver.state[row * n + k]
    for step in range(2):
        ratio = h / doubled.before if step == 0 and doubled.before > 0.0 else 1.0
        if ratio != doubled.ratio:
            doubled.routines.look_ahead(fine, doubled, ratio)
            doubled.ratio = ratio
        start_step(solver, fine)
        if solve_step(system, solver, fine, step) == 0:
            return -1.0
        fine.routines.complete(system, solver, fine, step)
        end_step(system, solver, fine, doubled.filled + step)
        _gather(doubled, step)
        doubled.ends[doubled.filled + step + 1] = doubled.time + (step + 1) * h
    solver.kept_directions = doubled.coarse_directions
    doubled.routines.compare(system, solver, coarse, doubled.divisor * allowed)
    solver.kept_directions = doubled.fine_directions
    return doubled.routines.difference(solver, doubled)


@routine()
def march_doubled(system: System, solver: MotionSolver, doubled: Doubled) -> None:
    """March through pairs of steps from `state`, advanced in place, to the end or until there is no room for rows."""
    small_code()
    fine, coarse, n, growth = doubled.fine, doubled.coarse, solver.size, _LARGEST
    while doubled.filled + 2 <= doubled.room and doubled.time < doubled.end:
        left = doubled.end - doubled.time
        h = min(doubled.step, doubled.longest)
        last = 1 if left <= 2.002 * h else 0
        if last != 0:
            h = 0.5 * left
        elif left < 4.0 * h:
            h = 0.25 * left
        if h != fine.time_step:
            doubled.routines.resize(fine, doubled, h)
        if 2.0 * h != coarse.time_step:
            doubled.routines.resize(coarse, doubled, 2.0 * h)
            for i in range(coarse.stages):
                for j in range(coarse.stages + 1):
                    coarse.ahead[i * (coarse.stages + 1) + j] = 1.0 if i == j else 0.0
            coarse.known = 1
        for k in range(4 * n):
            doubled.at_begin[k] = solver.state[k]
        for k in range(solver.rotation_count):
            doubled.turned[k] = solver.rotated_by[k]
        found = doubled.routines.take_pair(system, solver, doubled, h)
        error, allowed = found / doubled.divisor, max(2.0 * h * doubled.rate, _ROUND_OFF)
        ratio = error / allowed
        best = _SAFETY * h / max(ratio, 1e-6) ** doubled.power
        # a stiff vibration that a step damps is an error once: resolved, it would keep all further steps as short;
        # steps do not resolve it, so that all of the difference is the error, and so it may be in the first steps
        made = error if error <= allowed and doubled.before > 0.0 else found
        if not 0.0 <= made <= allowed + doubled.saved:
            for k in range(4 * n):
                solver.state[k] = doubled.at_begin[k]
            for k in range(solver.rotation_count):
                solver.rotated_by[k] = doubled.turned[k]
            doubled.refused, growth = doubled.refused + 1, 1.0
            fine.known = 0
            doubled.step = max(best, _SMALLEST * h) if ratio > 1.0 else _SHORTER * h
            if doubled.step < doubled.shortest:
                doubled.failed = 1
                return
            continue
        doubled.saved = min(doubled.saved + allowed - made, doubled.most_saved)
        doubled.filled, doubled.before = doubled.filled + 2, h
        doubled.time = doubled.end if last != 0 else doubled.time + 2.0 * h
        doubled.ends[doubled.filled] = doubled.time
        if best > _SAME * h or best < h:
            most = min(growth, max(math.sqrt(_FAST / max(fine.rate, 1e-4)), 1.0)) * h
            doubled.step = min(max(best, _SMALLEST * h), most)
        growth = min(_RECOVERED * growth, _LARGEST)
