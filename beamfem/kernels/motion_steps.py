"""What a time step of the generalized-alpha method does to a state, apart from solving for corrections."""

import math

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.lanes import WIDTH, as_rows, larger, largest, zeros
from beamfem.kernels.pointers import at, reals, small_code, wholes
from beamfem.kernels.record import CHUNKS, LANES, NODE_ROWS, NODES, ROW, VECTORS

FAST = {"contract", "reassoc", "nsz"}
# of the tolerance, of the estimated error where the tangent is not that of the last iterate
_REMAINDER = 1e-5
# Of what a change of acceleration changes in a step, which is as large as what it neglects. An error that is left
# behind in every step adds up, and weighs 1 / h in p'; so it must fall with the step as well.
_NEGLECTED = 1e-8
FAR = 0.01  # of the model: after such a correction it is asked whether elements are inside out
MOST = 3  # differences of the acceleration that extrapolate it: more than these pass on noise from step to step
_LARGEST = 1e3  # of the model: what such a correction leads to belongs to another motion
_GROWTH = 2.0  # of corrections with a tangent each, from the second on: more leads to another motion too


@inlined
def padded(n):
    """Return the length of a row of n numbers that lanes fill."""
    return (n + WIDTH - 1) // WIDTH * WIDTH


def difference_rows(n: int, parts: int = 1) -> int:
    """Return how many numbers the backward differences of n accelerations take.

    Rows (MOST, padded(n)) of them, and their sizes (parts, MOST + 1, WIDTH), one for the change that they expect.
    """
    return MOST * -(-n // WIDTH) * WIDTH + parts * (MOST + 1) * WIDTH


@inlined
def _larger_of(a, b):
    """Return the larger of two sizes; what is no number is larger than all."""
    return b if not b <= a and a == a else a


@inlined
def predict_part(first, end, n, prescribed, order, state, before, differences, dofs, values, rule):
    """Do what `predict` does for coordinates from the first to the end."""
    h, alpha_m, alpha_f, gamma, beta = rule[0], rule[1], rule[2], rule[3], rule[4]
    kept, mean, fraction = 1.0 / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m), (1.0 - alpha_f) / (1.0 - alpha_m)
    length, lanes, now, then = padded(n), as_rows(differences), as_rows(state), as_rows(before)
    whole = first + (end - first) // WIDTH * WIDTH
    for i in range(first, whole, WIDTH):
        p, v, a, mean_a = now[i], now[n + i], now[2 * n + i], now[3 * n + i]
        then[i], then[n + i], then[2 * n + i], then[3 * n + i] = p, v, a, mean_a
        ahead = zeros()
        for k in range(int(order)):
            ahead += lanes[k * length + i]
        if order < 0.0:
            ahead = (-(v / h + (0.5 - beta) * mean_a) / beta - kept * a + mean * mean_a) / fraction
        new = kept * a - mean * mean_a + fraction * ahead
        now[i] = p + h * v + h * h * ((0.5 - beta) * mean_a + beta * new)
        now[n + i] = v + h * ((1.0 - gamma) * mean_a + gamma * new)
        now[2 * n + i] = a + ahead
    for i in range(whole, end):
        last_p, last_v, last_a, last_mean = state[i], state[n + i], state[2 * n + i], state[3 * n + i]
        for k in range(4):
            before[k * n + i] = state[k * n + i]
        change = 0.0
        for k in range(int(order)):
            change += differences[k * length + i]
        if order < 0.0:
            change = (-(last_v / h + (0.5 - beta) * last_mean) / beta - kept * last_a + mean * last_mean) / fraction
        next_a = kept * last_a - mean * last_mean + fraction * change
        state[i] = last_p + h * last_v + h * h * ((0.5 - beta) * last_mean + beta * next_a)
        state[n + i] = last_v + h * ((1.0 - gamma) * last_mean + gamma * next_a)
        state[2 * n + i] = last_a + change
    for i in range(prescribed):
        if first <= dofs[i] and dofs[i] < end:
            for k in range(3):
                state[k * n + dofs[i]] = values[k * prescribed + i]


@routine("iidrrrnrr")
def predict(n, prescribed, order, state, before, differences, dofs, values, rule):
    """Store the state (4, n) in `before` and start a step from it, prescribed coordinates at `values` (3, prescribed).

    The acceleration is extrapolated by a polynomial through the last steps: order 0 keeps it, 1 is a line, and so on;
    order -1 keeps p instead, which strains nothing where stiff parts ring within a step. differences: see
    `difference_rows`, of which so many are known as the order. rule: step, alpha_m, alpha_f, gamma, beta.
    """
    predict_part(0, n, n, prescribed, order, state, before, differences, dofs, values, rule)


@inlined
def correct_part(
    first,
    end,
    first_unknown,
    end_unknown,
    n,
    first_free,
    state,
    right,
    free,
    inverse_scale,
    coefficients,
    change,
):
    """Do what `correct` does for coordinates from the first to the end, and the unknown that are among them."""
    to_velocity, to_acceleration, size, rest = coefficients[1], coefficients[2], zeros(), 0.0
    begin, source, offset = first, change, 0
    if first_free >= 0:
        begin, end = first_unknown + first_free, end_unknown + first_free
        source, offset = right, first_free
    else:
        for i in range(first_unknown, end_unknown):
            change[free[i]] = right[i]
    lanes, weight, rows = as_rows(source), as_rows(inverse_scale), as_rows(state)
    whole = begin + (end - begin) // WIDTH * WIDTH
    for i in range(begin, whole, WIDTH):
        by = lanes[i - offset]
        size = larger(size, by * weight[i])
        rows[i] += by
        rows[n + i] += to_velocity * by
        rows[2 * n + i] += to_acceleration * by
    for i in range(whole, end):
        last = source[i - offset]
        rest = _larger_of(rest, abs(last * inverse_scale[i]))
        state[i] += last
        state[n + i] += to_velocity * last
        state[2 * n + i] += to_acceleration * last
    return _larger_of(largest(size), rest)


@routine("iiirrnrrr", "d", fastmath=FAST)
def correct(n, unknown, first_free, state, right, free, inverse_scale, coefficients, change):
    """Add corrections (unknown,) of p, and what they are of p' and p''; return the largest, relative to its scale.

    first_free: of the unknown coordinates `free`, where they follow one another, else -1;
    change (padded(n),): takes the corrections there, zero elsewhere.
    """
    return correct_part(0, n, 0, unknown, n, first_free, state, right, free, inverse_scale, coefficients, change)


@routine("iiiiddddrr", "i")
def judge(iteration, full, own, far, size, last, changed, tolerance, rate, noise):
    """Return 1 if a step is done after a correction, -1 if it is lost, 2 if a new tangent has to tell.

    own: this correction has a tangent of its own, full: each has; far: the first one was larger than `FAR`, so that the
    tangent it was made with tells nothing of where it led; size, last: this correction and the one before;
    changed: what a change of acceleration changes in the step. Updated: rate (1,) at which corrections shrink, noise
    (1,): corrections of this size are round-off, as a new tangent has shown. Hairer and Wanner 1996, IV.8.
    """
    if not size < _LARGEST:
        return -1
    if iteration > 1:
        if last <= tolerance and size <= tolerance:
            if own != 0:
                if 0.5 * last < size <= 2.0 * last:
                    noise[0] = 2.0 * last
                return 1
            if size > 0.5 * last:
                # they no longer shrink: round-off, or what is left is out of reach of a tangent that was kept
                return 1 if size <= noise[0] else 2
        rate[0] = size / last if last > 0.0 else 0.0
    if full != 0:
        if size <= tolerance:
            return 1
        return -1 if iteration > 2 and size > _GROWTH * last else 0
    small = rate[0] * size <= (1.0 - rate[0]) * min(_REMAINDER * tolerance, _NEGLECTED * changed)
    if rate[0] < 1.0 and small:
        return 2 if far != 0 and own == 0 else 1
    return 0


@inlined
def complete_part(part, first, end, n, prescribed, state, before, differences, inverse_scale, dofs, rule, known):
    """Do what `complete` does for coordinates from the first to the end, but for the order; return the same.

    Sizes of differences are left for `best_order`.
    """
    alpha_m, alpha_f = rule[1], rule[2]
    new, old, mean = (1.0 - alpha_f) / (1.0 - alpha_m), alpha_f / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m)
    top, length, rest = min(int(known[1]), int(known[0]) + 1), padded(n), 0.0
    lanes, weight, now, then = as_rows(differences), as_rows(inverse_scale), as_rows(state), as_rows(before)
    errors, largest_change = MOST * length + part * (MOST + 1) * WIDTH, zeros()
    whole = first + (end - first) // WIDTH * WIDTH
    for k in range(MOST + 1):
        lanes[errors + k * WIDTH] = 0.0
    for i in range(first, whole, WIDTH):
        a, last_a, own = now[2 * n + i], then[2 * n + i], weight[i]
        now[3 * n + i] = new * a + old * last_a - mean * then[3 * n + i]
        change = a - last_a
        largest_change = larger(largest_change, change * own)
        for k in range(top + 1):
            size = change * own
            lanes[errors + k * WIDTH] += size * size
            if k < MOST:
                kept = lanes[k * length + i]
                lanes[k * length + i] = change
                change -= kept
    for i in range(whole, end):
        state[3 * n + i] = new * state[2 * n + i] + old * before[2 * n + i] - mean * before[3 * n + i]
        difference = state[2 * n + i] - before[2 * n + i]
        rest = _larger_of(rest, abs(difference * inverse_scale[i]))
        for k in range(top + 1):
            error = difference * inverse_scale[i]
            differences[errors + k * WIDTH + i - whole] += error * error
            if k < MOST:
                previous = differences[k * length + i]
                differences[k * length + i] = difference
                difference -= previous
    for i in range(prescribed):
        if first <= dofs[i] and dofs[i] < end:
            state[3 * n + dofs[i]] = state[2 * n + dofs[i]]
    return _larger_of(largest(largest_change), rest)


@inlined
def best_order(parts, n, state, before, differences, inverse_scale, rule, extrapolation):
    """Set the order that would have been best and how many differences are known, of the sizes of all parts."""
    top = min(int(extrapolation[1]), int(extrapolation[0]) + 1)
    order, least, errors = 0, math.inf, MOST * padded(n)
    for k in range(top + 1):
        error = 0.0
        for part in range(parts):
            for i in range(WIDTH):
                error += differences[errors + (part * (MOST + 1) + k) * WIDTH + i]
        if error < least:
            order, least = k, error
    if order == 0:  # unless positions have changed by half or less of what the acceleration would have moved them
        h, beta, changed = rule[0], rule[4], 0.0
        for i in range(n):
            moved = (state[i] - before[i]) * inverse_scale[i]
            changed += moved * moved
        to_acceleration = (1.0 - rule[1]) / (h * h * beta * (1.0 - rule[2]))
        if 4.0 * to_acceleration * to_acceleration * changed < least:
            order = -1
    extrapolation[0], extrapolation[1] = order, min(top + 1, MOST)


@routine("iirrrrnrr", "d", fastmath=FAST)
def complete(n, prescribed, state, before, differences, inverse_scale, dofs, rule, extrapolation):
    """End a step: auxiliary acceleration and differences of p''; return the largest first difference.

    inverse_scale (padded(n),): zero beyond n; extrapolation (2,): the order that would have been best, one more than
    the last one at most (see `predict`), and how many differences are known.
    """
    change = complete_part(0, 0, n, n, prescribed, state, before, differences, inverse_scale, dofs, rule, extrapolation)
    best_order(1, n, state, before, differences, inverse_scale, rule, extrapolation)
    return change


@routine("inrrr")
def count_turns(pairs, table, before, now, turned):
    """Add to `turned` (pairs,) [rad] by how much vectors at coordinates (pairs, 2) have turned between states (n,)."""
    small_code()
    for i in range(pairs):
        x, y = table[2 * i], table[2 * i + 1]
        crossed = before[x] * now[y] - before[y] * now[x]
        turned[i] += math.atan2(crossed, before[x] * now[x] + before[y] * now[y])


@routine("iir")
def keep_directions(group, first, kept):
    """Store the vectors d (N, 2) of the nodes of a group, which are numbered from `first` on."""
    b = wholes(group)
    chunks, size = reals(b[CHUNKS]), 2 * b[VECTORS]
    for node in range(b[NODES]):
        d = at(chunks, (node // LANES * b[NODE_ROWS] + size - 2) * ROW + node % LANES)
        kept[2 * (first + node)], kept[2 * (first + node) + 1] = d[0], d[ROW]


@routine("iirr", fastmath=FAST)
def turns_since(group, first, kept, turns):
    """Fill cosine and sine (N, 2) of how far the nodes of a group have turned since their vectors d were kept."""
    small_code()
    b = wholes(group)
    chunks, size = reals(b[CHUNKS]), 2 * b[VECTORS]
    for node in range(b[NODES]):
        d, own = at(chunks, (node // LANES * b[NODE_ROWS] + size - 2) * ROW + node % LANES), 2 * (first + node)
        x, y, x0, y0 = d[0], d[ROW], kept[own], kept[own + 1]
        c, s = x * x0 + y * y0, y * x0 - x * y0
        inverse = 1.0 / math.sqrt(c * c + s * s)
        turns[own], turns[own + 1] = c * inverse, s * inverse


@routine("idnrr", fastmath=FAST)
def turn_pairs(pairs, sense, table, turns, right):
    """Turn vectors in a right-hand side (n,) with their nodes, sense -1: back; table (pairs, 3): numbers x, y, node.

    A kept tangent turns with the sections: K(now) is near R K(kept) R^T, exact where a body has turned as a whole; then
    a pendulum or a rotor needs no new tangent for its turning.
    """
    small_code()
    for i in range(pairs):
        first, second, node = table[3 * i], table[3 * i + 1], table[3 * i + 2]
        c, s = turns[2 * node], sense * turns[2 * node + 1]
        x, y = right[first], right[second]
        right[first], right[second] = c * x - s * y, s * x + c * y
