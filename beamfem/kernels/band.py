"""LU factorisation of a band matrix in row storage: row i holds A[i, i - w .. i + w], inner loops are contiguous.

No pivoting: tangents of a supported beam have strong diagonals. Growth is watched, and whoever calls can then ask
SciPy's pivoted solver.
"""

from numba import njit


@njit(cache=True, _nrt=False, fastmath={"contract", "reassoc", "nsz"}, error_model="numpy")
def factor(ab):
    """Factor in place, ab (n, 2 w + 1); return the smallest ratio of a pivot to the row's original diagonal entry."""
    n, width = ab.shape
    w = width // 2
    worst = 1.0
    for i in range(n):
        row = ab[i]
        original = abs(row[w])
        for k in range(max(0, i - w), i):
            factor_ = row[w + k - i] * ab[k, w]
            row[w + k - i] = factor_
            if factor_ != 0.0:
                offset = w + k - i
                above = ab[k]
                for j in range(1, w + 1):
                    row[offset + j] -= factor_ * above[w + j]
        pivot = row[w]
        if pivot == 0.0 or original == 0.0:
            return 0.0
        worst = min(worst, abs(pivot) / original)
        row[w] = 1.0 / pivot
    return worst


@njit(cache=True, _nrt=False, fastmath={"contract", "reassoc", "nsz"}, error_model="numpy")
def solve(lu, x):
    """Replace the right-hand side x (n,) by the solution; lu from `factor`."""
    n, width = lu.shape
    w = width // 2
    for i in range(n):
        total = x[i]
        for k in range(max(0, i - w), i):
            total -= lu[i, w + k - i] * x[k]
        x[i] = total
    for i in range(n - 1, -1, -1):
        total = x[i]
        for k in range(i + 1, min(n, i + w + 1)):
            total -= lu[i, w + k - i] * x[k]
        x[i] = total * lu[i, w]
