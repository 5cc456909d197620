"""LU factorisation of a long band matrix from both ends to the middle, in parts that two threads may do at once.

As `two_sided`, but 2 w rows are left in the middle, so that what both ends change has no entry in common.
Each end advances by blocks of rows, as far as the rows that it needs are known. Factors are stored in blocks, those of
the lower triangle before those of the upper one: a solution then reads each once, where whole rows would pass through
memory twice.
"""

from functools import cache
from typing import NamedTuple

from beamfem.kernels.band import push
from beamfem.kernels.compiling import Routine, inlined, routine
from beamfem.kernels.elimination import FAST, elimination
from beamfem.kernels.pointers import at, fetch, room

BLOCK = 256  # rows
_AHEAD = 256  # numbers that are fetched ahead: one stream of factors alone does not fill the memory's bandwidth


class TwoSidedParts(NamedTuple):
    """Compiled functions for a half width.

    Parts 0 and 1 are the ends, part 2 is the middle, after both. factor(part, start, stop, n, m, w, reach, ab, space):
    smallest ratio of a pivot to the row's original diagonal entry, reach as for `two_sided`; then lower and, backwards,
    upper(part, start, stop, n, m, w, lu, x). m: rows eliminated downwards from the top, n - 2 w - m upwards; start,
    stop: those of this call, counted from their end, see `whole_blocks`.
    """

    factor: Routine
    lower: Routine
    upper: Routine


def whole_blocks(known: int, rows: int, w: int) -> int:
    """Return how many of the rows that an end eliminates can be eliminated where `known` rows are known."""
    return max(0, min(known, rows) - w) // BLOCK * BLOCK


@cache
def two_sided_parts(w: int) -> TwoSidedParts:
    """Return the compiled functions for a half width."""
    case, width, entries = f"half_width_{w}", 2 * w + 1, BLOCK * (2 * w + 1)
    _down = inlined(elimination(w, f"{case}_of_parts_down", backwards=False))
    _up = inlined(elimination(w, f"{case}_of_parts_up", backwards=True))

    @inlined
    def _store(way, start, stop, first):
        """Store whole blocks of rows; way -1: first is the last entry of the matrix, and all is counted backwards."""
        space = room(entries)
        for block in range(start // BLOCK, stop // BLOCK):
            rows = at(first, way * block * BLOCK * width)
            for i in range(BLOCK * width):
                space[i] = rows[way * i]
            above = at(rows, way * BLOCK * w)
            for row in range(BLOCK):
                for j in range(w):
                    rows[way * (row * w + j)] = space[row * width + j]
                for j in range(w + 1):
                    above[way * (row * (w + 1) + j)] = space[row * width + w + j]

    @inlined
    def _eliminate(way, start, stop, rows, first, x):
        last = room(w)
        for j in range(w):
            last[j] = x[way * (start - w + j)] if start > 0 else 0.0
        for block in range(start // BLOCK, (stop + BLOCK - 1) // BLOCK):
            begin, step = block * BLOCK, width if (block + 1) * BLOCK > rows else w
            for i in range(begin, min(begin + BLOCK, stop)):
                row, total = at(first, way * (begin * width + (i - begin) * step)), x[way * i]
                fetch(row, way * _AHEAD)
                for j in range(w):
                    total -= row[way * j] * last[j]
                push(last, w, total)
                x[way * i] = total

    @inlined
    def _substitute(way, start, stop, rows, first, x):
        last = room(w)
        for j in range(w):
            push(last, w, x[way * (stop + w - 1 - j)])
        for block in range((stop + BLOCK - 1) // BLOCK - 1, start // BLOCK - 1, -1):
            begin, lower, step = block * BLOCK, BLOCK * w, w + 1
            if begin + BLOCK > rows:
                lower, step = w, width
            for i in range(min(begin + BLOCK, stop) - 1, begin - 1, -1):
                row = at(first, way * (begin * width + lower + (i - begin) * step))
                fetch(row, -way * _AHEAD)
                total = x[way * i] * row[0]
                for j in range(w):
                    total -= row[way * (w - j)] * last[j]
                push(last, w, total)
                x[way * i] = total

    @inlined
    def _factor_middle(m, ab, space):
        end, worst = m + 2 * w, 1.0
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

    @inlined
    def _solve_middle(m, n, lu, x):
        end = m + 2 * w
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

    @routine("iiiiiisrr", "d", case, fastmath=FAST)
    def factor(part, start, stop, n, m, half, reach, ab, space):
        """Factor rows of ab (n, 2 w + 1) in place; space (n,): each part has its own."""
        other, middle, worst = n - 2 * w - m, m + w, 1.0
        if part == 0:
            if stop == m:
                for i in range(m, middle):
                    space[i] = abs(ab[i * width + w])
            worst = _down(middle + w, m, start, stop, w, 0, reach, ab, ab, space)
            _store(1, start, stop, ab)
        elif part == 1:
            if stop == other:
                for i in range(middle, middle + w):
                    space[i] = abs(ab[i * width + w])
            bottom, part_space = at(ab, n * width - 1), at(space, middle + w)
            worst = _up(other + 2 * w, other, start, stop, w, 0, at(reach, 2 * n - 1), bottom, ab, part_space)
            _store(-1, start, stop, bottom)
        else:
            worst = _factor_middle(m, ab, space)
        return worst

    @routine("iiiiiirr", case=case, fastmath={"contract"})
    def lower(part, start, stop, n, m, half, lu, x):
        """Eliminate rows of an end, or solve for the middle."""
        if part == 0:
            _eliminate(1, start, stop, m, lu, x)
        elif part == 1:
            _eliminate(-1, start, stop, n - 2 * w - m, at(lu, n * width - 1), at(x, n - 1))
        else:
            _solve_middle(m, n, lu, x)

    @routine("iiiiiirr", case=case, fastmath={"contract"})
    def upper(part, start, stop, n, m, half, lu, x):
        """Solve for rows of an end, those from `stop` on are known."""
        if part == 0:
            _substitute(1, start, stop, m, lu, x)
        elif part == 1:
            _substitute(-1, start, stop, n - 2 * w - m, at(lu, n * width - 1), at(x, n - 1))

    return TwoSidedParts(factor, lower, upper)
