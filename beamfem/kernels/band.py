"""LU factorisation of a band matrix in row storage: row i holds A[i, i - w .. i + w]; L and U get unit diagonals.

No pivoting: tangents of a supported beam have large diagonals. The smallest pivot ratio is returned, so that callers
can fall back on SciPy's solver with pivoting. If the half width is known to the compiler, loops are unrolled and the
last w values of a solution stay in registers: each value then waits for one multiplication, not for memory.
"""

from functools import cache
from itertools import pairwise
from typing import NamedTuple

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.value_types import PAIRS, WHOLE, Value
from beamfem.kernels.compiling import FAST, Routine, inlined, routine
from beamfem.kernels.elimination import elimination
from beamfem.kernels.pointers import at, room

# chains of bilinear, quadratic and cubic elements, and of orders 3 and 4 with rotations; with hinges in them, one more
KNOWN = (5, 6, 7, 8, 9, 11, 12, 14, 15)


class Band(NamedTuple):
    """Compiled functions for a half width.

    factor(n, count, w, eliminates, reach, ab, right, original): smallest ratio of a pivot to the row's original
    diagonal entry; solve_lower, solve_upper(rows, n, w, lu, x).
    """

    factor: Routine
    solve_lower: Routine
    solve_upper: Routine


@operation
def push(build: Build, window: Value, count: Value, value: Value) -> None:
    """Move the numbers, or pairs, of a window one place down, and put a value at its end."""
    step = 2 if window.kind is PAIRS else 1
    places = [Value(WHOLE, WHOLE.llvm(step * index)) for index in range(count.llvm.constant)]
    for to, source in pairwise(places):
        build.write(window, to, build.read(window, source))
    build.write(window, places[-1], value)


@cache
def band(half_width: int) -> Band:
    """Return the compiled functions for a half width, specialised for those in `KNOWN`; 0: any."""
    if half_width and half_width not in KNOWN:
        return band(0)
    case = f"half_width_{half_width or 'any'}"
    _eliminate = inlined(elimination(half_width, case, backwards=False))

    @routine("iiiisrrr", "d", case, fastmath=FAST)
    def factor(n, count, half, eliminates, reach, ab, right, original):
        """Take the first `count` pivots, see `elimination`."""
        return _eliminate(n, count, half, eliminates, reach, ab, right, original)

    return Band(factor, *(_solves(half_width, case) if half_width else (_solve_lower, _solve_upper)))


def _solves(known: int, case: str) -> tuple[Routine, Routine]:
    @routine("iiirr", case=case, fastmath={"contract"})
    def solve_lower(rows, n, half, lu, x):
        """Solve L y = x by forward substitution; y replaces x (n,)."""
        last = room(known)
        for j in range(known):
            last[j] = 0.0
        for i in range(rows):
            row, total = at(lu, i * (2 * known + 1)), x[i]
            for j in range(known):
                total -= row[j] * last[j]
            push(last, known, total)
            x[i] = total

    @routine("iiirr", case=case, fastmath={"contract"})
    def solve_upper(rows, n, half, lu, x):
        """Replace the result x (n,) of `solve_lower` by the solution; its entries from `rows` on are known already."""
        last = room(known)
        for j in range(known):
            last[j] = 0.0
        for i in range(n - 1, rows - 1, -1):
            push(last, known, x[i])
        for i in range(rows - 1, -1, -1):
            row = at(lu, i * (2 * known + 1))
            total = x[i] * row[known]
            for j in range(known):
                total -= row[2 * known - j] * last[j]
            push(last, known, total)
            x[i] = total

    return solve_lower, solve_upper


@routine("iiirr", fastmath={"contract"})
def _solve_lower(rows, n, half, lu, x):
    """Do the same as `solve_lower` for any half width."""
    for i in range(rows):
        row, total = at(lu, i * (2 * half + 1)), x[i]
        for k in range(max(0, i - half), i):
            total -= row[half + k - i] * x[k]
        x[i] = total


@routine("iiirr", fastmath={"contract"})
def _solve_upper(rows, n, half, lu, x):
    """Do the same as `solve_upper` for any half width."""
    for i in range(rows - 1, -1, -1):
        row = at(lu, i * (2 * half + 1))
        total = x[i] * row[half]
        for k in range(min(n, i + half + 1) - 1, i, -1):
            total -= row[half + k - i] * x[k]
        x[i] = total


ANY = band(0)  # those for any half width
