"""LU factorisation of a band matrix in row storage: row i holds A[i, i - w .. i + w]; L and U get unit diagonals.

No pivoting: tangents of a supported beam have strong diagonals. Growth is watched, and whoever calls can then ask
SciPy's pivoted solver. Where the half width is known to the compiler, loops are unrolled and a solution's last w values
stay in registers: each value then waits for one multiplication, not for memory.
"""

from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}
ANY_WIDTH = (0.0,)
_KNOWN = (5, 7, 8, 9, 11, 14)  # chains of bilinear, quadratic and cubic elements, and of orders 3 and 4 with rotations


def known_width(half_width: int) -> tuple[float, ...]:
    """Return a window of zeros of this half width, a type that has compiled code of its own, or one for all others."""
    return (0.0,) * half_width if half_width in _KNOWN else ANY_WIDTH


@kernel(nogil=True, fastmath=FAST)
def factor(ab, right, original, window):
    """Factor in place, ab (n, 2 w + 1); return the smallest ratio of a pivot to the row's original diagonal entry.

    The diagonal holds the inverse pivots then. right (n,) or empty: eliminated on the way, `solve_upper` does the rest.
    original: space, as many pivots as it is long are taken (n at most); the rows below keep what is left of the matrix,
    their Schur complement. window: see `known_width`. Pivots are taken in pairs, so that rows pass through memory half
    as often.
    """
    n, count = ab.shape[0], min(ab.shape[0], original.shape[0])
    w = len(window) if len(window) > 1 else ab.shape[1] // 2
    eliminates, worst = right.shape[0] > 0, 1.0
    for i in range(min(count, w)):
        original[i] = abs(ab[i, w])
    for k in range(0, count, 2):
        top = ab[k]
        if k + w < count:
            original[k + w] = abs(ab[k + w, w])
        if top[w] == 0.0 or original[k] == 0.0:
            return 0.0
        worst = min(worst, abs(top[w]) / original[k])
        inverse = 1.0 / top[w]
        top[w] = inverse
        if k + 1 == count:
            for i in range(k + 1, min(n, k + w + 1)):
                row, offset = ab[i], w + k - i
                first = row[offset] * inverse
                row[offset] = first
                for j in range(1, w + 1):
                    row[offset + j] -= first * top[w + j]
                if eliminates:
                    right[i] -= first * right[k]
            for j in range(1, w + 1):
                top[w + j] *= inverse
            break
        below = ab[k + 1]
        if k + 1 + w < count:
            original[k + 1 + w] = abs(ab[k + 1 + w, w])
        first = below[w - 1] * inverse
        below[w - 1] = first
        for j in range(1, w + 1):
            below[w - 1 + j] -= first * top[w + j]
        if below[w] == 0.0 or original[k + 1] == 0.0:
            return 0.0
        worst = min(worst, abs(below[w]) / original[k + 1])
        inverse_below = 1.0 / below[w]
        below[w] = inverse_below
        upper, lower = 0.0, 0.0
        if eliminates:
            right[k + 1] -= first * right[k]
            upper, lower = right[k], right[k + 1]
        beside = top[w + 1]
        for i in range(k + 2, min(n, k + w + 1)):
            row, offset = ab[i], w + k - i
            first = row[offset] * inverse
            second = (row[offset + 1] - first * beside) * inverse_below
            row[offset], row[offset + 1] = first, second
            for j in range(2, w + 1):
                row[offset + j] -= first * top[w + j] + second * below[w + j - 1]
            row[offset + w + 1] -= second * below[2 * w]
            if eliminates:
                right[i] -= first * upper + second * lower
        if k + w + 1 < n:
            row = ab[k + w + 1]
            second = row[0] * inverse_below
            row[0] = second
            for j in range(1, w + 1):
                row[j] -= second * below[w + j]
            if eliminates:
                right[k + w + 1] -= second * lower
        for j in range(1, w + 1):
            top[w + j] *= inverse
            below[w + j] *= inverse_below
    return worst


@kernel()
def solve(lu, x, window):
    """Replace the right-hand side x (n,) by the solution; lu and window as for `factor`."""
    solve_lower(lu, x, window)
    solve_upper(lu, x, window)


@kernel(fastmath={"contract"})
def solve_lower(lu, x, window):
    """Replace the right-hand side x (n,) by that of the upper triangle; lu and window as for `factor`."""
    last, w = window, lu.shape[1] // 2
    for i in range(lu.shape[0]):
        row, total = lu[i], x[i]
        if len(window) > 1:
            for j in range(len(window)):
                total -= row[j] * last[j]
            last = _push(last, total)
        else:
            for k in range(max(0, i - w), i):
                total -= row[w + k - i] * x[k]
        x[i] = total


@kernel(nogil=True, fastmath={"contract"})
def solve_upper(lu, x, window):
    """Replace what `solve_lower` left in x by the solution; what x holds beyond the rows of lu is known already."""
    last, n, w = window, x.shape[0], lu.shape[1] // 2
    if len(window) > 1:
        for i in range(n - 1, lu.shape[0] - 1, -1):
            last = _push(last, x[i])
    for i in range(lu.shape[0] - 1, -1, -1):
        row = lu[i]
        if len(window) > 1:
            total = x[i] * row[len(window)]
            for j in range(len(window)):
                total -= row[2 * len(window) - j] * last[j]
            last = _push(last, total)
        else:
            total = x[i] * row[w]
            for k in range(min(n, i + w + 1) - 1, i, -1):
                total -= row[w + k - i] * x[k]
        x[i] = total


@kernel(forceinline=True)
def _push(window, value):
    return window[1:] + (value,)  # noqa: RUF005 (numba does not unpack)
