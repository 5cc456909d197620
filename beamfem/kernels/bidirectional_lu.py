"""LU factorisation of a band matrix from both ends to the middle, for solutions with the same factors time and again.

Each unknown of a solution waits for the one before: from both ends at once, half as long, and the unknowns of both
ends are a pair of numbers. Rows 0 to m - 1 are eliminated downwards, as many at the end upwards; between them a block
of w or w + 1 rows is left.
"""

from functools import cache
from typing import NamedTuple

from beamfem.kernels.band import KNOWN, band, push
from beamfem.kernels.compiling import FAST, Routine, inlined, routine
from beamfem.kernels.elimination import elimination
from beamfem.kernels.pointers import at, room
from beamfem.kernels.simd import as_pairs, first_of, paired, second_of


class BidirectionalLU(NamedTuple):
    """Compiled functions for a half width.

    factor(n, w, reach, ab, original): smallest ratio of a pivot to the row's original diagonal entry; reach (2, n): see
    `elimination`, downwards and backwards; solve(n, w, lu, x).
    """

    factor: Routine
    solve: Routine


SHORT = 50  # unknowns: fewer are solved for as fast from one end


@cache
def bidirectional_lu(half_width: int, short: bool) -> BidirectionalLU:
    """Return the compiled functions for a half width; they work from one end if `short` or if it is not in `KNOWN`."""
    if half_width not in KNOWN:
        return _from_one_end(0)
    return _from_one_end(half_width) if short else _from_both_ends(half_width)


@cache
def _from_both_ends(w: int) -> BidirectionalLU:
    case, width, both = f"half_width_{w}", 2 * w + 1, 2 * w
    _down = inlined(elimination(w, f"{case}_down", backwards=False))
    _up = inlined(elimination(w, f"{case}_up", backwards=True))

    @inlined
    def _pair_rows(m, n, ab):
        """Put the factors of a row from the top and of one from the bottom side by side, as a solution reads them.

        The upper row has the pairs of the lower factor and its own inverse pivot, the lower row those of the upper one.
        """
        down, up = room(width), room(width)
        for i in range(m):
            upper, lower = at(ab, i * width), at(ab, (n - 1 - i) * width)
            for j in range(width):
                down[j] = upper[j]
                up[j] = lower[2 * w - j]
            for j in range(w):
                upper[2 * j], upper[2 * j + 1] = down[j], up[j]
                lower[2 * j], lower[2 * j + 1] = down[2 * w - j], up[2 * w - j]
            upper[2 * w], lower[2 * w] = down[w], up[w]

    @routine("iisrr", "d", case, fastmath=FAST)
    def factor(n, half, reach, ab, original):
        """Factor ab (n, 2 w + 1) in place, see `_pair_rows`; original (n,): space."""
        m = max(0, (n - w) // 2)
        end = n - m
        for i in range(m, end):
            original[i] = abs(ab[i * width + w])
        worst = _down(end, m, w, 0, reach, ab, ab, original)
        worst = min(worst, _up(end, m, w, 0, at(reach, 2 * n - 1), at(ab, n * width - 1), ab, at(original, end)))
        for k in range(m, end):
            pivot = at(ab, k * width + w - k)
            if pivot[k] == 0.0 or original[k] == 0.0:
                return 0.0
            worst = min(worst, abs(pivot[k]) / original[k])
            inverse = 1.0 / pivot[k]
            pivot[k] = inverse
            for i in range(k + 1, end):
                row = at(ab, i * width + w - i)
                multiplier = row[k] * inverse
                row[k] = multiplier
                for j in range(k + 1, end):
                    row[j] -= multiplier * pivot[j]
            for j in range(k + 1, end):
                pivot[j] *= inverse
        _pair_rows(m, n, ab)
        return worst

    @routine("iirr", case=case, fastmath={"contract"})
    def solve(n, half, lu, x):
        """Replace the right-hand side x (n,) by the solution."""
        m = max(0, (n - w) // 2)
        end, window = n - m, as_pairs(room(both))
        for j in range(w):
            window[2 * j] = paired(0.0, 0.0)
        for i in range(m):
            factors, total = as_pairs(at(lu, i * width)), paired(x[i], x[n - 1 - i])
            for j in range(w):
                total -= factors[2 * j] * window[2 * j]
            push(window, w, total)
            x[i], x[n - 1 - i] = first_of(total), second_of(total)
        for i in range(m, end):
            row, value = at(lu, i * width + w - i), x[i]
            for j in range(max(0, i - w), i):
                value -= row[j] * x[j]
            for j in range(end, min(n, i + w + 1)):
                value -= row[j] * x[j]
            x[i] = value
        for i in range(end - 1, m - 1, -1):
            row = at(lu, i * width + w - i)
            value = x[i] * row[i]
            for j in range(i + 1, end):
                value -= row[j] * x[j]
            x[i] = value
        if m == 0:
            return
        for j in range(w):
            push(window, w, paired(x[m + w - 1 - j], x[end - w + j]))
        for i in range(m - 1, -1, -1):
            other = at(lu, (n - 1 - i) * width)
            factors, total = as_pairs(other), paired(x[i] * lu[i * width + 2 * w], x[n - 1 - i] * other[2 * w])
            for j in range(w):
                total -= factors[2 * j] * window[2 * j]
            push(window, w, total)
            x[i], x[n - 1 - i] = first_of(total), second_of(total)

    return BidirectionalLU(factor, solve)


@cache
def _from_one_end(known: int) -> BidirectionalLU:
    case = f"from_one_end_half_width_{known or 'any'}"
    _factor, _solve_lower, _solve_upper = (inlined(function) for function in band(known))

    @routine("iisrr", "d", case, fastmath=FAST)
    def factor(n, half, reach, ab, original):
        """The same from one end."""
        return _factor(n, n, half, 0, reach, ab, ab, original)

    @routine("iirr", case=case, fastmath={"contract"})
    def solve(n, half, lu, x):
        """Do the same as `solve` of `_from_both_ends`, from one end."""
        _solve_lower(n, n, half, lu, x)
        _solve_upper(n, n, half, lu, x)

    return BidirectionalLU(factor, solve)


ANY = _from_one_end(0)  # those for any half width
