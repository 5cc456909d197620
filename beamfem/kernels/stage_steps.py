"""Time steps of collocation methods, many in one compiled call: simplified Newton iterations on all stages.

In the eigenvectors of A they need one linear system of the size of the model for each real eigenvalue and each complex
pair (Hairer and Wanner 1996, IV.8). Tangents are kept, rotated with the sections at the middle stage, while iterations
converge fast.
"""

import math

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import System
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, zeros
from beamfem.kernels.stage_record import Stages
from beamfem.kernels.time_loop import load_row, remember, save_end

_ITERATIONS = 15
_SLOW = 0.8  # rate of convergence above which an iteration is given up
_RENEWED, _RENEWALS = 0.5, 3  # rate above which a tangent is formed at the stages reached, and how often
_LARGEST = 1e3  # of the model: a larger correction means divergence
_COARSEST = 1e-10  # of the model: error of an iteration at most, and size below which corrections may be round-off
_FINEST = 1e-16
_SMALLEST_RATE = 0.01  # of convergence: a smaller one is chance, as the next correction may be in other directions
_SHARE = 1e-3  # of the estimated error of the step


@inlined
def place(solver, stages, i):
    """Set p, p' and p'' of the prescribed coordinates at a stage."""
    stride, dofs, values, count = stages.stride, solver.prescribed_dofs, solver.prescribed_now, solver.prescribed
    p, v, a = at(stages.p, i * stride), at(stages.v, i * stride), at(stages.a, i * stride)
    for k in range(count):
        p[dofs[k]], v[dofs[k]], a[dofs[k]] = values[k], values[count + k], values[2 * count + k]


@routine(fastmath=FAST)
def predict(system: System, solver: MotionSolver, stages: Stages, step: int, attempt: int) -> None:
    """Fill p, p' and p'' of the stages to begin iterations with.

    Accelerations are those of the polynomial through the last stages and the beginning, if they are known, else that of
    the beginning; 0 in the last attempt (2), for vibrations that steps do not resolve, whose accelerations say nothing
    of the next step. Of multipliers, the same polynomial gives p.
    """
    s, stride, begin = stages.stages, stages.stride, stages.begin
    now, last, h, nodes = as_rows(begin), as_rows(stages.last), stages.time_step, stages.nodes
    p, v, a = as_rows(stages.p), as_rows(stages.v), as_rows(stages.a)
    for i in range(solver.conditions):
        begin[2 * stride + solver.multipliers[i]] = begin[solver.multipliers[i]]
    for k in range(0, stride, WIDTH):
        for i in range(s):
            ahead, total = at(stages.ahead, i * (s + 1)), zeros()
            if attempt < 2 and stages.known != 0:
                total = ahead[s] * now[2 * stride + k]
                for j in range(s):
                    total += ahead[j] * last[j * stride + k]
            elif attempt < 2:
                total = zeros() + now[2 * stride + k]
            a[i * stride + k] = total
    if attempt < 2:
        for number in range(solver.conditions):
            own, start = at(stages.a, solver.multipliers[number]), begin[solver.multipliers[number]]
            changes = stages.planes
            for i in range(s):
                changes[i] = own[i * stride] - start
            for i in range(s):
                total_of_one = 0.0
                for j in range(s):
                    total_of_one += stages.to_accelerations[i * s + j] * changes[j]
                own[i * stride] = total_of_one / (h * h)
    for roller in range(solver.rollers):  # round-off along a normal is not corrected, and grows if it is extrapolated
        x, y = solver.free_dofs[solver.roller_first[roller]], solver.free_dofs[solver.roller_first[roller] + 1]
        c, d = solver.roller_normal[2 * roller], solver.roller_normal[2 * roller + 1]
        for i in range(s):
            of_stage = at(stages.a, i * stride)
            along = c * of_stage[x] + d * of_stage[y]
            of_stage[x] -= along * c
            of_stage[y] -= along * d
    for i in range(solver.conditions):
        begin[2 * stride + solver.multipliers[i]] = 0.0
    for k in range(0, stride, WIDTH):
        for i in range(s):
            at_p, at_v = now[k] + h * nodes[i] * now[stride + k], zeros() + now[stride + k]
            at_p += stages.of_begin[2 * i] * now[2 * stride + k]
            at_v += stages.of_begin[2 * i + 1] * now[2 * stride + k]
            for j in range(s):
                at_p += stages.of_p[i * s + j] * a[j * stride + k]
                at_v += stages.of_v[i * s + j] * a[j * stride + k]
            p[i * stride + k], v[i * stride + k] = at_p, at_v
    for i in range(s):
        load_row(system, solver, step * stages.samples + i)
        place(solver, stages, i)


@inlined
def _take(system, stages, i):
    """Take a stage as the state of the model."""
    offset = i * stages.stride
    system.p, system.v, system.a = at(stages.p, offset), at(stages.v, offset), at(stages.a, offset)
    system.since_committed = stages.nodes[i] * stages.time_step


@routine()
def residual(system: System, solver: MotionSolver, stages: Stages, step: int, i: int) -> None:
    """Fill the right-hand side of a stage with the residual of the unknown coordinates, negative."""
    load_row(system, solver, step * stages.samples + i)
    _take(system, stages, i)
    system.tangent, solver.rotations_wanted = 0, stages.iteration == 0
    usual, solver.rotations = solver.rotations, at(stages.rotations, i * 2 * solver.node_stride)
    solver.routines.assemble(system, solver)
    solver.rotations = usual
    right, kept = at(stages.right, i * stages.height), at(stages.forces, i * stages.height)
    forces, free = system.residual, solver.free_dofs
    for k in range(solver.unknown):
        right[k] = kept[k] = -forces[free[k]]


@routine()
def factorise(system: System, solver: MotionSolver, stages: Stages, step: int) -> float:
    """Factorise the tangents at the middle stage; return the smallest ratio of a pivot to its diagonal entry."""
    small_code()
    middle, entries = stages.stages // 2, stages.entries
    load_row(system, solver, step * stages.samples + middle)
    _take(system, stages, middle)
    system.tangent = 1
    for plane in range(stages.stages):
        system.matrix, solver.rotations_wanted = at(stages.matrices, plane * entries), plane == 0
        weights = at(stages.weights, 3 * plane)
        system.weight_p, system.weight_v, system.weight_a = weights[0], weights[1], weights[2]
        solver.routines.assemble(system, solver)
    return stages.routines.factor_planes(solver, stages)


@inlined
def _constrain(solver, rows):
    """Constrain the normals of inclined rollers in a matrix."""
    if solver.rollers > 0:
        first_of, normal = solver.roller_first, solver.roller_normal
        solver.routines.constrain_normals(solver.unknown, solver.half, solver.rollers, rows, first_of, normal)


@routine()
def factor_planes(solver: MotionSolver, stages: Stages) -> float:
    """Factorise the matrices of all planes, without the normals of inclined rollers."""
    small_code()
    for plane in range(stages.stages):
        _constrain(solver, at(stages.matrices, plane * stages.entries))
    ratio, n, half, reach, space, entries = 1.0, solver.unknown, solver.half, solver.reach, solver.step, stages.entries
    for plane in range(stages.real):
        rows = at(stages.matrices, plane * entries)
        ratio = min(ratio, solver.routines.factor(n, half, reach, rows, space))
    for plane in range(stages.real, stages.stages, 2):
        re, im = at(stages.matrices, plane * entries), at(stages.matrices, (plane + 1) * entries)
        ratio = min(ratio, stages.routines.factor_complex(n, half, reach, re, im, space))
    return ratio


@inlined
def _rotate(solver, stages, sense):
    """Rotate vectors of each stage with their sections there, see `motion_steps.rotate_pairs`."""
    count, runs, stride = solver.pair_run_count, solver.pair_runs, solver.node_stride
    for i in range(stages.stages):
        rotations, right = at(stages.rotations, i * 2 * stride), at(stages.right, i * stages.height)
        solver.routines.rotate_pairs(count, sense, runs, stride, rotations, right)


@inlined
def _combine(stages, factors, source, target):
    """Fill rows (s, height) with combinations of others."""
    s, height, rows, combined = stages.stages, stages.height, as_rows(source), as_rows(target)
    for k in range(0, height, WIDTH):
        for i in range(s):
            total = zeros()
            for j in range(s):
                total += factors[i * s + j] * rows[j * height + k]
            combined[i * height + k] = total


@routine(fastmath=FAST)
def solve(solver: MotionSolver, stages: Stages) -> None:
    """Fill the planes with corrections of the accelerations of the stages.

    The stiffness of a stage acts on its own p: so the corrections of p are rotated, not those of p''.
    """
    call, rollers, first_of, normal = solver.routines, solver.rollers, solver.roller_first, solver.roller_normal
    for i in range(stages.stages):
        call.rotate_in(rollers, first_of, normal, at(stages.right, i * stages.height))
    _rotate(solver, stages, -1.0)
    _combine(stages, stages.into, stages.right, stages.planes)
    stages.routines.solve_planes(solver, stages)
    _combine(stages, stages.back, stages.planes, stages.right)
    _rotate(solver, stages, 1.0)
    for i in range(stages.stages):
        call.rotate_back(rollers, first_of, normal, at(stages.right, i * stages.height))
    _combine(stages, stages.to_accelerations, stages.right, stages.planes)


@routine()
def solve_planes(solver: MotionSolver, stages: Stages) -> None:
    """Solve for the right-hand side of each plane, or pair of planes."""
    small_code()
    n, half, entries, height, planes = solver.unknown, solver.half, stages.entries, stages.height, stages.planes
    for plane in range(stages.real):
        solver.routines.solve_both(n, half, at(stages.matrices, plane * entries), at(planes, plane * height))
    for plane in range(stages.real, stages.stages, 2):
        re, im = at(stages.matrices, plane * entries), at(stages.matrices, (plane + 1) * entries)
        stages.routines.solve_complex(n, half, re, im, at(planes, plane * height), at(planes, (plane + 1) * height))


@inlined
def _work(stages, unknown):
    """Return the work of the forces out of balance on the corrections of all stages."""
    s, height, total = stages.stages, stages.height, 0.0
    for i in range(s):
        for j in range(s):
            own, found, work = at(stages.forces, i * height), at(stages.planes, j * height), 0.0
            for k in range(unknown):
                work += own[k] * found[k]
            total += stages.of_p[i * s + j] * work
    return total


@routine(fastmath=FAST)
def correct(solver: MotionSolver, stages: Stages) -> float:
    """Add corrections to the stages; return the largest change of p, relative to its scale."""
    s, stride, unknown, free = stages.stages, stages.stride, solver.unknown, solver.free_dofs
    for i in range(s):
        found, change = at(stages.planes, i * stages.height), at(stages.change, i * stride)
        for k in range(unknown):
            change[free[k]] = found[k]
    stages.work = _work(stages, unknown) if stages.per_work > 0.0 else 0.0
    changes, p, v, a = as_rows(stages.change), as_rows(stages.p), as_rows(stages.v), as_rows(stages.a)
    scale, size = as_rows(solver.inverse_scale), zeros()
    for k in range(0, stride, WIDTH):
        for i in range(s):
            of_p, of_v = zeros(), zeros()
            for j in range(s):
                of_p += stages.of_p[i * s + j] * changes[j * stride + k]
                of_v += stages.of_v[i * s + j] * changes[j * stride + k]
            size = larger(size, of_p * scale[k])
            p[i * stride + k] += of_p
            v[i * stride + k] += of_v
            a[i * stride + k] += changes[i * stride + k]
    return largest(size)


@routine()
def accelerate(system: System, solver: MotionSolver, stages: Stages) -> None:
    """Set p'' in the state reached to that of the equations; it has that of prescribed coordinates, and else zeros."""
    small_code()
    n, unknown, free, state = solver.size, solver.unknown, solver.free_dofs, solver.state
    right, rows = stages.right, solver.rows
    system.p, system.v, system.a, system.matrix = state, at(state, n), at(state, 2 * n), rows
    system.weight_p, system.weight_v, system.weight_a, system.since_committed = 0.0, 0.0, 1.0, stages.elapsed
    system.tangent, solver.rotations_wanted = 1, 0
    solver.routines.assemble(system, solver)
    for k in range(unknown):
        right[k] = -system.residual[free[k]]
    call, rollers, first_of, normal = solver.routines, solver.rollers, solver.roller_first, solver.roller_normal
    _constrain(solver, rows)
    call.factor(unknown, solver.half, solver.reach, rows, solver.step)
    call.rotate_in(rollers, first_of, normal, right)
    call.solve_both(unknown, solver.half, rows, right)
    call.rotate_back(rollers, first_of, normal, right)
    for k in range(unknown):
        state[2 * n + free[k]] = right[k]


@routine()
def complete(system: System, solver: MotionSolver, stages: Stages, step: int) -> None:
    """Set the state to that at the end of the step, and keep the accelerations of its stages."""
    s, n, stride, state, h = stages.stages, solver.size, stages.stride, solver.state, stages.time_step
    begin, a, at_end, last = stages.begin, stages.a, stages.at_end, stages.last
    for k in range(s * stride):
        last[k] = a[k]
    for i in range(s):
        for k in range(solver.conditions):
            last[i * stride + solver.multipliers[k]] = stages.p[i * stride + solver.multipliers[k]]
    if stages.samples == s:  # the last stage is the end
        offset = (s - 1) * stride
        for k in range(n):
            state[k], state[n + k], state[2 * n + k] = stages.p[offset + k], stages.v[offset + k], a[offset + k]
    else:
        for k in range(n):
            p, v, acceleration = begin[k] + h * begin[stride + k], begin[stride + k], 0.0
            for j in range(s):
                p += at_end[j] * a[j * stride + k]
                v += at_end[s + j] * a[j * stride + k]
                acceleration += at_end[2 * s + j] * a[j * stride + k]
            state[k], state[n + k], state[2 * n + k] = p, v, acceleration
        load_row(system, solver, step * stages.samples + s)
        for k in range(solver.unknown):
            state[2 * n + solver.free_dofs[k]] = 0.0
        dofs, values, count = solver.prescribed_dofs, solver.prescribed_now, solver.prescribed
        for k in range(count):
            for row in range(3):
                state[row * n + dofs[k]] = values[row * count + k]
        stages.routines.accelerate(system, solver, stages)
    for i in range(solver.conditions):
        state[n + solver.multipliers[i]] = 0.0  # multipliers have no rates
        state[2 * n + solver.multipliers[i]] = 0.0
    for k in range(n):
        state[3 * n + k] = state[2 * n + k]


@routine()
def iterate(system: System, solver: MotionSolver, stages: Stages, step: int, fresh: int) -> int:
    """Iterate from the stages predicted; return whether they converge.

    Iterations end where their estimated error is a share of that of the step, or where corrections are round-off. Where
    an accuracy is given, the energy of a correction, as a velocity, may move the model in a step by no more than it.
    """
    small_code()
    own, statistics, size, tolerance, ratio = stages.routines, solver.statistics, 0.0, _FINEST, 1.0
    rate = 1.0 if fresh != 0 else max(stages.rate, _SMALLEST_RATE) ** 0.8
    renewals, corrections = 0, 0  # with the same tangent
    for iteration in range(_ITERATIONS):
        stages.iteration = corrections
        for i in range(stages.stages):
            own.residual(system, solver, stages, step, i)
        own.solve(solver, stages)
        before, size = size, own.correct(solver, stages)
        statistics.iterations += 1
        statistics.correction = size
        if not size < _LARGEST:
            return 0
        if size == 0.0:  # at rest
            return 1
        if stages.accuracy > 0.0:
            tolerance = stages.accuracy
        elif iteration == 0 and stages.known != 0:
            estimated = stages.error_factor * size**stages.error_power
            tolerance = min(max(_SHARE * estimated, _FINEST), _COARSEST)
        corrections += 1
        if corrections > 1:
            last, ratio = ratio, max(size / before, _SMALLEST_RATE)
            rate = ratio if corrections == 2 else math.sqrt(last * ratio)  # of two, as errors may turn
            if rate > _RENEWED and renewals < _RENEWALS and size > _COARSEST:
                own.factorise(system, solver, stages, step)
                statistics.tangents += 1
                renewals, corrections, rate = renewals + 1, 0, 1.0
                continue
            if rate > _SLOW:
                if size > _COARSEST or (fresh == 0 and size > statistics.noise):
                    return 0
                statistics.noise = max(statistics.noise, 2.0 * before)
                return 1
        # stiff vibrations that a correction excites move the model by their velocity, far more than the correction does
        excited = stages.time_step * math.sqrt(abs(stages.work) * stages.per_work)
        if rate < 1.0 and rate * max(size, excited) <= (1.0 - rate) * tolerance:
            if corrections > 1:
                stages.rate = rate
                stages.factored = rate <= stages.kept_rate
            return 1
    return 0


@inlined
def start_step(solver, stages):
    """Keep the state, and hand p, p' and p'' to the step that begins."""
    n, state, before, begin = solver.size, solver.state, solver.before, stages.begin
    for k in range(4 * n):
        before[k] = state[k]
    for row in range(3):
        for k in range(n):
            begin[row * stages.stride + k] = state[row * n + k]


@inlined
def end_step(system, solver, stages, step):
    """Save the end of a step, whose accelerations are known from now on."""
    stages.known = 1
    remember(system, solver)
    save_end(solver, step)


@inlined
def solve_step(system, solver, stages, step):
    """Solve for the stages of a step; return whether that succeeds."""
    own, statistics, attempt, done = stages.routines, solver.statistics, 0, stages.solved
    while done == 0 and attempt < 3:
        own.predict(system, solver, stages, step, attempt)
        fresh = 1 if attempt > 0 or stages.factored == 0 else 0
        if fresh != 0:
            attempt = max(attempt, 1)
            ratio = own.factorise(system, solver, stages, step)
            stages.factored = ratio > 0.0
            statistics.pivot_ratio = min(statistics.pivot_ratio, ratio)
            statistics.tangents += 1
        if stages.factored != 0:
            done = own.iterate(system, solver, stages, step, fresh)
        attempt += 1
    return done


@routine()
def march_stages(system: System, solver: MotionSolver, stages: Stages) -> int:
    """March through steps from `state`, advanced in place; return how many were completed."""
    small_code()
    own = stages.routines
    for step in range(stages.first, stages.steps):
        start_step(solver, stages)
        done = solve_step(system, solver, stages, step)
        if done == 0:
            stages.factored = 0
            return step
        stages.solved = 0
        own.complete(system, solver, stages, step)
        end_step(system, solver, stages, step)
    return stages.steps
