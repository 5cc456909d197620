"""Time steps of the generalized-alpha method, many in one compiled call."""

from beamfem.kernels import motion_record as m
from beamfem.kernels import motion_steps
from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.motion_steps import RATIO
from beamfem.kernels.pointers import at, caller, reals, small_code, wholes

_constrain, _predict, _jacobian, _count = caller("iiirnr"), caller("iii"), caller("i", "d"), caller("inrrr")
_stage = caller("iii", "d")
_check_convergence = inlined(motion_steps.check_convergence)


@inlined
def _predict_resultants(s, b, call, system):
    """Keep the resultants that a correction leads to, for the geometric part of the next tangent."""
    groups, free, right = wholes(s[r.GROUP_RECORDS]), wholes(b[r.FREE_DOFS]), reals(b[r.RIGHT])
    change, velocity, acceleration = reals(b[r.CHANGE]), s[r.COORDINATES_V], s[r.COORDINATES_A]
    for i in range(b[r.UNKNOWN]):
        change[free[i]] = right[i]
    s[r.COORDINATES_V] = b[r.CHANGE]
    s[r.COORDINATES_A] = velocity
    for group in range(s[r.GROUPS]):
        _predict(call[r.PREDICT_RESULTANTS], groups[group], system, 1)
    s[r.COORDINATES_V] = velocity
    s[r.COORDINATES_A] = acceleration


@inlined
def _is_inside_out(s, call):
    """Return whether the last state has r0' x d <= 0 at a quadrature point: no motion leads there."""
    groups, smallest = wholes(s[r.GROUP_RECORDS]), 1.0
    for group in range(s[r.GROUPS]):
        smallest = min(smallest, _jacobian(call[r.SMALLEST_JACOBIAN], groups[group]))
    return not smallest > 0.0


@routine("iii", "i")
def march(system, solver, calls):
    """March through `STEPS` steps; return how many were completed.

    `STATE`: p, p', p'', auxiliary acceleration (4, n), advanced in place. `RULE`, `LIMITS`, `STATISTICS`: see
    `motion_record`. `ROWS`: the last tangent, or its factors.

    Chung and Hulbert 1993; in the form of Arnold and Bruels 2007 the equations hold at the end of each step. Iterations
    keep the tangent, over steps as well, rotated with the sections, and end when the estimated error is small (Hairer
    and Wanner 1996, IV.8). If that fails, the step is repeated with a new tangent for each iterate and independent
    stresses (see `model_passes.predict_resultants`). It then starts from the previous acceleration or the previous
    positions, first from those that were nearer in the last step.
    """
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    n, unknown, half, fixed = s[r.SIZE], b[r.UNKNOWN], b[r.HALF], b[r.PRESCRIBED]
    rows, state, before = reals(b[r.ROWS]), reals(b[r.STATE]), reals(b[r.BEFORE])
    rule, limits, statistics, factors, space = (
        reals(b[r.RULE]),
        reals(b[r.LIMITS]),
        reals(b[r.STATISTICS]),
        reals(s[r.FACTORS]),
        reals(b[r.STEP]),
    )
    groups, bodies, values, load_values, naturals = (
        wholes(s[r.GROUP_RECORDS]),
        b[r.BODIES],
        wholes(s[r.VALUES]),
        wholes(b[r.LOAD_VALUES]),
        wholes(b[r.NATURALS]),
    )
    saved, every, rotated_by, saved_rotations = (
        reals(b[r.SAVED]),
        b[r.EVERY],
        reals(b[r.ROTATED_BY]),
        reals(b[r.SAVED_ROTATIONS]),
    )
    for step in range(b[r.STEPS]):
        s[r.BODY] = bodies + 8 * step * b[r.BODY_STRIDE]
        for group in range(s[r.GROUPS]):
            loads = wholes(groups[group])[r.LOADS]
            values[group] = load_values[group] + (24 * step * loads if b[r.LOADS_VARY] != 0 else 0)
            if b[r.NATURALS_VARY] != 0 and naturals[group] != 0:
                record = wholes(groups[group])
                strains = record[r.ELEMENTS] * record[r.POINTS] * record[r.MEASURES]
                record[r.NATURAL] = naturals[group] + 8 * step * strains
        b[r.NOW] = step
        b[r.PRESCRIBED_NOW] = b[r.PRESCRIBED_VALUES] + 24 * fixed * step
        rule[m.ORDER] = statistics[m.BEST_ORDER]
        _stage(call[r.PREDICT], system, solver, calls)
        size, first_size, iteration, far = 0.0, 0.0, 0, 0
        full, fresh, done = 0, statistics[m.RATE] < 0.0, 0
        rate = at(space, n)
        rate[RATIO] = max(statistics[m.RATE], motion_steps.SMALLEST_RATE) ** 0.8 if not fresh else 1.0
        while iteration < limits[m.NEWTON_ITERATIONS]:
            renew = full != 0 or fresh
            s[r.TANGENT], s[r.PREDICTED] = renew, full != 0 and iteration > 0
            b[r.ROTATIONS_WANTED] = iteration == 0 or renew
            _stage(call[r.ASSEMBLE], system, solver, calls)
            if renew:
                if b[r.ROLLERS] > 0:
                    first_of, normal = wholes(b[r.ROLLER_FIRST]), reals(b[r.ROLLER_NORMAL])
                    _constrain(call[r.CONSTRAIN_NORMALS], unknown, half, b[r.ROLLERS], rows, first_of, normal)
                pivots = _stage(call[r.FACTORISE], system, solver, calls)
                statistics[m.PIVOT_RATIO] = min(statistics[m.PIVOT_RATIO], pivots)
                statistics[m.TANGENTS] += 1.0
            _stage(call[r.SOLVE], system, solver, calls)
            if full != 0:
                _predict_resultants(s, b, call, system)
            last, size = size, _stage(call[r.CORRECT], system, solver, calls)
            iteration += 1
            statistics[m.ITERATIONS] += 1.0
            statistics[m.CORRECTION] = size
            if iteration == 1:
                first_size = max(size, statistics[m.CHANGE])
                far = 1 if size > motion_steps.FAR else 0
            new_tangent = 1 if renew else 0
            done = _check_convergence(
                iteration,
                full,
                new_tangent,
                far,
                size,
                last,
                first_size,
                limits[m.TOLERANCE],
                rate,
                at(statistics, m.NOISE),
            )
            if (
                done == motion_steps.CONVERGED
                and (full != 0 or first_size > motion_steps.FAR)
                and _is_inside_out(s, call)
            ):
                done = motion_steps.DIVERGED
            fresh = done == motion_steps.RENEW
            if done == motion_steps.CONVERGED:
                break
            if fresh:
                done = 0
                continue
            if full == 0:
                converges = iteration < limits[m.KEPT_TANGENT_ITERATIONS] and (iteration < 2 or rate[RATIO] < 0.5)
                fails = done < 0 or not converges
            else:
                fails = done < 0 or not iteration < limits[m.NEWTON_ITERATIONS]
            if fails and full == 2:
                break
            if fails:
                for i in range(4 * n):
                    state[i] = before[i]
                # of the first step nothing is known
                stays = statistics[m.BEST_ORDER] < 0.0 or statistics[m.KNOWN_DIFFERENCES] == 0.0
                rule[m.ORDER] = -1.0 if stays == (full == 0) else 0.0
                _stage(call[r.PREDICT], system, solver, calls)
                full, iteration = full + 1, 0
        statistics[m.MOST_ITERATIONS] = max(statistics[m.MOST_ITERATIONS], iteration)
        slow = iteration > limits[m.MANY_ITERATIONS] or (iteration > 1 and rate[RATIO] > limits[m.SLOW_RATE])
        statistics[m.RATE] = -1.0 if slow else rate[RATIO]
        if done <= 0:
            for i in range(4 * n):
                state[i] = before[i]
            return step
        statistics[m.CHANGE] = _stage(call[r.COMPLETE], system, solver, calls) / factors[r.WEIGHT_A]
        _count(call[r.COUNT_ROTATIONS], b[r.ROTATION_COUNT], wholes(b[r.ROTATION_TABLE]), before, state, rotated_by)
        if (b[r.FIRST_STEP] + step) % every == 0:
            row = (b[r.FIRST_STEP] + step) // every
            to = at(saved, 3 * n * row)
            for i in range(3 * n):
                to[i] = state[i]
            for i in range(b[r.ROTATION_COUNT]):
                saved_rotations[row * b[r.ROTATION_COUNT] + i] = rotated_by[i]
    return b[r.STEPS]
