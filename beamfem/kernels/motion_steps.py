"""Operations of a generalized-alpha time step: corrections of the state, convergence, rotation of the tangent."""

import math
from typing import Annotated

from beamfem.kernels.compiling import FAST, routine
from beamfem.kernels.model_record import LANES, ROW, Group, System
from beamfem.kernels.motion_record import MotionSolver, MotionStatistics, PairRun
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.predictor import larger_of
from beamfem.kernels.records import Reals, Several
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, zeros

# of the tolerance: largest estimated error if the tangent is not that of the last iterate
_REMAINDER = 1e-5
# Largest estimated error as a fraction of the change of p in a step that the change of the acceleration causes, which
# is of the size of the time integration error. Errors left in every step add up, and those of p' are larger by 1 / h,
# so they must decrease with the step as well.
_NEGLECTED = 1e-8
# ratio of corrections that is expected at least where it is not known: one that is smaller is chance, as the next one
# may belong to directions of which it says nothing
SMALLEST_RATE = 1e-4
FAR = 0.01  # of the model: after a larger correction, elements are checked for inversion
_LARGEST = 1e3  # of the model: a larger correction means divergence
# how an iteration goes on: it has converged or diverged, or needs a new tangent
CONVERGED, DIVERGED, RENEW = 1, -1, 2
RATIO, RATIO_BEFORE = range(2)  # of successive corrections
_GROWTH = 2.0  # largest ratio of successive corrections of Newton's method from the second on; above, it diverges


@routine(fastmath=FAST)
def correct(system: System, solver: MotionSolver) -> float:
    """Add corrections to p, and their multiples to p' and p''; return the largest, relative to its scale."""
    n, unknown, first_free, right, free = solver.size, solver.unknown, solver.first_free, solver.right, solver.free_dofs
    state, inverse_scale, change = solver.state, solver.inverse_scale, solver.change
    to_velocity, to_acceleration, size, rest = system.weight_v, system.weight_a, zeros(), 0.0
    begin, end, source, offset = 0, n, change, 0
    if first_free >= 0:
        begin, end = first_free, first_free + unknown
        source, offset = right, first_free
    else:
        for i in range(unknown):
            change[free[i]] = right[i]
    lanes, weight, rows = as_rows(source), as_rows(inverse_scale), as_rows(state)
    whole = begin + (end - begin) // WIDTH * WIDTH
    for i in range(begin, whole, WIDTH):
        correction = lanes[i - offset]
        size = larger(size, correction * weight[i])
        rows[i] += correction
        rows[n + i] += to_velocity * correction
        rows[2 * n + i] += to_acceleration * correction
    for i in range(whole, end):
        value = source[i - offset]
        rest = larger_of(rest, abs(value * inverse_scale[i]))
        state[i] += value
        state[n + i] += to_velocity * value
        state[2 * n + i] += to_acceleration * value
    multipliers = solver.multipliers
    for i in range(solver.conditions):
        state[n + multipliers[i]] = 0.0  # multipliers have no rates
        state[2 * n + multipliers[i]] = 0.0
    return larger_of(largest(size), rest)


@routine()
def check_convergence(
    iteration: int,
    full: int,
    own: int,
    far: int,
    size: float,
    last: float,
    changed: float,
    tolerance: float,
    rate: Reals,
    statistics: MotionStatistics,
) -> int:
    """Return whether a step has converged after a correction: `CONVERGED`, `DIVERGED`, `RENEW`, or 0 to go on.

    full: whether every correction has a new tangent (Newton's method); own: whether this one has; far: whether the
    first correction was larger than `FAR`, so that its tangent says little about the state reached; size, last: sizes
    of this correction and the previous one; changed: change of p in the step that the change of the acceleration
    causes. Updated: rate (2,), the ratio of successive corrections and the one before, of which the larger counts: if a
    kept tangent lacks the coupling of stiff and soft directions, small and large ratios take turns; noise, the
    size up to which corrections have been found, with a new tangent, to be round-off. Hairer and Wanner 1996, IV.8.
    """
    if not size < _LARGEST:
        return DIVERGED
    if iteration > 1:
        if last <= tolerance and size <= tolerance:
            if own != 0:
                if 0.5 * last < size <= 2.0 * last:
                    statistics.noise = 2.0 * last
                return CONVERGED
            if size > 0.5 * last:
                # no longer decreasing: either this is round-off, or the kept tangent cannot reduce the remaining error
                return CONVERGED if size <= statistics.noise else RENEW
        rate[RATIO_BEFORE] = rate[RATIO] if iteration > 2 else SMALLEST_RATE
        rate[RATIO] = size / last if last > 0.0 else 0.0
    if full != 0:
        if size <= tolerance:
            return CONVERGED
        return DIVERGED if iteration > 2 and size > _GROWTH * last else 0
    worst = rate[RATIO] if iteration == 1 else max(rate[RATIO], rate[RATIO_BEFORE])
    small = worst * size <= (1.0 - worst) * min(_REMAINDER * tolerance, _NEGLECTED * changed)
    if worst < 1.0 and small:
        return RENEW if far != 0 and own == 0 else CONVERGED
    return 0


@routine("inrrr")
def count_rotations(pairs, table, before, now, rotated_by):
    """Add the rotations of vectors between two states (n,) to `rotated_by` (pairs,) [rad].

    table (pairs, 2): numbers of the coordinates x and y of each vector.
    """
    small_code()
    for i in range(pairs):
        x, y = table[2 * i], table[2 * i + 1]
        crossed = before[x] * now[y] - before[y] * now[x]
        rotated_by[i] += math.atan2(crossed, before[x] * now[x] + before[y] * now[y])


@routine()
def keep_directions(group: Group, first: int, stride: int, kept: Reals) -> None:
    """Store the vectors d of the nodes of a group in `kept` (2, stride), from column `first` on."""
    begin = 0
    chunks, size, nodes = group.chunks, 2 * group.vectors, group.nodes
    while begin < nodes:
        d, own = at(chunks, (begin // LANES * group.node_rows + size - 2) * ROW), at(kept, first + begin)
        for i in range(min(LANES, nodes - begin)):
            own[i], own[stride + i] = d[i], d[ROW + i]
        begin += LANES


@routine(fastmath=FAST)
def rotations_since(group: Group, first: int, stride: int, kept: Reals, rotations: Reals) -> None:
    """Fill the cosine and sine (2, stride) of the rotation of each node of a group since its d was kept.

    See `keep_directions`.
    """
    begin = 0
    chunks, size, nodes = group.chunks, 2 * group.vectors, group.nodes
    while begin < nodes:
        d = at(chunks, (begin // LANES * group.node_rows + size - 2) * ROW)
        offset, its = at(kept, first + begin), at(rotations, first + begin)
        for i in range(min(LANES, nodes - begin)):
            x, y, x0, y0 = d[i], d[ROW + i], offset[i], offset[stride + i]
            c, s = x * x0 + y * y0, y * x0 - x * y0
            inverse = 1.0 / math.sqrt(c * c + s * s)
            its[i], its[stride + i] = c * inverse, s * inverse
        begin += LANES


@routine(fastmath=FAST)
def rotate_pairs(
    count: int, sense: float, runs: Annotated[Several, PairRun], stride: int, rotations: Reals, right: Reals
) -> None:
    """Rotate the vectors in a right-hand side (n,) by the rotations of their nodes, or back if `sense` is -1.

    A kept tangent K rotates with the sections: the present one is nearly R K R^T, and exactly so if the body has
    rotated as a whole; so the rotation of a pendulum or a rotor needs no new tangent. rotations (2, stride): see
    `rotations_since`.
    """
    small_code()
    for number in range(count):
        run = runs[number]
        step, apart, vector = run.step, run.y - run.x, at(right, run.x)
        cosine, sine = at(rotations, run.node), at(rotations, stride + run.node)
        for i in range(run.length):
            c, s = cosine[i], sense * sine[i]
            x, y = vector[i * step], vector[i * step + apart]
            vector[i * step], vector[i * step + apart] = c * x - s * y, s * x + c * y
