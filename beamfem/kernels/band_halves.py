"""LU factorisation of a long band matrix from both ends to the middle, in parts that two threads may do at once.

As `two_sided`, but 2 w or 2 w + 1 rows are left in the middle, so that what both ends change has no entry in common.
Factors of rows at both ends are stored in blocks, those of the lower triangle before those of the upper one: a
solution then reads each once, where whole rows would pass through memory twice.
"""

from functools import cache
from typing import NamedTuple

from beamfem.kernels.band import FAST, elimination, push
from beamfem.kernels.compiling import Routine, inlined, routine
from beamfem.kernels.pointers import at, room

_BLOCK = 256  # rows


class BandHalves(NamedTuple):
    """Compiled functions for a half width.

    Parts 0 and 1 are the ends, part 2 is the middle, after both. factor(part, n, w, reach, ab, space): smallest ratio
    of a pivot to the row's original diagonal entry, reach as for `two_sided`; lower, then upper(part, n, w, lu, x);
    solve(n, w, lu, x): all of both.
    """

    factor: Routine
    lower: Routine
    upper: Routine
    solve: Routine


@inlined
def _end_rows(n, w):
    """Return how many rows are eliminated from each end."""
    return max(0, (n - 2 * w) // 2)


@cache
def band_halves(w: int) -> BandHalves:
    """Return the compiled functions for a half width."""
    case, width, entries = f"half_width_{w}", 2 * w + 1, _BLOCK * (2 * w + 1)
    _down = inlined(elimination(w, f"{case}_of_halves_down", backwards=False))
    _up = inlined(elimination(w, f"{case}_of_halves_up", backwards=True))

    @inlined
    def _store(way, rows, first):
        """Store rows in blocks; way -1: first is the last entry of the matrix, and all is counted backwards."""
        space = room(entries)
        for block in range(rows // _BLOCK):
            own = at(first, way * block * _BLOCK * width)
            for i in range(_BLOCK * width):
                space[i] = own[way * i]
            above = at(own, way * _BLOCK * w)
            for row in range(_BLOCK):
                for j in range(w):
                    own[way * (row * w + j)] = space[row * width + j]
                for j in range(w + 1):
                    above[way * (row * (w + 1) + j)] = space[row * width + w + j]

    @inlined
    def _place(row, rows):
        """Return where the factors of a row begin, those of the lower triangle and of the upper one."""
        block, within = row // _BLOCK, row % _BLOCK
        if block == rows // _BLOCK:
            return row * width, row * width + w
        first = block * _BLOCK * width
        return first + within * w, first + _BLOCK * w + within * (w + 1)

    @inlined
    def _eliminate(way, rows, first, x):
        last = room(w)
        for j in range(w):
            last[j] = 0.0
        for block in range(rows // _BLOCK + 1):
            begin = block * _BLOCK
            lower, _ = _place(begin, rows)
            step = width if begin + _BLOCK > rows else w
            for i in range(begin, min(begin + _BLOCK, rows)):
                row, total = at(first, way * (lower + (i - begin) * step)), x[way * i]
                for j in range(w):
                    total -= row[way * j] * last[j]
                push(last, w, total)
                x[way * i] = total

    @inlined
    def _substitute(way, rows, first, x):
        last = room(w)
        for j in range(w):
            push(last, w, x[way * (rows + w - 1 - j)])
        for block in range(rows // _BLOCK, -1, -1):
            begin = block * _BLOCK
            _, upper = _place(begin, rows)
            step = width if begin + _BLOCK > rows else w + 1
            for i in range(min(begin + _BLOCK, rows) - 1, begin - 1, -1):
                row = at(first, way * (upper + (i - begin) * step))
                total = x[way * i] * row[0]
                for j in range(w):
                    total -= row[way * (w - j)] * last[j]
                push(last, w, total)
                x[way * i] = total

    @inlined
    def _solve_middle(m, n, lu, x):
        end = n - m
        for i in range(m, end):
            row, total = at(lu, i * width + w - i), x[i]
            for j in range(max(0, i - w), i):
                total -= row[j] * x[j]
            for j in range(end, min(n, i + w + 1)):
                total -= row[j] * x[j]
            x[i] = total
        for i in range(end - 1, m - 1, -1):
            row = at(lu, i * width + w - i)
            total = x[i] * row[i]
            for j in range(i + 1, min(end, i + w + 1)):
                total -= row[j] * x[j]
            x[i] = total

    @routine("iiisrr", "d", case, fastmath=FAST)
    def factor(part, n, half, reach, ab, space):
        """Factor a part of ab (n, 2 w + 1) in place; space (n,): each part has its own."""
        m, worst = _end_rows(n, w), 1.0
        end = n - m
        if part == 0:
            for i in range(m, m + w):
                space[i] = abs(ab[i * width + w])
            worst = _down(end, m, w, 0, reach, ab, ab, space)
            _store(1, m, ab)
        elif part == 1:
            for i in range(m + w, end):
                space[i] = abs(ab[i * width + w])
            worst = _up(end, m, w, 0, at(reach, 2 * n - 1), at(ab, n * width - 1), ab, at(space, end))
            _store(-1, m, at(ab, n * width - 1))
        else:
            for k in range(m, end):
                pivot, reached = at(ab, k * width + w - k), min(end, k + w + 1)
                if pivot[k] == 0.0 or space[k] == 0.0:
                    return 0.0
                worst = min(worst, abs(pivot[k]) / space[k])
                inverse = 1.0 / pivot[k]
                pivot[k] = inverse
                for i in range(k + 1, reached):
                    row = at(ab, i * width + w - i)
                    multiplier = row[k] * inverse
                    row[k] = multiplier
                    for j in range(k + 1, reached):
                        row[j] -= multiplier * pivot[j]
                for j in range(k + 1, reached):
                    pivot[j] *= inverse
        return worst

    @routine("iiirr", case=case, fastmath={"contract"})
    def lower(part, n, half, lu, x):
        """Eliminate from an end, or solve for the middle."""
        m = _end_rows(n, w)
        if part == 0:
            _eliminate(1, m, lu, x)
        elif part == 1:
            _eliminate(-1, m, at(lu, n * width - 1), at(x, n - 1))
        else:
            _solve_middle(m, n, lu, x)

    @routine("iiirr", case=case, fastmath={"contract"})
    def upper(part, n, half, lu, x):
        """Solve for an end."""
        m = _end_rows(n, w)
        if part == 0:
            _substitute(1, m, lu, x)
        elif part == 1:
            _substitute(-1, m, at(lu, n * width - 1), at(x, n - 1))

    @routine("iirr", case=case, fastmath={"contract"})
    def solve(n, half, lu, x):
        """Replace the right-hand side x (n,) by the solution; both ends in turns, so that their latencies overlap."""
        m, above, below = _end_rows(n, w), room(w), room(w)
        end_of_lu, end_of_x = at(lu, n * width - 1), at(x, n - 1)
        for j in range(w):
            above[j] = 0.0
            below[j] = 0.0
        for block in range(m // _BLOCK + 1):
            begin = block * _BLOCK
            first, _ = _place(begin, m)
            step = width if begin + _BLOCK > m else w
            for i in range(begin, min(begin + _BLOCK, m)):
                own = first + (i - begin) * step
                row, other, total, sum_below = at(lu, own), at(end_of_lu, -own), x[i], end_of_x[-i]
                for j in range(w):
                    total -= row[j] * above[j]
                    sum_below -= other[-j] * below[j]
                push(above, w, total)
                push(below, w, sum_below)
                x[i], end_of_x[-i] = total, sum_below
        _solve_middle(m, n, lu, x)
        for j in range(w):
            push(above, w, x[m + w - 1 - j])
            push(below, w, x[n - m - w + j])
        for block in range(m // _BLOCK, -1, -1):
            begin = block * _BLOCK
            _, first = _place(begin, m)
            step = width if begin + _BLOCK > m else w + 1
            for i in range(min(begin + _BLOCK, m) - 1, begin - 1, -1):
                own = first + (i - begin) * step
                row, other = at(lu, own), at(end_of_lu, -own)
                total, sum_below = x[i] * row[0], end_of_x[-i] * other[0]
                for j in range(w):
                    total -= row[w - j] * above[j]
                    sum_below -= other[j - w] * below[j]
                push(above, w, total)
                push(below, w, sum_below)
                x[i], end_of_x[-i] = total, sum_below

    return BandHalves(factor, lower, upper, solve)
