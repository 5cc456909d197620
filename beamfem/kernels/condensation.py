"""Condensation of a band with a border to its edge: unknowns that are coupled beyond the band, and multipliers.

The edge u and the unknowns x of the inside, which the band B alone couples: [B, C; R, D] [x, u] = [r, s], and so
(D - R B^-1 C) u = s - R B^-1 r. What conditions hold is at rest while the edge is fixed, so B has its digits even where
they alone hold a part. The condensed matrix is inverted by exchanges of one or two diagonal entries (Bunch and Parlett
1971), whose signs count negative eigenvalues (Haynsworth 1968).
"""

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import Border
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Reals

_SINGLE = 0.41  # of the largest product of a pair: square of the smallest diagonal entry that is exchanged by itself


@inlined
def _take_out(border):
    """Take the edge out of the band: into columns C, rows R and the condensed matrix; the band keeps its diagonal."""
    n, w, edge, m, rows = border.unknown, border.half, border.edge, border.edge + border.conditions, border.rows
    numbers, small, width = border.numbers, border.condensed, 2 * border.half + 1
    for i in range(m * m):
        small[i] = border.entries[i]
    for own in range(edge):
        column, number, kept = at(border.columns, own * n), numbers[own], at(border.beside, own * width)
        for i in range(n):
            column[i] = 0.0
        for i in range(max(0, number - w), min(n, number + w + 1)):
            column[i] = rows[i * width + w + number - i]
        for other in range(edge):
            small[other * m + own] += column[numbers[other]]
        for i in range(width):
            kept[i] = rows[number * width + i]
    for own in range(edge):
        number = numbers[own]
        diagonal = abs(rows[number * width + w])
        for i in range(max(0, number - w), min(n, number + w + 1)):
            rows[i * width + w + number - i] = 0.0
            rows[number * width + w + i - number] = 0.0
        rows[number * width + w] = diagonal if diagonal > 0.0 else 1.0
        for other in range(edge):
            border.columns[other * n + number] = 0.0
            place = numbers[other] - number + w
            if place >= 0 and place < width:
                border.beside[own * width + place] = 0.0


@inlined
def _along_row(border, own, x):
    """Return the product of a row R with x (n,)."""
    n, w, number, total = border.unknown, border.half, border.numbers[own], 0.0
    row = at(border.beside, own * (2 * w + 1) + w - number)
    for i in range(max(0, number - w), min(n, number + w + 1)):
        total += row[i] * x[i]
    return total


@inlined
def _scale_conditions(border):
    """Scale conditions to the stiffest coordinate of the edge, which is returned; `sizes` keeps diagonal and scale."""
    edge, m, small, sizes, stiffest = border.edge, border.edge + border.conditions, border.condensed, border.sizes, 0.0
    for i in range(edge):
        sizes[i], sizes[m + i] = abs(small[i * (m + 1)]), 1.0
        stiffest = max(stiffest, sizes[i])
    stiffest = stiffest if stiffest > 0.0 else 1.0
    for i in range(edge, m):
        largest = 0.0
        for j in range(edge):
            largest = max(largest, abs(small[i * m + j]))
        sizes[m + i] = stiffest / largest if largest > 0.0 else 1.0
        sizes[i] = stiffest if largest > 0.0 else abs(small[i * (m + 1)])
    for i in range(m):
        for j in range(m):
            small[i * m + j] *= sizes[m + i] * sizes[m + j]


@inlined
def _exchange(m, small, k):
    """Exchange one diagonal entry."""
    row, inverse = at(small, k * m), 1.0 / small[k * (m + 1)]
    row[k] = 1.0
    for j in range(m):
        row[j] *= inverse
    for i in range(m):
        if i != k:
            other = at(small, i * m)
            factor = other[k]
            other[k] = 0.0
            for j in range(m):
                other[j] -= factor * row[j]


@inlined
def _exchange_pair(m, small, r, s):
    """Exchange two diagonal entries at once."""
    one, two = at(small, r * m), at(small, s * m)
    a, b, c, d = one[r], one[s], two[r], two[s]
    determinant = a * d - b * c
    one[r], one[s], two[r], two[s] = 1.0, 0.0, 0.0, 1.0
    for j in range(m):
        first, second = one[j], two[j]
        one[j] = (d * first - b * second) / determinant
        two[j] = (a * second - c * first) / determinant
    for i in range(m):
        if i != r and i != s:
            other = at(small, i * m)
            first, second = other[r], other[s]
            other[r], other[s] = 0.0, 0.0
            for j in range(m):
                other[j] -= first * one[j] + second * two[j]


@inlined
def _invert(border):
    """Invert the condensed matrix and count its negative eigenvalues; return the smallest ratio of a pivot, or 0."""
    m, small, sizes, ratio = border.edge + border.conditions, border.condensed, border.sizes, 1.0
    waiting, left = at(sizes, 2 * m), m
    for i in range(m):
        waiting[i] = 1.0
    _scale_conditions(border)
    border.negative = 0
    while left > 0:
        one, r, s, single, pair = 0, 0, 0, 0.0, 0.0
        for i in range(m):
            if waiting[i] > 0.0:
                if abs(small[i * (m + 1)]) > single:
                    one, single = i, abs(small[i * (m + 1)])
                for j in range(i + 1, m):
                    product = abs(small[i * m + j] * small[j * m + i])
                    if waiting[j] > 0.0 and product > pair:
                        r, s, pair = i, j, product
        if not single + pair > 0.0:
            ratio, left = 0.0, 0
        elif single * single >= _SINGLE * pair:
            ratio = min(ratio, single / sizes[one] if sizes[one] > 0.0 else 0.0)
            border.negative += small[one * (m + 1)] < 0.0
            _exchange(m, small, one)
            waiting[one] = 0.0
            left -= 1
        else:
            a, d = small[r * (m + 1)], small[s * (m + 1)]
            determinant = a * d - small[r * m + s] * small[s * m + r]
            size = sizes[r] * sizes[s]
            ratio = min(ratio, abs(determinant) / size if size > 0.0 else 0.0)
            border.negative += 1 if determinant < 0.0 else 2 if a + d < 0.0 else 0
            _exchange_pair(m, small, r, s)
            waiting[r], waiting[s] = 0.0, 0.0
            left -= 2
    for i in range(m):
        for j in range(m):
            small[i * m + j] *= sizes[m + i] * sizes[m + j]
    return ratio


@routine()
def factor_condensed(border: Border) -> float:
    """Factor band and border in place, and count the negative eigenvalues on the null space of the conditions.

    Return the smallest ratio of a pivot to an original diagonal entry, 0 if one is zero.
    """
    n, edge, m = border.unknown, border.edge, border.edge + border.conditions
    _take_out(border)
    ratio = border.factor(n, border.half, border.reach, border.rows, border.signs)
    if not ratio > 0.0:
        return 0.0
    for own in range(edge):
        x = at(border.columns, own * n)
        border.solve(n, border.half, border.rows, x)
        for other in range(edge):
            border.condensed[other * m + own] -= _along_row(border, other, x)
    ratio = min(ratio, _invert(border))
    border.negative -= border.conditions
    for i in range(n):
        border.negative += border.signs[i] < 0.0
    return ratio


@routine()
def solve_condensed(border: Border, right: Reals) -> None:
    """Replace a right-hand side (n + k,) by the solution, multipliers last."""
    n, edge, m, numbers = border.unknown, border.edge, border.edge + border.conditions, border.numbers
    values = border.sizes
    for own in range(edge):
        values[own] = right[numbers[own]]
        right[numbers[own]] = 0.0
    border.solve(n, border.half, border.rows, right)
    for own in range(edge):
        values[own] -= _along_row(border, own, right)
    for i in range(edge, m):
        values[i] = right[n + i - edge]
    for own in range(m):
        total, row = 0.0, at(border.condensed, own * m)
        for j in range(m):
            total += row[j] * values[j]
        if own < edge:
            x = at(border.columns, own * n)
            for i in range(n):
                right[i] -= total * x[i]
            values[m + own] = total
        else:
            right[n + own - edge] = total
    for own in range(edge):
        right[numbers[own]] = values[m + own]
