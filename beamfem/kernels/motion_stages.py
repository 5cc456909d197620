"""Stages of a time step: each does a part of a model, whose bounds stand in a table; see `record` for its fields."""

from beamfem.kernels import extrapolation, model_passes, motion_steps, rollers
from beamfem.kernels import motion_record as m
from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.extrapolation import FAST
from beamfem.kernels.lanes import WIDTH, as_rows
from beamfem.kernels.pointers import at, caller, reals, slots, small_code, wholes

_factor, _solve, _roll = caller("iisrr", "d"), caller("iirr"), caller("inrr")
_rotate_pairs, _keep, _rotations = caller("idnirr"), caller("iiir"), caller("iiirr")
_stay_on_planes = inlined(rollers.stay_on_planes)


@inlined
def bounds_of(b, part):
    """Return the bounds of a part."""
    return at(wholes(b[r.BOUNDS]), part * r.BOUND_FIELDS)


@routine("iiii", "d")
def predict(part, system, solver, calls):
    """Start a step; the order of the extrapolation stands behind the rule."""
    small_code()
    s, b = wholes(system), wholes(solver)
    bounds, rule = bounds_of(b, part), reals(b[r.RULE])
    extrapolation.predict_part(
        bounds[r.FIRST_COORDINATE],
        bounds[r.END_COORDINATE],
        s[r.SIZE],
        b[r.PRESCRIBED],
        rule[m.ORDER],
        reals(b[r.STATE]),
        reals(b[r.BEFORE]),
        reals(b[r.DIFFERENCES]),
        wholes(b[r.PRESCRIBED_DOFS]),
        reals(b[r.PRESCRIBED_NOW]),
        rule,
    )
    if b[r.ROLLERS] > 0:
        first, normal, free = wholes(b[r.ROLLER_FIRST]), reals(b[r.ROLLER_NORMAL]), wholes(b[r.FREE_DOFS])
        _stay_on_planes(s[r.SIZE], b[r.ROLLERS], first, normal, free, reals(b[r.STATE]), reals(b[r.BEFORE]))
    return 0.0


@routine("iiii", "d")
def assemble(part, system, solver, calls):
    """Fill the residual and, if needed, the matrix; return -1, as nothing is factorised yet.

    With `ROTATIONS_WANTED`, also fill the rotations of sections since the last tangent; a new tangent stores their
    directions first.
    """
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    groups, kept, rotations, node = wholes(s[r.GROUP_RECORDS]), reals(b[r.KEPT]), reals(b[r.ROTATIONS]), 0
    model_passes.clear(s, 0, s[r.SIZE], 0, s[r.ENTRIES])
    for group in range(s[r.GROUPS]):
        model_passes.add_group(s, system, group)
        if b[r.ROTATIONS_WANTED] != 0:
            if s[r.TANGENT] != 0:
                _keep(call[r.KEEP_DIRECTIONS], groups[group], node, b[r.NODE_STRIDE], kept)
            _rotations(call[r.ROTATIONS_SINCE], groups[group], node, b[r.NODE_STRIDE], kept, rotations)
        node += wholes(groups[group])[r.NODES]
    model_passes.add_springs(s, 0, s[r.SPRINGS])
    return -1.0


@routine("iiii", "d")
def factorise(part, system, solver, calls):
    """Factor the tangent; return the smallest ratio of a pivot to the row's original diagonal entry, negative."""
    b, call = wholes(solver), wholes(calls)
    unknown, half, reach, rows, space = (
        b[r.UNKNOWN],
        b[r.HALF],
        slots(b[r.REACH]),
        reals(b[r.ROWS]),
        reals(b[r.STEP]),
    )
    return -_factor(call[r.FACTOR_BOTH], unknown, half, reach, rows, space)


@inlined
def _rotate_vectors(b, call, sense):
    runs, table, rotations = b[r.RUNS_OF_PAIRS], wholes(b[r.PAIR_TABLE]), reals(b[r.ROTATIONS])
    _rotate_pairs(call[r.ROTATE_PAIRS], runs, sense, table, b[r.NODE_STRIDE], rotations, reals(b[r.RIGHT]))


@inlined
def fill_right(s, b, first, end):
    """Fill the right-hand side with the residual of unknown coordinates, negative."""
    residual, right = reals(s[r.RESIDUAL]), reals(b[r.RIGHT])
    if b[r.FIRST_FREE] >= 0:
        lanes, source = as_rows(right), as_rows(at(residual, b[r.FIRST_FREE]))
        whole = first + (end - first) // WIDTH * WIDTH
        for i in range(first, whole, WIDTH):
            lanes[i] = -source[i]
        for i in range(whole, end):
            right[i] = -residual[b[r.FIRST_FREE] + i]
    else:
        free = wholes(b[r.FREE_DOFS])
        for i in range(first, end):
            right[i] = -residual[free[i]]


@routine("iiii", "d")
def solve(part, system, solver, calls):
    """Solve for the correction with the kept tangent, rotated with the sections; it replaces the right-hand side."""
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    unknown, rollers, right = b[r.UNKNOWN], b[r.ROLLERS], reals(b[r.RIGHT])
    first_of, normal = wholes(b[r.ROLLER_FIRST]), reals(b[r.ROLLER_NORMAL])
    fill_right(s, b, 0, unknown)
    if rollers > 0:
        _roll(call[r.ROTATE_IN], rollers, first_of, normal, right)
    _rotate_vectors(b, call, -1.0)
    _solve(call[r.SOLVE_BOTH], unknown, b[r.HALF], reals(b[r.ROWS]), right)
    _rotate_vectors(b, call, 1.0)
    if rollers > 0:
        _roll(call[r.ROTATE_BACK], rollers, first_of, normal, right)
    return 0.0


@inlined
def correct_range(s, b, own):
    """Add corrections to the state; own (4,): the range of coordinates, and that of the unknowns among them."""
    return motion_steps.correct_part(
        own[r.FIRST_COORDINATE],
        own[r.END_COORDINATE],
        own[r.FIRST_UNKNOWN],
        own[r.END_UNKNOWN],
        s[r.SIZE],
        b[r.FIRST_FREE],
        reals(b[r.STATE]),
        reals(b[r.RIGHT]),
        wholes(b[r.FREE_DOFS]),
        reals(b[r.INVERSE_SCALE]),
        reals(s[r.FACTORS]),
        reals(b[r.CHANGE]),
    )


@routine("iiii", "d", fastmath=FAST)
def correct(part, system, solver, calls):
    """Add corrections to the state; return the largest, relative to its scale."""
    s, b = wholes(system), wholes(solver)
    return correct_range(s, b, at(bounds_of(b, part), r.FIRST_COORDINATE))


@routine("iiii", "d", fastmath=FAST)
def complete(part, system, solver, calls):
    """End a step; return the largest change of p'', relative to its scale. The last part chooses the order."""
    s, b = wholes(system), wholes(solver)
    bounds, n, rule, statistics = bounds_of(b, part), s[r.SIZE], reals(b[r.RULE]), reals(b[r.STATISTICS])
    state, before, differences, scale = (
        reals(b[r.STATE]),
        reals(b[r.BEFORE]),
        reals(b[r.DIFFERENCES]),
        reals(b[r.INVERSE_SCALE]),
    )
    change = extrapolation.complete_part(
        part,
        bounds[r.FIRST_COORDINATE],
        bounds[r.END_COORDINATE],
        n,
        b[r.PRESCRIBED],
        state,
        before,
        differences,
        scale,
        wholes(b[r.PRESCRIBED_DOFS]),
        rule,
        statistics,
    )
    if part == b[r.PARTS] - 1:
        extrapolation.best_order(b[r.PARTS], n, state, before, differences, scale, rule, statistics)
    return change
