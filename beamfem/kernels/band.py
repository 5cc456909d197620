"""LU factorisation of a band matrix in row storage: row i holds A[i, i - w .. i + w]; L and U get unit diagonals.

No pivoting: tangents of a supported beam have strong diagonals. Growth is watched, and whoever calls can then ask
SciPy's pivoted solver. Where the half width is known to the compiler, a window of the last w values stays in registers:
each then waits for one multiplication, not for memory.
"""

from numba import njit

FAST = {"contract", "reassoc", "nsz"}
ANY_WIDTH = (0.0,)
_LARGEST_KNOWN = 14


def known_width(half_width: int) -> tuple[float, ...]:
    """Return a window of zeros of this half width, a type that has compiled code of its own; one for all beyond 14."""
    return (0.0,) * half_width if 1 < half_width <= _LARGEST_KNOWN else ANY_WIDTH


@njit(cache=True, _nrt=False, error_model="numpy")
def factor(ab, window):
    """Factor in place, ab (n, 2 w + 1); return the smallest ratio of a pivot to the row's original diagonal entry.

    The diagonal holds the inverse pivots then. window: see `known_width`.
    """
    if len(window) == 1:
        return _factor_any(ab)
    return _factor_known(ab, window)


@njit(cache=True, _nrt=False, error_model="numpy")
def solve(lu, x, window):
    """Replace the right-hand side x (n,) by the solution; lu and window as for `factor`."""
    if len(window) == 1:
        _solve_any(lu, x)
    else:
        _solve_known(lu, x, window)


@njit(cache=True, _nrt=False, fastmath=FAST, error_model="numpy")
def _factor_any(ab):
    n, width = ab.shape
    w = width // 2
    worst = 1.0
    for i in range(n):
        row = ab[i]
        original = abs(row[w])
        for k in range(max(0, i - w), i):
            scaled = row[w + k - i]
            row[w + k - i] = scaled * ab[k, w]
            if scaled != 0.0:
                offset = w + k - i
                above = ab[k]
                for j in range(1, w + 1):
                    row[offset + j] -= scaled * above[w + j]
        pivot = row[w]
        if pivot == 0.0 or original == 0.0:
            return 0.0
        worst = min(worst, abs(pivot) / original)
        inverse = 1.0 / pivot
        row[w] = inverse
        for j in range(1, w + 1):
            row[w + j] *= inverse
    return worst


@njit(cache=True, forceinline=True, _nrt=False, error_model="numpy")
def _push(window, value):
    return window[1:] + (value,)  # noqa: RUF005 (numba does not unpack)


@njit(cache=True, _nrt=False, fastmath=FAST, error_model="numpy")
def _factor_known(ab, window):
    n, w, worst = ab.shape[0], len(window), 1.0
    originals = window
    for k in range(min(n, w)):
        originals = _push(originals, abs(ab[k, w]))
    if n < w:
        for _ in range(w - n):
            originals = _push(originals, 0.0)
    for k in range(n):
        top = ab[k]
        pivot, original = top[w], originals[0]
        if pivot == 0.0 or original == 0.0:
            return 0.0
        worst = min(worst, abs(pivot) / original)
        originals = _push(originals, abs(ab[k + w, w]) if k + w < n else 0.0)
        inverse = 1.0 / pivot
        for i in range(k + 1, min(n, k + w + 1)):
            row, offset = ab[i], w + k - i
            scaled = row[offset] * inverse
            row[offset] = scaled
            for j in range(1, w + 1):
                row[offset + j] -= scaled * top[w + j]
        top[w] = inverse
        for j in range(1, w + 1):
            top[w + j] *= inverse
    return worst


@njit(cache=True, _nrt=False, fastmath={"contract"}, error_model="numpy")
def _solve_any(lu, x):
    n, width = lu.shape
    w = width // 2
    for i in range(n):
        total = x[i]
        for k in range(max(0, i - w), i):
            total -= lu[i, w + k - i] * x[k]
        x[i] = total
    for i in range(n - 1, -1, -1):
        total = x[i] * lu[i, w]
        for k in range(min(n, i + w + 1) - 1, i, -1):
            total -= lu[i, w + k - i] * x[k]
        x[i] = total


@njit(cache=True, _nrt=False, fastmath={"contract"}, error_model="numpy")
def _solve_known(lu, x, window):
    n, w = lu.shape[0], len(window)
    last = window
    for i in range(n):
        row, total = lu[i], x[i]
        for j in range(w):
            total -= row[j] * last[j]
        last = _push(last, total)
        x[i] = total
    last = window
    for i in range(n - 1, -1, -1):
        row = lu[i]
        total = x[i] * row[w]
        for j in range(w):
            total -= row[2 * w - j] * last[j]
        last = _push(last, total)
        x[i] = total
