"""LU factorisation of a band matrix from both ends to the middle, for solutions with the same factors time and again.

Each unknown of a solution waits for the one before: from both ends at once, half as long. Rows 0 to m - 1 are
eliminated downwards, as many at the end upwards, and what is left between them is a block of w or w + 1 rows.
"""

from functools import cache
from typing import NamedTuple

from beamfem.kernels.band import FAST, KNOWN, band, elimination, push
from beamfem.kernels.compiling import Routine, inlined, routine
from beamfem.kernels.pointers import at, room


class TwoSided(NamedTuple):
    """Compiled functions for a half width.

    factor(n, w, ab, original): smallest ratio of a pivot to the row's original diagonal entry; solve(n, w, lu, x).
    In parts, 0 and 1 of which two threads may do at once, and 2 after them: factor_part(part, n, w, ab, original) and
    lower_part, then upper_part(part, n, w, lu, x), where there are such.
    """

    factor: Routine
    solve: Routine
    parts: tuple[Routine, ...] = ()


SHORT = 50  # unknowns: fewer are solved for as fast from one end


@cache
def two_sided(half_width: int, short: bool, apart: bool = False) -> TwoSided:
    """Return the compiled functions for a half width: of its own where it is a usual one; short: from one end.

    apart: 2 w or 2 w + 1 rows are left in the middle, so that what both ends change has no entry in common.
    """
    if half_width not in KNOWN:
        return _one_sided(0)
    return _one_sided(half_width) if short else _two_sided(half_width, 2 * half_width if apart else half_width)


def _two_sided(w: int, left: int) -> TwoSided:
    case, width = f"half_width_{w}" + ("_apart" if left > w else ""), 2 * w + 1
    _down = inlined(elimination(w, f"{case}_down", backwards=False))
    _up = inlined(elimination(w, f"{case}_up", backwards=True))

    @inlined
    def _above(n, ab, original):
        m = max(0, (n - left) // 2)
        return _down(n - m, m, w, 0, ab, ab, original)

    @inlined
    def _below(n, ab, original):
        m = max(0, (n - left) // 2)
        return _up(n - m, m, w, 0, at(ab, n * width - 1), ab, at(original, n - m))

    @inlined
    def _middle(n, ab, original):
        m = max(0, (n - left) // 2)
        end, worst = n - m, 1.0
        for k in range(m, end):
            pivot, reached = at(ab, k * width + w - k), min(end, k + w + 1)
            if pivot[k] == 0.0 or original[k] == 0.0:
                return 0.0
            worst = min(worst, abs(pivot[k]) / original[k])
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
    def _solve_middle(n, lu, x):
        m = max(0, (n - left) // 2)
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

    @routine("iirr", "d", case, fastmath=FAST)
    def factor(n, half, ab, original):
        """Factor ab (n, 2 w + 1) in place; original (n,): space. See `band.Band` for what is left in it."""
        m = max(0, (n - left) // 2)
        for i in range(m, n - m):
            original[i] = abs(ab[i * width + w])
        worst = _above(n, ab, original)
        worst = min(worst, _below(n, ab, original))
        return min(worst, _middle(n, ab, original))

    @routine("iirr", case=case, fastmath={"contract"})
    def solve(n, half, lu, x):
        """Replace the right-hand side x (n,) by the solution."""
        m = max(0, (n - left) // 2)
        end, above, below = n - m, room(w), room(w)
        for j in range(w):
            above[j] = 0.0
            below[j] = 0.0
        for i in range(m):
            row, other = at(lu, i * width), at(lu, (n - i) * width - 1)
            total, sum_below = x[i], x[n - 1 - i]
            for j in range(w):
                total -= row[j] * above[j]
                sum_below -= other[-j] * below[j]
            push(above, w, total)
            push(below, w, sum_below)
            x[i], x[n - 1 - i] = total, sum_below
        _solve_middle(n, lu, x)
        if m == 0:
            return
        for j in range(w):
            push(above, w, x[m + w - 1 - j])
            push(below, w, x[end - w + j])
        for i in range(m - 1, -1, -1):
            row, other = at(lu, i * width), at(lu, (n - i) * width - 1)
            total, sum_below = x[i] * row[w], x[n - 1 - i] * other[-w]
            for j in range(w):
                total -= row[2 * w - j] * above[j]
                sum_below -= other[j - 2 * w] * below[j]
            push(above, w, total)
            push(below, w, sum_below)
            x[i], x[n - 1 - i] = total, sum_below

    if left == w:
        return TwoSided(factor, solve)

    @routine("iiirr", "d", case, fastmath=FAST)
    def factor_part(part, n, half, ab, original):
        """Do a part of `factor`; return the smallest ratio of a pivot of it."""
        m = max(0, (n - left) // 2)
        if part == 0:
            for i in range(m, m + w):
                original[i] = abs(ab[i * width + w])
            return _above(n, ab, original)
        if part == 1:
            for i in range(m + w, n - m):
                original[i] = abs(ab[i * width + w])
            return _below(n, ab, original)
        return _middle(n, ab, original)

    @routine("iiirr", case=case, fastmath={"contract"})
    def lower_part(part, n, half, lu, x):
        """Do a part of the way down of `solve`."""
        m, last = max(0, (n - left) // 2), room(w)
        for j in range(w):
            last[j] = 0.0
        if part == 0:
            for i in range(m):
                row, total = at(lu, i * width), x[i]
                for j in range(w):
                    total -= row[j] * last[j]
                push(last, w, total)
                x[i] = total
        elif part == 1:
            for i in range(m):
                row, total = at(lu, (n - i) * width - 1), x[n - 1 - i]
                for j in range(w):
                    total -= row[-j] * last[j]
                push(last, w, total)
                x[n - 1 - i] = total
        else:
            _solve_middle(n, lu, x)

    @routine("iiirr", case=case, fastmath={"contract"})
    def upper_part(part, n, half, lu, x):
        """Do a part of the way up of `solve`."""
        m, last = max(0, (n - left) // 2), room(w)
        end = n - m
        if part == 0:
            for j in range(w):
                push(last, w, x[m + w - 1 - j])
            for i in range(m - 1, -1, -1):
                row, total = at(lu, i * width), x[i] * at(lu, i * width)[w]
                for j in range(w):
                    total -= row[2 * w - j] * last[j]
                push(last, w, total)
                x[i] = total
        elif part == 1:
            for j in range(w):
                push(last, w, x[end - w + j])
            for i in range(m - 1, -1, -1):
                row, total = at(lu, (n - i) * width - 1), x[n - 1 - i] * at(lu, (n - i) * width - 1)[-w]
                for j in range(w):
                    total -= row[j - 2 * w] * last[j]
                push(last, w, total)
                x[n - 1 - i] = total

    return TwoSided(factor, solve, (factor_part, lower_part, upper_part))


@cache
def _one_sided(known: int) -> TwoSided:
    case = f"one_sided_half_width_{known or 'any'}"
    _factor, _solve_lower, _solve_upper = (inlined(own) for own in band(known))

    @routine("iirr", "d", case, fastmath=FAST)
    def factor(n, half, ab, original):
        """The same from one end."""
        return _factor(n, n, half, 0, ab, ab, original)

    @routine("iirr", case=case, fastmath={"contract"})
    def solve(n, half, lu, x):
        """The same from one end."""
        _solve_lower(n, n, half, lu, x)
        _solve_upper(n, n, half, lu, x)

    return TwoSided(factor, solve)
