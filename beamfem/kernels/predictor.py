"""Predictor: polynomial extrapolation of the acceleration, with the order that fitted the last step best."""

import math

from beamfem.kernels import rollers
from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, where_negative, zeros

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


@inlined
def _predict_at(i, n, length, order, h, gamma, beta, kept, mean, fraction, state, before, differences, ahead):
    """Store and predict one coordinate, or lanes of them; ahead: zero."""
    p, v, a, mean_a = state[i], state[n + i], state[2 * n + i], state[3 * n + i]
    before[i], before[n + i], before[2 * n + i], before[3 * n + i] = p, v, a, mean_a
    for k in range(int(order)):
        ahead += differences[k * length + i]
    if 1.0 <= order < MOST:
        test = alternates(differences[length + i], differences[2 * length + i])
        ahead -= where_negative(test, differences[length * int(order) + i], 0.0)
    if order < 0.0:
        ahead = (-(v / h + (0.5 - beta) * mean_a) / beta - kept * a + mean * mean_a) / fraction
    new = kept * a - mean * mean_a + fraction * ahead
    state[i] = p + h * v + h * h * ((0.5 - beta) * mean_a + beta * new)
    state[n + i] = v + h * ((1.0 - gamma) * mean_a + gamma * new)
    state[2 * n + i] = a + ahead


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
    for i in range(0, whole, WIDTH):
        _predict_at(i, n, length, order, h, gamma, beta, kept, mean, fraction, now, then, lanes, zeros())
    for i in range(whole, n):
        _predict_at(i, n, length, order, h, gamma, beta, kept, mean, fraction, state, before, differences, 0.0)
    prescribed, dofs, values = solver.prescribed, solver.prescribed_dofs, solver.prescribed_now
    for i in range(prescribed):
        for k in range(3):
            state[k * n + dofs[i]] = values[k * prescribed + i]
    if solver.rollers > 0:
        first, normal, free = solver.roller_first, solver.roller_normal, solver.free_dofs
        _stay_on_planes(n, solver.rollers, first, normal, free, state, before)


@inlined
def _complete_at(i, n, length, new, old, mean, has_second, has_third, weight, state, before, differences):
    """Complete one coordinate, or lanes of them.

    Return the change of p'', and the errors of the accelerations that orders 1 to 3 predicted, each times a weight.
    """
    a, last_a = state[2 * n + i], before[2 * n + i]
    state[3 * n + i] = new * a + old * last_a - mean * before[3 * n + i]
    change, one, two, three = a - last_a, differences[i], differences[length + i], differences[2 * length + i]
    second, third, test = change - one, change - one - two, alternates(two, three)
    differences[i], differences[length + i] = change, has_second * second
    differences[2 * length + i] = has_third * third
    by_1, by_2 = second + where_negative(test, two, 0.0), third + where_negative(test, three, 0.0)
    return weight * change, weight * by_1, weight * by_2, weight * (third - three)


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
        by_0, by_1, by_2, by_3 = _complete_at(
            i, n, length, new, old, mean, has_second, has_third, weight[i], now, then, lanes
        )
        largest_change = larger(largest_change, by_0)
        sum_0, sum_1, sum_2, sum_3 = sum_0 + by_0 * by_0, sum_1 + by_1 * by_1, sum_2 + by_2 * by_2, sum_3 + by_3 * by_3
    lanes[errors], lanes[errors + WIDTH] = sum_0, sum_1
    lanes[errors + 2 * WIDTH], lanes[errors + 3 * WIDTH] = sum_2, sum_3
    for i in range(whole, n):
        of_0, of_1, of_2, of_3 = _complete_at(
            i, n, length, new, old, mean, has_second, has_third, inverse_scale[i], state, before, differences
        )
        rest = larger_of(rest, abs(of_0))
        own = at(differences, errors + i - whole)
        own[0], own[WIDTH] = own[0] + of_0 * of_0, own[WIDTH] + of_1 * of_1
        own[2 * WIDTH], own[3 * WIDTH] = own[2 * WIDTH] + of_2 * of_2, own[3 * WIDTH] + of_3 * of_3
    dofs = solver.prescribed_dofs
    for i in range(solver.prescribed):
        state[3 * n + dofs[i]] = state[2 * n + dofs[i]]
    _choose_order(n, state, before, differences, inverse_scale, rule, statistics)
    return larger_of(largest(largest_change), rest)
