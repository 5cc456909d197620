"""Stages of a time step of a long chain, which each part processes tile by tile, while a tile is in the cache.

Equations are eliminated as soon as they are complete, and corrections are added as soon as they are known. Otherwise
residual, matrix and state would pass through memory once for each of the operations.
"""

from beamfem.kernels import model_passes, motion_stages
from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.extrapolation import FAST, larger_of
from beamfem.kernels.pointers import at, caller, reals, slots, small_code, wholes

_in_two, _substitute = caller("iiii", "d"), caller("iiii", "d")
_factor, _solve = caller("iiiiiisrr", "d"), caller("iiiiiirr")
_rotate_pairs, _keep, _rotations = caller("idnirr"), caller("iiir"), caller("iiirr")


@inlined
def _factor_rows(b, call, part, start, stop):
    """Factor rows of a part; return the smallest ratio of a pivot to the row's original diagonal entry."""
    address, unknown, down, half = call[r.FACTOR_PART], b[r.UNKNOWN], b[r.ROWS_DOWN], b[r.HALF]
    reach, rows, space = slots(b[r.REACH]), reals(b[r.ROWS]), reals(b[r.STEP])
    return _factor(address, part, start, stop, unknown, down, half, reach, rows, space)


@inlined
def _solve_rows(b, address, part, start, stop):
    """Eliminate rows of a part, or solve for them."""
    rows, right = reals(b[r.ROWS]), reals(b[r.RIGHT])
    _solve(address, part, start, stop, b[r.UNKNOWN], b[r.ROWS_DOWN], b[r.HALF], rows, right)


@inlined
def _rotate_vectors(b, call, tile, sense):
    rotations, right = at(reals(b[r.ROTATIONS]), tile[r.TILE_NODE]), at(reals(b[r.RIGHT]), tile[r.DONE_UNKNOWN])
    runs, table = tile[r.TILE_RUNS_OF_PAIRS], wholes(tile[r.TILE_PAIR_TABLE])
    _rotate_pairs(call[r.ROTATE_PAIRS], runs, sense, table, b[r.NODE_STRIDE], rotations, right)


@routine("iiii", "d")
def assemble(part, system, solver, calls):
    """Do what `motion_stages.assemble` does, and eliminate equations, rotated back with the sections.

    A new tangent is factorised on the way; return the smallest ratio of a pivot to the row's original diagonal entry,
    negative.
    """
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    bounds, width, groups = motion_stages.bounds_of(b, part), 2 * b[r.HALF] + 1, wholes(s[r.GROUP_RECORDS])
    kept, rotations, worst = reals(b[r.KEPT]), reals(b[r.ROTATIONS]), 1.0
    for number in range(bounds[r.FIRST_TILE], bounds[r.END_TILE]):
        tile = at(wholes(b[r.TILES]), number * r.TILE_FIELDS)
        group, first, end = tile[r.TILE_GROUP], tile[r.NEW_UNKNOWN], tile[r.END_NEW_UNKNOWN]
        model_passes.clear(s, tile[r.NEW_COORDINATE], tile[r.END_NEW_COORDINATE], first * width, end * width)
        model_passes.add_group(s, system, group)
        if b[r.ROTATIONS_WANTED] != 0:
            if s[r.TANGENT] != 0:
                _keep(call[r.KEEP_DIRECTIONS], groups[group], tile[r.TILE_NODE], b[r.NODE_STRIDE], kept)
            _rotations(call[r.ROTATIONS_SINCE], groups[group], tile[r.TILE_NODE], b[r.NODE_STRIDE], kept, rotations)
        model_passes.add_springs(s, tile[r.DONE_SPRING], tile[r.END_DONE_SPRING])
        motion_stages.fill_right(s, b, tile[r.DONE_UNKNOWN], tile[r.END_DONE_UNKNOWN])
        _rotate_vectors(b, call, tile, -1.0)
        start, stop = tile[r.ROWS_BEFORE], tile[r.ROWS_WITH]
        if start < stop:
            if s[r.TANGENT] != 0:
                worst = min(worst, _factor_rows(b, call, part, start, stop))
            _solve_rows(b, call[r.LOWER_PART], part, start, stop)
    return -worst


@inlined
def _rest(b, own, part):
    """Return the first and the end of the rows that are eliminated after all tiles of a part."""
    last = at(wholes(b[r.TILES]), (own[r.END_TILE] - 1) * r.TILE_FIELDS)
    down = b[r.ROWS_DOWN]
    return last[r.ROWS_WITH], down if part == 0 else b[r.UNKNOWN] - 2 * b[r.HALF] - down


@routine("iiii", "d")
def factorise(part, system, solver, calls):
    """Factor the rest of the tangent; return the smallest ratio of a pivot to its diagonal entry, negative."""
    b = wholes(solver)
    start, stop = _rest(b, motion_stages.bounds_of(b, part), part)
    return -_factor_rows(b, wholes(calls), part, start, stop)


@routine("iiii", "d")
def lower_rest(part, system, solver, calls):
    """Eliminate the rest of the equations of both ends, and solve for what is between."""
    b = wholes(solver)
    start, stop = _rest(b, motion_stages.bounds_of(b, part), part)
    _solve_rows(b, wholes(calls)[r.LOWER_PART], part, start, stop)
    return 0.0


@routine("iiii", "d", fastmath=FAST)
def substitute(part, system, solver, calls):
    """Solve for the unknowns from what is between to both ends, and rotate them with the sections.

    Unless the corrections are wanted first, also add them to the state; return the largest, relative to its scale.
    """
    small_code()
    s, b, call = wholes(system), wholes(solver), wholes(calls)
    bounds, size = motion_stages.bounds_of(b, part), 0.0
    _, stop = _rest(b, bounds, part)
    for number in range(bounds[r.END_TILE] - 1, bounds[r.FIRST_TILE] - 1, -1):
        tile = at(wholes(b[r.TILES]), number * r.TILE_FIELDS)
        _solve_rows(b, call[r.UPPER_PART], part, tile[r.ROWS_BEFORE], stop)
        stop = tile[r.ROWS_BEFORE]
        _rotate_vectors(b, call, tile, 1.0)
        if b[r.STEP_WANTED] == 0:
            size = larger_of(size, motion_stages.correct_range(s, b, at(tile, r.DONE_COORDINATE)))
    return size


@routine("iiii", "d")
def solve(part, system, solver, calls):
    """Complete the elimination in both halves; where corrections are wanted before they are added, solve for them."""
    small_code()
    b, call = wholes(solver), wholes(calls)
    _in_two(call[r.IN_TWO], call[r.LOWER_REST], system, solver, calls)
    if b[r.STEP_WANTED] != 0:
        _in_two(call[r.IN_TWO], call[r.SUBSTITUTE], system, solver, calls)
    return 0.0


@routine("iiii", "d", fastmath=FAST)
def correct(part, system, solver, calls):
    """Add corrections to the state; return the largest, relative to its scale."""
    small_code()
    s, b = wholes(system), wholes(solver)
    if b[r.STEP_WANTED] == 0:
        return _substitute(wholes(calls)[r.SUBSTITUTE], part, system, solver, calls)
    return motion_stages.correct_range(s, b, at(motion_stages.bounds_of(b, part), r.FIRST_COORDINATE))
