"""Predictor: polynomial extrapolation of the acceleration, with the order that fitted the last step best."""

import math

from beamfem.kernels import rollers
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, where_negative, zeros

FAST = {"contract", "reassoc", "nsz"}
_stay_on_planes = inlined(rollers.stay_on_planes)
MOST = 3  # differences of the acceleration used to extrapolate it; higher ones would amplify noise from step to step


@inlined
def padded(n):
    """Return the length of a row of n numbers, padded to a multiple of the lanes."""
    return (n + WIDTH - 1) // WIDTH * WIDTH


def difference_rows(n: int) -> int:
    """Return the size of the array for the backward differences of n accelerations.

    It contains the differences (MOST, padded(n)) and, for the choice of the order, sums (MOST + 1, WIDTH) of the
    squared errors of the extrapolations of order 0 to MOST.
    """
    return MOST * -(-n // WIDTH) * WIDTH + (MOST + 1) * WIDTH


@inlined
def larger_of(a, b):
    """Return the larger of two non-negative numbers; NaN counts as larger than any number."""
    return b if not b <= a and a == a else a


@inlined
def alternates(difference, higher):
    """Return a negative number if a difference had the other sign a step ago, and at least half its size.

    higher: the next difference, of this one and that of a step ago; both must be known, or zero.
    """
    return difference * (1.5 * difference - higher)


@routine()
def predict(solver: MotionSolver) -> None:
    """Store the state (4, n) in `before` and predict the end of the step; prescribed coordinates take their values.

    The acceleration is extrapolated by a polynomial through the last steps: order 0 keeps it constant, order 1 is
    linear, and so on; order -1 keeps p constant instead, which adds no strain if stiff parts oscillate within a step.
    Where the second difference changed its sign in the last step, as that of parts does whose period is shorter than a
    few steps, the error of orders 1 and 2 is expected to change its sign again.
    """
    small_code()
    n, rule, state, before, differences = solver.size, solver.rule, solver.state, solver.before, solver.differences
    h, alpha_m, alpha_f = rule.time_step, rule.alpha_m, rule.alpha_f
    gamma, beta, order = rule.gamma, rule.beta, rule.order
    kept, mean, fraction = 1.0 / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m), (1.0 - alpha_f) / (1.0 - alpha_m)
    length, lanes, now, then = padded(n), as_rows(differences), as_rows(state), as_rows(before)
    whole = n // WIDTH * WIDTH
    alternating, last = 1.0 <= order < MOST, length * int(order)
    for i in range(0, whole, WIDTH):
        p, v, a, mean_a = now[i], now[n + i], now[2 * n + i], now[3 * n + i]
        then[i], then[n + i], then[2 * n + i], then[3 * n + i] = p, v, a, mean_a
        ahead = zeros()
        for k in range(int(order)):
            ahead += lanes[k * length + i]
        if alternating != 0:
            test = alternates(lanes[length + i], lanes[2 * length + i])
            ahead -= where_negative(test, lanes[last + i], 0.0)
        if order < 0.0:
            ahead = (-(v / h + (0.5 - beta) * mean_a) / beta - kept * a + mean * mean_a) / fraction
        new = kept * a - mean * mean_a + fraction * ahead
        now[i] = p + h * v + h * h * ((0.5 - beta) * mean_a + beta * new)
        now[n + i] = v + h * ((1.0 - gamma) * mean_a + gamma * new)
        now[2 * n + i] = a + ahead
    for i in range(whole, n):
        last_p, last_v, last_a, last_mean = state[i], state[n + i], state[2 * n + i], state[3 * n + i]
        for k in range(4):
            before[k * n + i] = state[k * n + i]
        change = 0.0
        for k in range(int(order)):
            change += differences[k * length + i]
        if alternating != 0:
            sign = alternates(differences[length + i], differences[2 * length + i])
            change -= where_negative(sign, differences[last + i], 0.0)
        if order < 0.0:
            change = (-(last_v / h + (0.5 - beta) * last_mean) / beta - kept * last_a + mean * last_mean) / fraction
        next_a = kept * last_a - mean * last_mean + fraction * change
        state[i] = last_p + h * last_v + h * h * ((0.5 - beta) * last_mean + beta * next_a)
        state[n + i] = last_v + h * ((1.0 - gamma) * last_mean + gamma * next_a)
        state[2 * n + i] = last_a + change
    prescribed, dofs, values = solver.prescribed, solver.prescribed_dofs, solver.prescribed_now
    for i in range(prescribed):
        for k in range(3):
            state[k * n + dofs[i]] = values[k * prescribed + i]
    if solver.rollers > 0:
        first, normal, free = solver.roller_first, solver.roller_normal, solver.free_dofs
        _stay_on_planes(n, solver.rollers, first, normal, free, state, before)


@inlined
def errors_of_orders(second, third, second_before, third_before):
    """Return the errors of the accelerations that orders 1 to 3 predicted, from differences now and a step before."""
    test = alternates(second_before, third_before)
    return (
        second + where_negative(test, second_before, 0.0),
        third + where_negative(test, third_before, 0.0),
        third - third_before,
    )


@inlined
def _choose_order(n, state, before, differences, inverse_scale, rule, statistics):
    """Set the order of extrapolation that would have been best for this step, and the number of known differences."""
    top = min(int(statistics.known_differences), int(statistics.best_order) + 1)
    order, least, errors = 0, math.inf, MOST * padded(n)
    for k in range(top + 1):
        error = 0.0
        for i in range(WIDTH):
            error += differences[errors + k * WIDTH + i]
        if error < least:
            order, least = k, error
    # order -1 is better if p changed by less than half of the change that corresponds to that of the acceleration
    if order == 0:
        h, beta, changed = rule.time_step, rule.beta, 0.0
        for i in range(n):
            moved = (state[i] - before[i]) * inverse_scale[i]
            changed += moved * moved
        to_acceleration = (1.0 - rule.alpha_m) / (h * h * beta * (1.0 - rule.alpha_f))
        if 4.0 * to_acceleration * to_acceleration * changed < least:
            order = -1
    statistics.best_order, statistics.known_differences = order, min(statistics.known_differences + 1.0, MOST)


@routine(fastmath=FAST)
def complete(solver: MotionSolver) -> float:
    """Update the auxiliary acceleration and the differences of p'' at the end of a step, and choose the next order.

    Return the largest change of p'', relative to its scale. Updated are the order of `predict` that would have been
    best, at most one more than the last one, and the number of known differences.
    """
    n, state, before, differences, rule = solver.size, solver.state, solver.before, solver.differences, solver.rule
    inverse_scale, statistics, alpha_m, alpha_f = solver.inverse_scale, solver.statistics, rule.alpha_m, rule.alpha_f
    new, old, mean = (1.0 - alpha_f) / (1.0 - alpha_m), alpha_f / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m)
    # differences that are not known yet stay zero
    known = statistics.known_differences
    has_second, has_third = 1.0 if known > 0.0 else 0.0, 1.0 if known > 1.0 else 0.0
    length, rest, sum_0, sum_1, sum_2, sum_3 = padded(n), 0.0, zeros(), zeros(), zeros(), zeros()
    lanes, weight, now, then = as_rows(differences), as_rows(inverse_scale), as_rows(state), as_rows(before)
    errors, largest_change = MOST * length, zeros()
    whole = n // WIDTH * WIDTH
    for i in range(0, whole, WIDTH):
        a, last_a, factor = now[2 * n + i], then[2 * n + i], weight[i]
        now[3 * n + i] = new * a + old * last_a - mean * then[3 * n + i]
        change = a - last_a
        largest_change = larger(largest_change, change * factor)
        one, two, three = lanes[i], lanes[length + i], lanes[2 * length + i]
        second, third = change - one, change - one - two
        by_1, by_2, by_3 = errors_of_orders(second, third, two, three)
        lanes[i], lanes[length + i], lanes[2 * length + i] = change, has_second * second, has_third * third
        by_0, by_1, by_2, by_3 = factor * change, factor * by_1, factor * by_2, factor * by_3
        sum_0, sum_1, sum_2, sum_3 = sum_0 + by_0 * by_0, sum_1 + by_1 * by_1, sum_2 + by_2 * by_2, sum_3 + by_3 * by_3
    lanes[errors], lanes[errors + WIDTH] = sum_0, sum_1
    lanes[errors + 2 * WIDTH], lanes[errors + 3 * WIDTH] = sum_2, sum_3
    for i in range(whole, n):
        state[3 * n + i] = new * state[2 * n + i] + old * before[2 * n + i] - mean * before[3 * n + i]
        difference = state[2 * n + i] - before[2 * n + i]
        rest = larger_of(rest, abs(difference * inverse_scale[i]))
        d_1, d_2, d_3 = differences[i], differences[length + i], differences[2 * length + i]
        differences[i], differences[length + i] = difference, has_second * (difference - d_1)
        differences[2 * length + i] = has_third * (difference - d_1 - d_2)
        error_1, error_2, error_3 = errors_of_orders(difference - d_1, difference - d_1 - d_2, d_2, d_3)
        own = at(differences, errors + i - whole)
        own[0] += (inverse_scale[i] * difference) ** 2
        own[WIDTH] += (inverse_scale[i] * error_1) ** 2
        own[2 * WIDTH] += (inverse_scale[i] * error_2) ** 2
        own[3 * WIDTH] += (inverse_scale[i] * error_3) ** 2
    dofs = solver.prescribed_dofs
    for i in range(solver.prescribed):
        state[3 * n + dofs[i]] = state[2 * n + dofs[i]]
    _choose_order(n, state, before, differences, inverse_scale, rule, statistics)
    return larger_of(largest(largest_change), rest)
