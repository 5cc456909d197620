"""Time steps of the generalized-alpha method, many in one compiled call."""

from beamfem.kernels import motion_steps
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import System
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.motion_steps import RATIO
from beamfem.kernels.pointers import at, given, small_code

_check_convergence = inlined(motion_steps.check_convergence)


@inlined
def _predict_resultants(system, solver):
    """Keep the resultants that a correction leads to, for the geometric part of the next tangent."""
    free, right, change, velocity, acceleration = solver.free_dofs, solver.right, solver.change, system.v, system.a
    for i in range(solver.unknown):
        change[free[i]] = right[i]
    system.v, system.a = change, velocity
    for group in range(system.group_count):
        solver.routines.predict_resultants(system.groups[group], system, 1)
    system.v, system.a = velocity, acceleration


@inlined
def _jumps_inside_out(system, solver):
    """Return whether a long step ends with r0' x d <= 0 at a quadrature point; motions of soft beams do lead there."""
    smallest, moved, state, before = 1.0, 0.0, solver.state, solver.before
    for i in range(system.size):
        moved = max(moved, abs(state[i] - before[i]) * solver.inverse_scale[i])
    if not moved > motion_steps.FAR:
        return False
    for group in range(system.group_count):
        smallest = min(smallest, solver.routines.smallest_jacobian(system.groups[group]))
    return not smallest > 0.0


@inlined
def load_row(system, solver, row):
    """Take the loads, imposed strains and values of prescribed coordinates of a row, which is a step or a stage."""
    solver.now, system.time = row, solver.times[row]
    solver.prescribed_now = at(solver.prescribed_values, 3 * solver.prescribed * row)
    row = row if solver.varies != 0 else 0
    system.body = at(solver.bodies, row * solver.body_size)
    for number in range(system.group_count):
        group = system.groups[number]
        group.values = at(group.values_of_steps, 3 * row * group.stations)
        if given(group.natural_of_steps):
            strains = group.elements * group.points * group.measures
            group.natural = at(group.natural_of_steps, row * strains)


@inlined
def remember(system, solver):
    """Replace the history variables of compiled parts by those after a step to the state."""
    if solver.remembers != 0:
        system.p, system.v, system.a = solver.state, at(solver.state, solver.size), at(solver.state, 2 * solver.size)
        for kind in range(system.part_kinds):
            parts = system.parts[kind]
            if parts.history_size > 0:
                parts.commit(parts, system)


@inlined
def save_end(solver, step):
    """Count rotations in a step, and save its end if it is wanted."""
    n, state, count = solver.size, solver.state, solver.rotation_count
    solver.routines.count_rotations(count, solver.rotation_table, solver.before, state, solver.rotated_by)
    if (solver.first_step + step) % solver.every == 0:
        row = (solver.first_step + step) // solver.every
        to = at(solver.saved, 3 * n * row)
        for k in range(3 * n):
            to[k] = state[k]
        for k in range(count):
            solver.saved_rotations[row * count + k] = solver.rotated_by[k]


@routine()
def march(system: System, solver: MotionSolver) -> int:
    """March through `steps` steps from `state`, advanced in place; return how many were completed.

    `rows`: the last tangent, or its factors.

    Chung and Hulbert 1993; in the form of Arnold and Bruels 2007 the equations hold at the end of each step. Iterations
    keep the tangent, over steps as well, rotated with the sections, and end when the estimated error is small (Hairer
    and Wanner 1996, IV.8). If that fails, the step is repeated with a new tangent for each iterate and independent
    stresses (see `model_passes.predict_resultants`). It then starts from the previous acceleration or the previous
    positions, first from those that were nearer in the last step.
    """
    small_code()
    call = solver.routines
    n, state, before = system.size, solver.state, solver.before
    rule, limits, statistics = solver.rule, solver.limits, solver.statistics
    for step in range(solver.steps):
        load_row(system, solver, step)
        rule.order = statistics.best_order
        call.predict(solver)
        size, first_size, iteration, far = 0.0, 0.0, 0, 0
        full, fresh, done = 0, statistics.rate < 0.0, 0
        rate = at(solver.step, n)
        rate[RATIO] = max(statistics.rate, motion_steps.SMALLEST_RATE) ** 0.8 if not fresh else 1.0
        while iteration < limits.iterations:
            renew = full != 0 or fresh
            system.tangent, system.predicted = renew, full != 0 and iteration > 0
            solver.rotations_wanted = iteration == 0 or renew
            call.assemble(system, solver)
            if renew:
                if solver.rollers > 0:
                    first_of, normal = solver.roller_first, solver.roller_normal
                    call.constrain_normals(solver.unknown, solver.half, solver.rollers, solver.rows, first_of, normal)
                pivots = call.factorise(system, solver)
                statistics.pivot_ratio = min(statistics.pivot_ratio, pivots)
                statistics.tangents += 1
                statistics.spent, statistics.lived = limits.tangent, 0
            call.solve(system, solver)
            if full != 0:
                _predict_resultants(system, solver)
            last, size = size, call.correct(system, solver)
            iteration += 1
            statistics.iterations += 1
            statistics.correction = size
            if iteration == 1:
                first_size = max(size, statistics.change)
                far = 1 if size > motion_steps.FAR else 0
            new_tangent = 1 if renew else 0
            done = _check_convergence(
                iteration, full, new_tangent, far, size, last, first_size, limits.tolerance, rate, statistics
            )
            if (
                done == motion_steps.CONVERGED
                and (full != 0 or first_size > motion_steps.FAR)
                and _jumps_inside_out(system, solver)
            ):
                done = motion_steps.DIVERGED
            fresh = done == motion_steps.RENEW
            if done == motion_steps.CONVERGED:
                break
            if fresh:
                done = 0
                continue
            if full == 0:
                converges = iteration < limits.most and (iteration < 2 or rate[RATIO] < 0.5)
                fails = done < 0 or not converges
            else:
                fails = done < 0 or not iteration < limits.iterations
            if fails and full == 2:
                break
            if fails:
                for i in range(4 * n):
                    state[i] = before[i]
                # of the first step nothing is known
                stays = statistics.best_order < 0.0 or statistics.known_differences == 0.0
                rule.order = -1.0 if stays == (full == 0) else 0.0
                call.predict(solver)
                full, iteration = full + 1, 0
        statistics.most_iterations = max(statistics.most_iterations, iteration)
        # a tangent has lived long enough when a step takes more than the mean of its steps
        statistics.spent, statistics.lived = statistics.spent + iteration, statistics.lived + 1
        statistics.rate = -1.0 if iteration * statistics.lived > statistics.spent else rate[RATIO]
        if done <= 0:
            for i in range(4 * n):
                state[i] = before[i]
            return step
        statistics.change = call.complete(solver) / system.weight_a
        remember(system, solver)
        save_end(solver, step)
    return solver.steps
