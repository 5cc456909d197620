"""Newton's iterations for an equilibrium at fixed loads, of models whose tangent is a band, in one compiled call."""

from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.newton_record import (
    CORRECTION,
    CORRECTION_BEFORE,
    DIVERGENT,
    FIRST_CORRECTION,
    FORCE,
    ITERATIONS,
    JACOBIAN,
    MOST_ITERATIONS,
    NEGATIVE_PIVOTS,
    NEGATIVE_PIVOTS_AFTER_FIRST,
    PIVOT_RATIO,
    PREDICTED_RESULTANTS,
    REQUIRED_NEGATIVE_PIVOTS,
    STAGNANT,
    TOLERANCE,
    UNBALANCED,
)
from beamfem.kernels.pointers import at, caller, reals, slots, wholes
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, zeros

_FAST = {"contract", "reassoc", "nsz"}

_balance, _predict, _jacobian = caller("i"), caller("iii"), caller("i", "d")
_factor, _solve = caller("iiiisrrr", "d"), caller("iiirr")
_constrain, _rotate, _take = caller("iiirnr"), caller("inrr"), caller("irrr", "d")


@inlined
def _larger_of(size, value):
    """Return the larger of a size and that of a value; NaN counts as the largest."""
    return abs(value) if not abs(value) <= size and size == size else size


@routine("irrr", "d", fastmath=_FAST)
def take_step(n, step, p, inverse_scale):
    """Add a step (n,) to p; return its largest component relative to the scale, NaN if one is NaN."""
    change, lanes, weight, sizes, whole = as_rows(step), as_rows(p), as_rows(inverse_scale), zeros(), n // WIDTH * WIDTH
    for i in range(0, whole, WIDTH):
        correction = change[i]
        lanes[i] += correction
        sizes = larger(sizes, correction * weight[i])
    size = largest(sizes)
    for i in range(whole, n):
        p[i] += step[i]
        size = _larger_of(size, step[i] * inverse_scale[i])
    return size


@inlined
def _largest_product(n, one, other):
    """Return the largest product of the numbers (n,) of two rows, NaN if one is NaN."""
    lanes, others, sizes, whole = as_rows(one), as_rows(other), zeros(), n // WIDTH * WIDTH
    for i in range(0, whole, WIDTH):
        sizes = larger(sizes, lanes[i] * others[i])
    size = largest(sizes)
    for i in range(whole, n):
        size = _larger_of(size, one[i] * other[i])
    return size


@inlined
def _negative(unknown, signs):
    """Return how many numbers (unknown,) are negative."""
    negative = 0
    for i in range(unknown):
        negative += signs[i] < 0.0
    return negative


@routine("iii", "i")
def iterate(system, solver, calls):
    """Iterate from p (n,), changed in place; return 1 if every tangent could be factorised without pivots, else 0.

    `PRESCRIBED_STEP`, `PRESCRIBED_FORCE`: first step (n,) of the prescribed coordinates and what it changes in the
    residual (n,), zero to go on. `LIMITS`, `FOUND`: see `newton_record`; the residual (n,) of the state reached is
    filled. `LINEAR` (n,): the state after the linear step, where the second tangent has another number of negative
    pivots than required. Stops where corrections are small or stagnant, or have grown.
    """
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    n, unknown, half, rollers = s[r.SIZE], b[r.UNKNOWN], b[r.HALF], b[r.ROLLERS]
    free, first_of, normal = wholes(b[r.FREE_DOFS]), wholes(b[r.ROLLER_FIRST]), reals(b[r.ROLLER_NORMAL])
    rows, right, step, scale, inverse_scale = (
        reals(b[r.ROWS]),
        reals(b[r.RIGHT]),
        reals(b[r.STEP]),
        reals(b[r.SCALE]),
        reals(b[r.INVERSE_SCALE]),
    )
    limits, found, prescribed_step, prescribed_force = (
        reals(b[r.LIMITS]),
        reals(b[r.FOUND]),
        reals(b[r.PRESCRIBED_STEP]),
        reals(b[r.PRESCRIBED_FORCE]),
    )
    linear, in_a_row, reach = reals(b[r.LINEAR]), b[r.FIRST_FREE], slots(b[r.REACH])
    residual, p, groups = reals(s[r.RESIDUAL]), reals(s[r.COORDINATES_P]), wholes(s[r.GROUP_RECORDS])
    first, done = True, False
    while True:
        s[r.TANGENT] = 0 if done else 1
        s[r.PREDICTED] = 1 if not done and found[ITERATIONS] > 0.0 and limits[PREDICTED_RESULTANTS] > 0.0 else 0
        _balance(call[r.BALANCE], system)
        if done:
            break
        if in_a_row >= 0 and not first:
            whole, lanes, source = unknown // WIDTH * WIDTH, as_rows(right), as_rows(at(residual, in_a_row))
            for i in range(0, whole, WIDTH):
                lanes[i] = -source[i]
            for i in range(whole, unknown):
                right[i] = -residual[in_a_row + i]
        else:
            for i in range(unknown):
                right[i] = -residual[free[i]] - (prescribed_force[free[i]] if first else 0.0)
        if rollers > 0:
            _constrain(call[r.CONSTRAIN_NORMALS], unknown, half, rollers, rows, first_of, normal)
            _rotate(call[r.ROTATE_IN], rollers, first_of, normal, right)
        if not _factor(call[r.FACTOR], unknown, unknown, half, 1, reach, rows, right, step) > limits[PIVOT_RATIO]:
            return 0
        negative = _negative(unknown, step)
        found[NEGATIVE_PIVOTS] = negative
        if found[ITERATIONS] == 1.0:
            found[NEGATIVE_PIVOTS_AFTER_FIRST] = negative
        if limits[REQUIRED_NEGATIVE_PIVOTS] >= 0.0 and found[NEGATIVE_PIVOTS] != limits[REQUIRED_NEGATIVE_PIVOTS]:
            if found[ITERATIONS] > 1.0:
                found[ITERATIONS] += 1.0
                return 1
            if found[ITERATIONS] == 1.0:
                for i in range(n):
                    linear[i] = p[i]
        _solve(call[r.SOLVE_UPPER], unknown, unknown, half, rows, right)
        if rollers > 0:
            _rotate(call[r.ROTATE_BACK], rollers, first_of, normal, right)
        for i in range(n):
            step[i] = prescribed_step[i] if first else 0.0
        if in_a_row >= 0:
            whole, lanes, to = unknown // WIDTH * WIDTH, as_rows(right), as_rows(at(step, in_a_row))
            for i in range(0, whole, WIDTH):
                to[i] = lanes[i]
            for i in range(whole, unknown):
                step[in_a_row + i] = right[i]
        else:
            for i in range(unknown):
                step[free[i]] = right[i]
        first = False
        if limits[PREDICTED_RESULTANTS] > 0.0:
            for group in range(s[r.GROUPS]):
                _predict(call[r.PREDICT_RESULTANTS], groups[group], system, 1)
        found[ITERATIONS] += 1.0
        found[CORRECTION_BEFORE], found[CORRECTION] = (
            found[CORRECTION],
            _take(call[r.TAKE_STEP], n, step, p, inverse_scale),
        )
        if found[ITERATIONS] == 1.0:
            found[FIRST_CORRECTION] = found[CORRECTION]
        if not found[CORRECTION] <= limits[DIVERGENT]:
            return 1
        stagnant = (
            found[ITERATIONS] > 2.0
            and found[CORRECTION] > 0.25 * found[CORRECTION_BEFORE]
            and found[CORRECTION] < limits[STAGNANT]
        )
        done = found[CORRECTION] <= limits[TOLERANCE] or stagnant or not found[ITERATIONS] < limits[MOST_ITERATIONS]
    found[FORCE] = _largest_product(n, residual, scale)
    for i in range(unknown):
        right[i], step[i] = residual[free[i]], scale[free[i]]
    if rollers > 0:
        _rotate(call[r.ROTATE_IN], rollers, first_of, normal, right)
    found[UNBALANCED] = _largest_product(unknown, right, step)
    found[JACOBIAN] = 1.0
    for group in range(s[r.GROUPS]):
        found[JACOBIAN] = min(found[JACOBIAN], _jacobian(call[r.SMALLEST_JACOBIAN], groups[group]))
    return 1


@routine("iii", "i")
def count_after_step(system, solver, calls):
    """Return the negative pivots of the tangent in p (n,) with the resultants that the linear `STEP` (n,) leads to.

    -1 if a pivot is tiny.
    """
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    unknown, half, rollers = b[r.UNKNOWN], b[r.HALF], b[r.ROLLERS]
    rows, right, limits, reach = reals(b[r.ROWS]), reals(b[r.RIGHT]), reals(b[r.LIMITS]), slots(b[r.REACH])
    groups = wholes(s[r.GROUP_RECORDS])
    for group in range(s[r.GROUPS]):
        _predict(call[r.PREDICT_RESULTANTS], groups[group], system, 0)
    s[r.TANGENT] = s[r.PREDICTED] = 1
    _balance(call[r.BALANCE], system)
    if rollers > 0:
        _constrain(
            call[r.CONSTRAIN_NORMALS],
            unknown,
            half,
            rollers,
            rows,
            wholes(b[r.ROLLER_FIRST]),
            reals(b[r.ROLLER_NORMAL]),
        )
    signs = reals(b[r.STEP])
    if not _factor(call[r.FACTOR], unknown, unknown, half, 0, reach, rows, right, signs) > limits[PIVOT_RATIO]:
        return -1
    return _negative(unknown, signs)
