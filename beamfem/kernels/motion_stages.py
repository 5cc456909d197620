"""Stages of a time step; see `record` for the fields of the tables."""

from beamfem.kernels import model_passes, motion_steps, rollers
from beamfem.kernels import motion_record as m
from beamfem.kernels import predictor as extrapolation
from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.pointers import at, caller, reals, slots, small_code, wholes
from beamfem.kernels.predictor import FAST
from beamfem.kernels.simd import WIDTH, as_rows

_factor, _solve, _roll = caller("iisrr", "d"), caller("iirr"), caller("inrr")
_factor_bordered, _solve_bordered = caller("ii", "d"), caller("ii")
_rotate_pairs, _keep, _rotations = caller("idnirr"), caller("iiir"), caller("iiirr")
_predict, _complete = inlined(extrapolation.predict), inlined(extrapolation.complete)
_correct, _stay_on_planes = inlined(motion_steps.correct), inlined(rollers.stay_on_planes)


@routine("iii", "d")
def predict(system, solver, calls):
    """Start a step; the order of the extrapolation is the last entry of the rule."""
    small_code()
    s, b = wholes(system), wholes(solver)
    rule = reals(b[r.RULE])
    _predict(
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


@routine("iii", "d")
def assemble(system, solver, calls):
    """Fill the residual and, if needed, the matrix.

    With `ROTATIONS_WANTED`, also fill the rotations of sections since the last tangent; a new tangent stores their
    directions first.
    """
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    groups, kept, rotations, node = wholes(s[r.GROUP_RECORDS]), reals(b[r.KEPT]), reals(b[r.ROTATIONS]), 0
    model_passes.clear(s)
    for group in range(s[r.GROUPS]):
        model_passes.add_group(s, system, group)
        if b[r.ROTATIONS_WANTED] != 0:
            if s[r.TANGENT] != 0:
                _keep(call[r.KEEP_DIRECTIONS], groups[group], node, b[r.NODE_STRIDE], kept)
            _rotations(call[r.ROTATIONS_SINCE], groups[group], node, b[r.NODE_STRIDE], kept, rotations)
        node += wholes(groups[group])[r.NODES]
    model_passes.add_springs(s)
    model_passes.add_parts_at_points(s, system)
    return 0.0


@routine("iii", "d")
def factorise(system, solver, calls):
    """Factor the tangent; return the smallest ratio of a pivot to the row's original diagonal entry."""
    b, call = wholes(solver), wholes(calls)
    unknown, half, reach, rows, space = (
        b[r.UNKNOWN],
        b[r.HALF],
        slots(b[r.REACH]),
        reals(b[r.ROWS]),
        reals(b[r.STEP]),
    )
    if b[r.EDGE] + b[r.CONDITIONS] > 0:
        return _factor_bordered(call[r.FACTOR_BORDERED], solver, calls)
    return _factor(call[r.FACTOR_BOTH], unknown, half, reach, rows, space)


@inlined
def _rotate_vectors(b, call, sense):
    runs, table, rotations = b[r.RUNS_OF_PAIRS], wholes(b[r.PAIR_TABLE]), reals(b[r.ROTATIONS])
    _rotate_pairs(call[r.ROTATE_PAIRS], runs, sense, table, b[r.NODE_STRIDE], rotations, reals(b[r.RIGHT]))


@inlined
def _fill_right(s, b):
    """Fill the right-hand side with the residual of unknown coordinates, negative."""
    residual, right, unknown = reals(s[r.RESIDUAL]), reals(b[r.RIGHT]), b[r.UNKNOWN]
    if b[r.FIRST_FREE] >= 0:
        lanes, source = as_rows(right), as_rows(at(residual, b[r.FIRST_FREE]))
        whole = unknown // WIDTH * WIDTH
        for i in range(0, whole, WIDTH):
            lanes[i] = -source[i]
        for i in range(whole, unknown):
            right[i] = -residual[b[r.FIRST_FREE] + i]
    else:
        free = wholes(b[r.FREE_DOFS])
        for i in range(unknown):
            right[i] = -residual[free[i]]


@routine("iii", "d")
def solve(system, solver, calls):
    """Solve for the correction with the kept tangent, rotated with the sections; it replaces the right-hand side."""
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    unknown, rollers, right = b[r.UNKNOWN], b[r.ROLLERS], reals(b[r.RIGHT])
    first_of, normal = wholes(b[r.ROLLER_FIRST]), reals(b[r.ROLLER_NORMAL])
    _fill_right(s, b)
    if rollers > 0:
        _roll(call[r.ROTATE_IN], rollers, first_of, normal, right)
    _rotate_vectors(b, call, -1.0)
    if b[r.EDGE] + b[r.CONDITIONS] > 0:
        _solve_bordered(call[r.SOLVE_BORDERED], solver, calls)
    else:
        _solve(call[r.SOLVE_BOTH], unknown, b[r.HALF], reals(b[r.ROWS]), right)
    _rotate_vectors(b, call, 1.0)
    if rollers > 0:
        _roll(call[r.ROTATE_BACK], rollers, first_of, normal, right)
    return 0.0


@routine("iii", "d", fastmath=FAST)
def correct(system, solver, calls):
    """Add corrections to the state; return the largest, relative to its scale."""
    s, b = wholes(system), wholes(solver)
    n, state, multipliers = s[r.SIZE], reals(b[r.STATE]), wholes(b[r.MULTIPLIERS])
    size = _correct(
        n,
        b[r.UNKNOWN],
        b[r.FIRST_FREE],
        state,
        reals(b[r.RIGHT]),
        wholes(b[r.FREE_DOFS]),
        reals(b[r.INVERSE_SCALE]),
        reals(s[r.FACTORS]),
        reals(b[r.CHANGE]),
    )
    for i in range(b[r.CONDITIONS]):
        state[n + multipliers[i]] = 0.0  # multipliers have no rates
        state[2 * n + multipliers[i]] = 0.0
    return size


@routine("iii", "d", fastmath=FAST)
def complete(system, solver, calls):
    """End a step and choose the order of the next one; return the largest change of p'', relative to its scale."""
    s, b = wholes(system), wholes(solver)
    return _complete(
        s[r.SIZE],
        b[r.PRESCRIBED],
        reals(b[r.STATE]),
        reals(b[r.BEFORE]),
        reals(b[r.DIFFERENCES]),
        reals(b[r.INVERSE_SCALE]),
        wholes(b[r.PRESCRIBED_DOFS]),
        reals(b[r.RULE]),
        reals(b[r.STATISTICS]),
    )
