"""Time steps of the generalized-alpha method, many in one compiled call."""

import math

import numpy as np

from beamfem.kernels.balance import balance
from beamfem.kernels.band import factor, solve
from beamfem.kernels.compiling import kernel
from beamfem.kernels.corotate import keep_directions, turn, turns_since
from beamfem.kernels.turned import hold_normals, turn_back, turn_in

FAST = {"contract", "reassoc", "nsz"}
# Simplified Newton iterations: how many a step may take before Newton's own method starts it anew, after how many of
# them, or above which rate of convergence, the next step gets a new tangent.
_MOST, _MANY, _SLOW = 8, 3, 0.05
_REMAINDER = 1e-5  # of the tolerance, of the estimated error where the tangent is not that of the last iterate
# Of what a change of acceleration changes in a step, which is as large as what it neglects. An error that is left
# behind in every step adds up, and weighs 1 / h in p'; so it must fall with the step as well.
_SHARE = 1e-8


def working_space(size: int, unknown: int) -> tuple[np.ndarray, ...]:
    """Return space for `advance`, so that it allocates nothing."""
    return np.empty(size), np.empty(unknown), np.empty((4, size)), np.empty(size), np.empty(3)


@kernel()
def predict(state, before, differences, order, held, values, rule):
    """Store the state (4, n) in `before` and start a step from it, held coordinates at `values` (3, nh).

    The acceleration is extrapolated by a polynomial through the last steps: order 0 keeps it, 1 is a line, and so on.
    differences (3, n): its backward differences.
    """
    h, alpha_m, alpha_f, gamma, beta = rule[0], rule[1], rule[2], rule[3], rule[4]
    kept, mean, share = 1.0 / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m), (1.0 - alpha_f) / (1.0 - alpha_m)
    first, second, third = min(order, 1.0), min(max(order - 1.0, 0.0), 1.0), max(order - 2.0, 0.0)
    for i in range(state.shape[1]):
        p, v, a, mean_a = state[0, i], state[1, i], state[2, i], state[3, i]
        before[0, i], before[1, i], before[2, i], before[3, i] = p, v, a, mean_a
        ahead = first * differences[0, i] + second * differences[1, i] + third * differences[2, i]
        new = kept * a - mean * mean_a + share * ahead
        state[0, i] = p + h * v + h * h * ((0.5 - beta) * mean_a + beta * new)
        state[1, i] = v + h * ((1.0 - gamma) * mean_a + gamma * new)
        state[2, i] = a + ahead
    for i in range(held.shape[0]):
        for k in range(3):
            state[k, held[i]] = values[k, i]


@kernel(fastmath=FAST)
def correct(state, right, free, inverse_scale, coefficients):
    """Add corrections (unknown,) of p, and what they are of p' and p''; return the largest, relative to its scale."""
    largest = 0.0
    to_velocity, to_acceleration = coefficients[1], coefficients[2]
    for i in range(free.shape[0]):
        dof, change = free[i], right[i]
        state[0, dof] += change
        state[1, dof] += to_velocity * change
        state[2, dof] += to_acceleration * change
        size = abs(change) * inverse_scale[dof]
        if not size <= largest:
            largest = size
    return largest


@kernel()
def judge(iteration, size, last, rate, changed, tolerance, full):
    """Return whether a step is done after a correction, and the rate at which corrections shrink.

    size, last: this correction and the one before; rate: what is known of it so far; changed: what a change of
    acceleration changes in the step; full: each correction has its own tangent.
    """
    if iteration > 1:
        if last <= tolerance and size <= tolerance and size > 0.5 * last:
            # corrections within the tolerance that no longer shrink are round-off, and tell nothing of the tangent
            return True, rate
        rate = size / last if last > 0.0 else 0.0
    if full:
        return size <= tolerance, rate
    return rate < 1.0 and rate * size <= (1.0 - rate) * min(_REMAINDER * tolerance, _SHARE * changed), rate


@kernel()
def restore(state, before):
    """Return to the state before the step."""
    for i in range(state.shape[1]):
        state[0, i], state[1, i], state[2, i], state[3, i] = before[0, i], before[1, i], before[2, i], before[3, i]


@kernel(fastmath=FAST)
def complete(state, before, differences, inverse_scale, held, rule):
    """End a step: auxiliary acceleration and differences of p''.

    Return the order of extrapolation that would have been best, and the largest first difference.
    """
    alpha_m, alpha_f = rule[1], rule[2]
    new, old, mean = (1.0 - alpha_f) / (1.0 - alpha_m), alpha_f / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m)
    e0, e1, e2, e3 = 0.0, 0.0, 0.0, 0.0
    for i in range(state.shape[1]):
        state[3, i] = new * state[2, i] + old * before[2, i] - mean * before[3, i]
        d0 = state[2, i] - before[2, i]
        d1 = d0 - differences[0, i]
        d2 = d1 - differences[1, i]
        d3 = d2 - differences[2, i]
        differences[0, i], differences[1, i], differences[2, i] = d0, d1, d2
        weight = inverse_scale[i]
        e0, e1 = max(e0, abs(d0) * weight), max(e1, abs(d1) * weight)
        e2, e3 = max(e2, abs(d2) * weight), max(e3, abs(d3) * weight)
    for i in range(held.shape[0]):
        state[3, held[i]] = state[2, held[i]]
    order, least = 0, e0
    if e1 < least:
        order, least = 1, e1
    if e2 < least:
        order, least = 2, e2
    if e3 < least:
        order = 3
    return order, e0


@kernel()
def count_turns(pairs, before, now, turned):
    """Add to `turned` (m,) [rad] by how much the vectors at coordinates (m, 2) have turned between two states (n,)."""
    for i in range(pairs.shape[0]):
        x, y = pairs[i, 0], pairs[i, 1]
        crossed = before[x] * now[y] - before[y] * now[x]
        turned[i] += math.atan2(crossed, before[x] * now[x] + before[y] * now[y])


@kernel()
def advance(
    forms,
    blocks,
    work,
    loads,
    springs,
    layouts,
    free,
    held,
    turned,
    pairs,
    state,
    inputs,
    rule,
    limits,
    scale,
    memory,
    space,
    saving,
):
    """March through the steps of `inputs`; return how many were completed.

    turned: numbers (nt,) and normals (nt, 2) of inclined rollers. pairs (np, 3): see `corotate.turn`. state: p, p',
    p'', auxiliary acceleration (4, n), advanced in place. inputs: held values (steps, 3, nh), body (steps or 1, beams,
    4), point values of each block (steps or 1, nl, 3). rule: step, alpha_m, alpha_f, gamma, beta. limits: tolerance of
    the correction relative to `scale` (n,), largest number of iterations. memory: factors (unknown, width) of the last
    tangent, the same flat, differences of p'' (3, n), vectors d (N, 2) of the nodes when that tangent was formed and
    how far (N, 2) they have turned since, and statistics (8,): iterations, most iterations in a step, last correction,
    worst pivot ratio, rate of convergence of the last step (negative: its tangent is of no use), number of tangents,
    order of extrapolation, and what the last change of p'' changed in p. space: see `working_space`.
    saving: rows (steps, 3, n), number of the first step, and how many steps make a row; then x and y (m, 2) of vectors
    whose turning is counted, how far they have turned (m,) [rad] and that of the rows (steps, m).

    Chung and Hulbert 1993; in the form of Arnold and Bruels 2007 the equations hold at the end of each step. Iterations
    keep the tangent, over steps as well, turned with the sections, and stop where the estimated error is small (Hairer
    and Wanner 1996, IV.8).
    """
    held_values, body, point_values = inputs
    lu, matrix, differences, kept, turns, statistics = memory
    window = forms[0].window
    saved, first, every, counted, turned_by, saved_turns = saving
    h, alpha_m, alpha_f, gamma, beta = rule[0], rule[1], rule[2], rule[3], rule[4]
    steps, n, unknown = held_values.shape[0], state.shape[1], free.shape[0]
    residual, right, before, inverse_scale, coefficients = space
    coefficients[0], coefficients[1] = 1.0, gamma / (h * beta)
    coefficients[2] = (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))
    for i in range(n):
        inverse_scale[i] = 0.0
    for i in range(unknown):
        inverse_scale[free[i]] = 1.0 / scale[free[i]]
    p, v, a = state[0], state[1], state[2]
    keep, predicted, varying = matrix[:0], n < 0, (body.shape[0] > 1, point_values[0].shape[0] > 1)
    for step in range(steps):
        own_body, row = body[step if varying[0] else 0], step if varying[1] else 0
        predict(state, before, differences, statistics[6], held, held_values[step], rule)
        rate, size, first_size, iteration = statistics[4], 0.0, 0.0, 0
        full, fresh, done = False, rate < 0.0, False
        rate = max(rate, 1e-4) ** 0.8 if not fresh else 1.0
        while iteration < limits[1]:
            renew = full or fresh
            target = matrix if renew else keep
            balance(
                forms, blocks, work, loads, springs, layouts, p, v, a, own_body, point_values, row, coefficients,
                predicted, residual, target,
            )  # fmt: skip
            if renew:
                hold_normals(lu, turned[0], turned[1])
                statistics[3] = min(statistics[3], factor(lu, right[:0], right, window))
                statistics[5] += 1
                keep_directions(work, kept)
            if iteration == 0 or renew:
                turns_since(work, kept, turns)
            for i in range(unknown):
                right[i] = -residual[free[i]]
            turn_in(right, turned[0], turned[1])
            turn(right, pairs, turns, -1.0)
            solve(lu, right, window)
            turn(right, pairs, turns, 1.0)
            turn_back(right, turned[0], turned[1])
            last, size = size, correct(state, right, free, inverse_scale, coefficients)
            fresh = False
            iteration += 1
            statistics[0] += 1
            statistics[2] = size
            if iteration == 1:
                first_size = max(size, statistics[7])
            done, rate = judge(iteration, size, last, rate, first_size, limits[0], full)
            if done or (full and not np.isfinite(size)):
                break
            if not full and not (iteration < _MOST and (iteration < 2 or rate < 0.5)):
                restore(state, before)
                predict(state, before, differences, 0.0, held, held_values[step], rule)
                full, iteration = True, 0
        statistics[1] = max(statistics[1], iteration)
        statistics[4] = -1.0 if iteration > _MANY or (iteration > 1 and rate > _SLOW) else rate
        if not done:
            restore(state, before)
            return step
        statistics[6], change = complete(state, before, differences, inverse_scale, held, rule)
        statistics[7] = change / coefficients[2]
        count_turns(counted, before[0], state[0], turned_by)
        if (first + step) % every == 0:
            row = (first + step) // every
            for i in range(n):
                saved[row, 0, i], saved[row, 1, i], saved[row, 2, i] = state[0, i], state[1, i], state[2, i]
            for i in range(turned_by.shape[0]):
                saved_turns[row, i] = turned_by[i]
    return steps
