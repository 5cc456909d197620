"""Newton's iterations for an equilibrium at fixed loads, of models whose tangent is a band, in one compiled call."""

import numpy as np

from beamfem.kernels.balance import balance, smallest_jacobian
from beamfem.kernels.band import factor, solve_upper
from beamfem.kernels.compiling import kernel
from beamfem.kernels.stress import predict_stress
from beamfem.kernels.turned import hold_normals, turn_back, turn_in

FAST = {"contract", "reassoc", "nsz"}


@kernel(nogil=True, fastmath=FAST)
def take(step, p, scale):
    """Add a step (n,) to p; return its size relative to scale, infinite where it is no number."""
    size = 0.0
    for i in range(p.shape[0]):
        p[i] += step[i]
        own = abs(step[i]) / scale[i]
        if not own <= size:
            size = own
    return size


@kernel(nogil=True)
def negative_diagonal(rows):
    """Return how many of the inverse pivots that a factorised band (n, width) has on its diagonal are negative."""
    count, middle = 0, rows.shape[1] // 2
    for i in range(rows.shape[0]):
        count += rows[i, middle] < 0.0
    return count


@kernel(_nrt=True)
def equilibrate(
    forms,
    blocks,
    work,
    loads,
    springs,
    layouts,
    free,
    turned,
    p,
    body,
    values,
    held_change,
    scale,
    limits,
    rows,
    found,
    residual,
):
    """Iterate from p (n,), changed in place; return whether every tangent could be factorised without pivots.

    held_change: first step (n,) of the held coordinates and what it changes in the residual (n,), zero to go on.
    limits: tolerance, correction below which it may be stagnant, one beyond which it diverges, smallest pivot ratio,
    iterations, 1 to take predicted stresses for the geometric tangent, and the count of negative pivots where it stops
    if the third tangent or a later one has another (the stresses of the second are those of a linear step), or -1.
    rows (unknown, width): the band. found (8,): iterations so far, last correction and the one before; then largest
    residual of the unknown and of all coordinates, times their scales, and the smallest r0' x d of the state reached,
    whose residual (n,) is filled; negative pivots of the last tangent; size of the first correction. Stops
    where corrections are small or stagnant, or have grown.
    """
    n, unknown, window = p.shape[0], free.shape[0], forms[0].window
    matrix, coefficients = rows.reshape(rows.size), np.array([1.0, 0.0, 0.0])
    step, rest, right = np.empty(n), np.zeros(n), np.empty(unknown)
    held_step, held_force = held_change
    first, row, done = True, int(limits[4]) * 0, False
    while True:
        predicted = not done and found[0] > 0.0 and limits[5] > 0.0
        target = matrix[:0] if done else matrix
        balance(
            forms, blocks, work, loads, springs, layouts, p, rest, rest, body, values, row, coefficients, predicted,
            residual, target,
        )  # fmt: skip
        if done:
            break
        for i in range(unknown):
            right[i] = -residual[free[i]] - (held_force[free[i]] if first else 0.0)
        hold_normals(rows, turned[0], turned[1])
        turn_in(right, turned[0], turned[1])
        if not factor(rows, right, step, window) > limits[3]:
            return False
        found[6] = negative_diagonal(rows)
        if limits[6] >= 0.0 and found[6] != limits[6] and found[0] > 1.0:
            found[0] += 1.0
            return True
        solve_upper(rows, right, window)
        turn_back(right, turned[0], turned[1])
        for i in range(n):
            step[i] = held_step[i] if first else 0.0
        for i in range(unknown):
            step[free[i]] = right[i]
        first = False
        if limits[5] > 0.0:
            _predict(forms, blocks, work, p, step)
        found[0] += 1.0
        found[2], found[1] = found[1], take(step, p, scale)
        if found[0] == 1.0:
            found[7] = found[1]
        if not found[1] <= limits[2]:
            return True
        stagnant = found[0] > 2.0 and found[1] > 0.25 * found[2] and found[1] < limits[1]
        done = found[1] <= limits[0] or stagnant or not found[0] < limits[4]
    found[3], found[4] = 0.0, 0.0
    for i in range(n):
        found[4] = max(found[4], abs(residual[i]) * scale[i])
    for i in range(unknown):
        right[i] = residual[free[i]]
    turn_in(right, turned[0], turned[1])
    for i in range(unknown):
        found[3] = max(found[3], abs(right[i]) * scale[free[i]])
    found[5] = smallest_jacobian(forms, blocks, work)
    return True


@kernel()
def _predict(forms, blocks, work, p, step):
    for i in range(len(blocks)):
        predict_stress(forms[i], blocks[i], work[i], p, step, work[i].stress)
