"""LU factorisation of a complex band matrix, real and imaginary parts apart, each in row storage as in `band`.

No pivoting: M + z C + z^2 K with symmetric positive M and K has large pivots in any order unless z^2 is negative.
L and U get unit diagonals, and the diagonal holds the inverse pivots.
"""

import math
from functools import cache
from typing import NamedTuple

from beamfem.kernels.band import KNOWN, push
from beamfem.kernels.compiling import FAST, Routine, routine
from beamfem.kernels.pointers import at, room
from beamfem.kernels.simd import as_pairs, first_of, paired, second_of


class ComplexBand(NamedTuple):
    """Compiled functions for a half width.

    factor(n, w, reach, re, im, original): smallest ratio of a pivot to the row's original diagonal entry; reach (n,):
    see `elimination`; original (n,): space; solve(n, w, re, im, x, y): the solution replaces the right-hand side
    x + i y.
    """

    factor: Routine
    solve: Routine


def complex_band(half_width: int) -> ComplexBand:
    """Return the compiled functions for a half width, specialised for those in `KNOWN`."""
    return _complex_band(half_width if half_width in KNOWN else 0)


@cache
def _complex_band(known: int) -> ComplexBand:
    case = f"half_width_{known or 'any'}"

    @routine("iisrrr", "d", case, fastmath=FAST)
    def factor(n, half, reach, re, im, original):
        w = known if known > 0 else half
        width, worst = 2 * w + 1, 1.0
        for k in range(n):
            original[k] = math.sqrt(re[k * width + w] ** 2 + im[k * width + w] ** 2)
        for k in range(n):
            place = k * width + w
            size = re[place] * re[place] + im[place] * im[place]
            if not (size > 0.0 and original[k] > 0.0):
                return 0.0
            worst = min(worst, math.sqrt(size) / original[k])
            a, b = re[place] / size, -im[place] / size
            re[place], im[place] = a, b
            top_re, top_im = at(re, place + 1), at(im, place + 1)
            for i in range(k + 1, min(min(n, reach[k]), k + w + 1)):
                row_re, row_im = at(re, i * width + w + k - i), at(im, i * width + w + k - i)
                c, d = row_re[0] * a - row_im[0] * b, row_re[0] * b + row_im[0] * a
                row_re[0], row_im[0] = c, d
                for j in range(w):
                    row_re[j + 1] -= c * top_re[j] - d * top_im[j]
                    row_im[j + 1] -= c * top_im[j] + d * top_re[j]
            for j in range(w):
                x, y = top_re[j], top_im[j]
                top_re[j], top_im[j] = x * a - y * b, x * b + y * a
        return worst

    return ComplexBand(factor, _solve_known(known, case) if known else _solve)


def _solve_known(known: int, case: str) -> Routine:
    width, both = 2 * known + 1, 2 * known

    @routine("iirrrr", case=case, fastmath={"contract"})
    def solve(n, half, re, im, x, y):
        """Do the same as `_solve`, with pairs of real and imaginary parts, the last ones in registers."""
        last, turned = as_pairs(room(both)), as_pairs(room(both))  # z and i z
        for j in range(known):
            last[2 * j], turned[2 * j] = paired(0.0, 0.0), paired(0.0, 0.0)
        for i in range(n):
            row_re, row_im, z = at(re, i * width), at(im, i * width), paired(x[i], y[i])
            for j in range(known):
                z -= paired(row_re[j], row_re[j]) * last[2 * j]
                z -= paired(row_im[j], row_im[j]) * turned[2 * j]
            x[i], y[i] = first_of(z), second_of(z)
            push(last, known, z)
            push(turned, known, paired(-second_of(z), first_of(z)))
        for j in range(known):
            last[2 * j], turned[2 * j] = paired(0.0, 0.0), paired(0.0, 0.0)
        for i in range(n - 1, -1, -1):
            row_re, row_im, a, b = at(re, i * width), at(im, i * width), x[i], y[i]
            c, d = row_re[known], row_im[known]
            z = paired(a * c - b * d, a * d + b * c)
            for j in range(known):
                z -= paired(row_re[2 * known - j], row_re[2 * known - j]) * last[2 * j]
                z -= paired(row_im[2 * known - j], row_im[2 * known - j]) * turned[2 * j]
            x[i], y[i] = first_of(z), second_of(z)
            push(last, known, z)
            push(turned, known, paired(-second_of(z), first_of(z)))

    return solve


@routine("iirrrr", fastmath={"contract"})
def _solve(n, half, re, im, x, y):
    """Replace a right-hand side x + i y by the solution."""
    width = 2 * half + 1
    for i in range(n):
        row_re, row_im, a, b = at(re, i * width + half - i), at(im, i * width + half - i), x[i], y[i]
        for k in range(max(0, i - half), i):
            a = a - row_re[k] * x[k] + row_im[k] * y[k]
            b = b - row_re[k] * y[k] - row_im[k] * x[k]
        x[i], y[i] = a, b
    for i in range(n - 1, -1, -1):
        row_re, row_im = at(re, i * width + half - i), at(im, i * width + half - i)
        a, b = x[i] * row_re[i] - y[i] * row_im[i], x[i] * row_im[i] + y[i] * row_re[i]
        for k in range(i + 1, min(n, i + half + 1)):
            a = a - row_re[k] * x[k] + row_im[k] * y[k]
            b = b - row_re[k] * y[k] - row_im[k] * x[k]
        x[i], y[i] = a, b


ANY = complex_band(0)  # those for any half width
