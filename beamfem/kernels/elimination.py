"""Elimination of the rows of a band matrix, in pairs of pivots, so that rows pass through memory half as often.

ab (n, 2 w + 1) is factored in place, in row storage: row i holds A[i, i - w .. i + w]. L and U get unit diagonals, and
the diagonal holds the inverse pivots. If the half width is known to the compiler, a row is changed in whole lanes.
"""

from beamfem.kernels.compiling import FAST, Routine, inlined, routine
from beamfem.kernels.pointers import at
from beamfem.kernels.simd import WIDTH, as_rows, merged, power_of_two, zeros

_IN_ORDER = {"contract", "nsz"}  # two multiplications with addition for a number, where reassociation takes three


def elimination(known: int, case: str, backwards: bool) -> Routine:
    """Return the factorisation for a half width, 0: any; backwards: from the last row to the first.

    eliminate(n, count, half, eliminates, reach, ab, right, original): the smallest ratio of a pivot to the row's
    original diagonal entry. reach (n,): end of the rows that a row and those above are coupled to, which are the
    only ones that change. right (n,): eliminated on the way if `eliminates`, `solve_upper` does the rest. original
    (count,): filled with the original diagonal entries, with the signs of the pivots; so many pivots are taken in all,
    and the rows below keep what is left of the matrix, their Schur complement. Backwards ab, right and reach are the
    last entries, and rows the last ones first.
    """
    return _in_lanes(known, case, -1 if backwards else 1) if known else _one_by_one(case, -1 if backwards else 1)


@inlined
def _signed(size, pivot):
    """Return a size with the sign of a pivot, or of its inverse."""
    return -size if pivot < 0.0 else size


@inlined
def _take_pivot(way, k, n, w, inverse, eliminates, ab, right):
    """Eliminate below one pivot, the last one of an odd number, whose inverse is given."""
    width = 2 * w + 1
    top = at(ab, way * k * width)
    top[way * w] = inverse
    for i in range(k + 1, min(n, k + w + 1)):
        row = at(ab, way * (i * width + w + k - i))
        first = row[0] * inverse
        row[0] = first
        for j in range(1, w + 1):
            row[way * j] -= first * top[way * (w + j)]
        if eliminates != 0:
            right[way * i] -= first * right[way * k]
    for j in range(1, w + 1):
        top[way * (w + j)] *= inverse


def _in_lanes(w: int, case: str, way: int) -> Routine:
    width, wide, outside = 2 * w + 1, w > WIDTH, max(0, WIDTH - w)

    def place(first: int) -> int:
        """Return the first number in memory of the lanes that start `first` numbers on."""
        return first if way > 0 else 1 - first - WIDTH

    # The last lanes of a row end where those of the pivots end; if w > WIDTH, the first lanes overlap with them. Lanes
    # before those that change are called outside.
    last_of_pivot, last_of_row, last_of_end = place(width - WIDTH), place(w + 2 - WIDTH), place(w + 1 - WIDTH)
    first_of_pivot, first_of_row, first_of_end = place(w + 1), place(2), place(1)
    next_of_pivot, next_of_first = place(width + 1 - WIDTH), place(w + 2)

    @inlined
    def without_outside(lanes, others):
        """Return lanes in which those outside are replaced by others."""
        return merged(others, lanes, outside) if way > 0 else merged(lanes, others, WIDTH - outside)

    @inlined
    def without_last(lanes):
        """Return lanes in which the one after the end of a row is zero."""
        return merged(lanes, zeros(), WIDTH - 1) if way > 0 else merged(zeros(), lanes, 1)

    @routine("iiiisrrr", "d", case, fastmath=_IN_ORDER)
    def eliminate(n, count, half, eliminates, reach, ab, right, original):
        worst, ones = 1.0, zeros() + 1.0
        for i in range(min(count, w)):
            original[i] = abs(ab[way * (i * width + w)])
        # entries are multiplied in a unit near their size, as the square of 1e200 is too large for a number; a power of
        # two changes no digit
        size = 1.0
        if count > 0:
            size = power_of_two(original[0])
            if size == 0.0:
                return 0.0
        unit = 1.0 / size
        for k in range(0, count, 2):
            top = at(ab, way * k * width)
            if k + w < count:
                original[k + w] = abs(ab[way * ((k + w) * width + w)])
            a = top[way * w]
            if a == 0.0 or original[k] == 0.0:
                return 0.0
            if abs(a) < worst * original[k]:
                worst = abs(a) / original[k]
            original[k] = _signed(original[k], a)
            inverse = 1.0 / a
            if k + 1 == count:
                _take_pivot(way, k, n, w, inverse, eliminates, ab, right)
                break
            below = at(ab, way * (k + 1) * width)
            if k + 1 + w < count:
                original[k + 1 + w] = abs(ab[way * ((k + 1 + w) * width + w)])
            # the second pivot is the determinant of both over the first one: its division waits for no other division
            own, beside, c = a * unit, top[way * (w + 1)] * unit, below[way * (w - 1)]
            determinant = own * below[way * w] - c * beside
            inverse_determinant, pivot = 1.0 / determinant, abs(determinant * inverse) * size
            if determinant == 0.0 or inverse_determinant == 0.0 or original[k + 1] == 0.0:  # zero inverse: infinite
                return 0.0
            if pivot < worst * original[k + 1]:
                worst = pivot / original[k + 1]
            inverse_below, multiplier = own * inverse_determinant, c * inverse
            original[k + 1] = _signed(original[k + 1], inverse_below)
            upper, lower = 0.0, 0.0
            if eliminates != 0:
                upper = right[way * k]
                lower = right[way * (k + 1)] - multiplier * upper
                right[way * (k + 1)] = lower
            top_lanes, below_lanes = as_rows(top), as_rows(below)
            high, low = top_lanes[last_of_pivot], below_lanes[last_of_pivot]
            change = without_outside(without_last(top_lanes[next_of_pivot]), zeros())
            low -= multiplier * change
            change_below = without_outside(low, zeros())
            first_high, first_low, first_change = zeros(), zeros(), zeros()
            if wide:
                first_high, first_change = top_lanes[first_of_pivot], top_lanes[next_of_first]
                first_low = below_lanes[first_of_pivot] - multiplier * first_change
            end = min(n, reach[way * (k + 1)])
            for i in range(k + 2, min(end, k + w + 1)):
                row = at(ab, way * (i * width + w + k - i))
                lanes, one, two = as_rows(row), row[0], row[way]
                first, second = one * inverse, (two * own - one * beside) * inverse_determinant
                changed = lanes[last_of_row] - first * change - second * change_below
                if wide:
                    lanes[first_of_row] = lanes[first_of_row] - first * first_change - second * first_low
                lanes[last_of_row] = changed
                row[0], row[way] = first, second
                if eliminates != 0:
                    right[way * i] = right[way * i] - first * upper - second * lower
            if k + w + 1 < end:
                row = at(ab, way * (k + w + 1) * width)
                lanes, second = as_rows(row), row[0] * inverse_below
                changed = lanes[last_of_end] - second * change_below
                if wide:
                    lanes[first_of_end] = lanes[first_of_end] - second * first_low
                lanes[last_of_end] = changed
                row[0] = second
                if eliminates != 0:
                    right[way * (k + w + 1)] -= second * lower
            if wide:
                top_lanes[first_of_pivot], below_lanes[first_of_pivot] = first_high * inverse, first_low * inverse_below
            top_lanes[last_of_pivot] = high * without_outside(ones * inverse, ones)
            below_lanes[last_of_pivot] = low * without_outside(ones * inverse_below, ones)
            top[way * w], below[way * (w - 1)], below[way * w] = inverse, multiplier, inverse_below
        return worst

    return eliminate


def _one_by_one(case: str, way: int) -> Routine:
    @routine("iiiisrrr", "d", case, fastmath=FAST)
    def eliminate(n, count, half, eliminates, reach, ab, right, original):
        w, width, worst = half, 2 * half + 1, 1.0
        for i in range(min(count, w)):
            original[i] = abs(ab[way * (i * width + w)])
        for k in range(0, count, 2):
            top = at(ab, way * k * width)
            if k + w < count:
                original[k + w] = abs(ab[way * ((k + w) * width + w)])
            if top[way * w] == 0.0 or original[k] == 0.0:
                return 0.0
            worst = min(worst, abs(top[way * w]) / original[k])
            inverse = 1.0 / top[way * w]
            original[k] = _signed(original[k], inverse)
            if k + 1 == count:
                _take_pivot(way, k, n, w, inverse, eliminates, ab, right)
                break
            top[way * w] = inverse
            below = at(ab, way * (k + 1) * width)
            if k + 1 + w < count:
                original[k + 1 + w] = abs(ab[way * ((k + 1 + w) * width + w)])
            first = below[way * (w - 1)] * inverse
            below[way * (w - 1)] = first
            for j in range(1, w + 1):
                below[way * (w - 1 + j)] -= first * top[way * (w + j)]
            if below[way * w] == 0.0 or original[k + 1] == 0.0:
                return 0.0
            worst = min(worst, abs(below[way * w]) / original[k + 1])
            inverse_below = 1.0 / below[way * w]
            original[k + 1] = _signed(original[k + 1], inverse_below)
            below[way * w] = inverse_below
            upper, lower = 0.0, 0.0
            if eliminates != 0:
                right[way * (k + 1)] -= first * right[way * k]
                upper, lower = right[way * k], right[way * (k + 1)]
            beside = top[way * (w + 1)]
            end = min(n, reach[way * (k + 1)])
            for i in range(k + 2, min(end, k + w + 1)):
                row = at(ab, way * (i * width + w + k - i))
                first = row[0] * inverse
                second = (row[way] - first * beside) * inverse_below
                row[0], row[way] = first, second
                for j in range(2, w + 1):
                    row[way * j] -= first * top[way * (w + j)] + second * below[way * (w + j - 1)]
                row[way * (w + 1)] -= second * below[way * 2 * w]
                if eliminates != 0:
                    right[way * i] -= first * upper + second * lower
            if k + w + 1 < end:
                row = at(ab, way * (k + w + 1) * width)
                second = row[0] * inverse_below
                row[0] = second
                for j in range(1, w + 1):
                    row[way * j] -= second * below[way * (w + j)]
                if eliminates != 0:
                    right[way * (k + w + 1)] -= second * lower
            for j in range(1, w + 1):
                top[way * (w + j)] *= inverse
                below[way * (w + j)] *= inverse_below
        return worst

    return eliminate
