"""Newton's iterations for an equilibrium at fixed loads, of models whose tangent is a band, in one compiled call."""

from typing import Annotated

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import Solver, System
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Reals, Record, calls
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, zeros

STALLED = 0.25  # of the correction before: a larger one no longer decreases, and if it is small it is round-off


class NewtonRoutines(Record):
    """The compiled functions that the iteration calls."""

    balance = calls("model_passes:balance")
    predict_resultants = calls("model_passes:predict_resultants")
    smallest_jacobian = calls("model_passes:smallest_jacobian")
    constrain_normals = calls("rollers:constrain_normals")
    rotate_in = calls("rollers:rotate_in")
    rotate_back = calls("rollers:rotate_back")
    factor = calls("band:ANY.factor")
    solve_upper = calls("band:ANY.solve_upper")
    take_step = calls("newton_loop:take_step")
    factor_condensed = calls("condensation:factor_condensed")
    solve_condensed = calls("condensation:solve_condensed")


class NewtonSolver(Solver):
    """Workspace of an iteration, its limits and what it found."""

    routines: NewtonRoutines
    prescribed_step: Annotated[Reals, "size"]
    prescribed_force: Annotated[Reals, "size"]
    linear: Annotated[Reals, "size"]

    # limits
    tolerance: float  # of a correction
    stagnant: float  # correction below which it may be stagnant
    divergent: float  # correction above which the iteration diverges
    pivot_ratio: float  # the smallest of a pivot to the row's original diagonal entry
    most_iterations: int
    predicted_resultants: int  # whether to take them for the geometric tangent
    # where the third tangent or a later one has another number, the iteration stops; -1: any number will do
    required_negative_pivots: int

    # what was found
    iterations: int  # so far
    correction: float  # size of the last one
    correction_before: float  # and of the one before
    # in the state reached: largest residual of the unknown and of all coordinates, times their scales, smallest r0' x d
    unbalanced: float
    force: float
    jacobian: float
    gap: float  # largest movement that a condition is away from being met
    negative_pivots: int  # of the last tangent
    first_correction: float  # its size
    negative_pivots_after_first: int  # those of the second tangent, which has the resultants of a linear step


@inlined
def _larger_of(size, value):
    """Return the larger of a size and that of a value; NaN counts as the largest."""
    return abs(value) if not abs(value) <= size and size == size else size


@routine("irrr", "d", fastmath=FAST)
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


@inlined
def _largest_gap(solver, residual):
    """Return the largest movement that a condition is away from being met, with its gradients of the last tangent."""
    border, free, scale = solver.border, solver.free_dofs, solver.scale
    edge, m, gap = border.edge, border.edge + border.conditions, 0.0
    for i in range(border.conditions):
        gradients = at(border.entries, (edge + i) * m)
        moved = 0.0
        for j in range(edge):
            moved += abs(gradients[j]) * scale[free[border.numbers[j]]]
        gap = _larger_of(gap, residual[free[border.unknown + i]] / moved)
    return gap


@routine()
def iterate(system: System, solver: NewtonSolver) -> int:
    """Iterate from p (n,), changed in place; return 1 if every tangent could be factorised without pivots, else 0.

    `prescribed_step`, `prescribed_force`: first step (n,) of the prescribed coordinates and what it changes in the
    residual (n,), zero to go on. The residual (n,) of the state reached is filled. `linear` (n,): the state after the
    linear step, where the second tangent has another number of negative pivots than required. Stops where corrections
    are small or stagnant, or have grown.
    """
    call = solver.routines
    n, unknown, half, rollers = system.size, solver.unknown, solver.half, solver.rollers
    free, first_of, normal = solver.free_dofs, solver.roller_first, solver.roller_normal
    rows, right, step = solver.rows, solver.right, solver.step
    scale, inverse_scale = solver.scale, solver.inverse_scale
    prescribed_step, prescribed_force = solver.prescribed_step, solver.prescribed_force
    linear, in_a_row, reach, border = solver.linear, solver.first_free, solver.reach, solver.border
    residual, p, groups = system.residual, system.p, system.groups
    first, done = True, False
    while True:
        system.tangent = not done
        system.predicted = not done and solver.iterations > 0 and solver.predicted_resultants != 0
        call.balance(system)
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
            call.constrain_normals(unknown, half, rollers, rows, first_of, normal)
            call.rotate_in(rollers, first_of, normal, right)
        if solver.bordered != 0:
            if not call.factor_condensed(border) > solver.pivot_ratio:
                return 0
            solver.negative_pivots = border.negative
        else:
            if not call.factor(unknown, unknown, half, 1, reach, rows, right, step) > solver.pivot_ratio:
                return 0
            solver.negative_pivots = _negative(unknown, step)
        if solver.iterations == 1:
            solver.negative_pivots_after_first = solver.negative_pivots
        if solver.required_negative_pivots >= 0 and solver.negative_pivots != solver.required_negative_pivots:
            if solver.iterations > 1:
                solver.iterations += 1
                return 1
            if solver.iterations == 1:
                for i in range(n):
                    linear[i] = p[i]
        if solver.bordered != 0:
            call.solve_condensed(border, right)
        else:
            call.solve_upper(unknown, unknown, half, rows, right)
        if rollers > 0:
            call.rotate_back(rollers, first_of, normal, right)
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
        if solver.predicted_resultants != 0:
            for group in range(system.group_count):
                call.predict_resultants(groups[group], system, 1)
        solver.iterations += 1
        solver.correction_before = solver.correction
        solver.correction = call.take_step(n, step, p, inverse_scale)
        if solver.iterations == 1:
            solver.first_correction = solver.correction
        if not solver.correction <= solver.divergent:
            return 1
        stagnant = (
            solver.iterations > 2
            and solver.correction > STALLED * solver.correction_before
            and solver.correction < solver.stagnant
        )
        done = solver.correction <= solver.tolerance or stagnant or not solver.iterations < solver.most_iterations
    solver.force = _largest_product(n, residual, scale)
    for i in range(unknown):
        right[i], step[i] = residual[free[i]], scale[free[i]]
    if rollers > 0:
        call.rotate_in(rollers, first_of, normal, right)
    solver.unbalanced = _largest_product(unknown, right, step)
    solver.gap = _largest_gap(solver, residual) if solver.bordered != 0 else 0.0
    solver.jacobian = 1.0
    for group in range(system.group_count):
        solver.jacobian = min(solver.jacobian, call.smallest_jacobian(groups[group]))
    return 1


@routine()
def count_after_step(system: System, solver: NewtonSolver) -> int:
    """Return the negative pivots of the tangent in p (n,) with the resultants that the linear `step` (n,) leads to.

    -1 if a pivot is tiny.
    """
    call = solver.routines
    unknown, half, rollers = solver.unknown, solver.half, solver.rollers
    rows, right, reach = solver.rows, solver.right, solver.reach
    groups = system.groups
    for group in range(system.group_count):
        call.predict_resultants(groups[group], system, 0)
    system.tangent = system.predicted = 1
    call.balance(system)
    if rollers > 0:
        call.constrain_normals(unknown, half, rollers, rows, solver.roller_first, solver.roller_normal)
    if solver.bordered != 0:
        border = solver.border
        return border.negative if call.factor_condensed(border) > solver.pivot_ratio else -1
    signs = solver.step
    if not call.factor(unknown, unknown, half, 0, reach, rows, right, signs) > solver.pivot_ratio:
        return -1
    return _negative(unknown, signs)
