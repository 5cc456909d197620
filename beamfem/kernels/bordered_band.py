"""Factors and solutions of a band with a border: a few unknowns coupled beyond it, and multipliers.

With the band B, unit vectors E of the t coupled unknowns x_t, and the border D of them and the k multipliers:
x + Z (D_t x_t + D_l l) = y with Z = B^-1 E and y = B^-1 r; the rows t of it and the conditions are a small system.
"""

from beamfem.kernels.compiling import routine
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at


@routine()
def factor_bordered(solver: MotionSolver) -> float:
    """Factor the band and the small system; return the smallest ratio of a pivot of the band, 0 if one is singular."""
    edge, k, half, rows, call = solver.edge, solver.conditions, solver.half, solver.rows, solver.routines
    n, m, numbers, border = solver.unknown - k, edge + k, solver.edge_numbers, solver.border
    columns, small = solver.edge_columns, solver.edge_factors
    ratio = call.factor(n, half, solver.reach, rows, solver.step)
    for column in range(edge):
        x = at(columns, column * n)
        for i in range(n):
            x[i] = 0.0
        x[numbers[column]] = 1.0
        call.solve_both(n, half, rows, x)
    for i in range(m):
        row = at(small, i * (m + 1))
        for j in range(m):
            total = border[i * m + j]
            if i < edge:
                total = 1.0 if i == j else 0.0
                for column in range(edge):
                    total += columns[column * n + numbers[i]] * border[column * m + j]
            row[j] = total
    for pivot in range(m):
        chosen = pivot
        for i in range(pivot + 1, m):
            if abs(small[i * (m + 1) + pivot]) > abs(small[chosen * (m + 1) + pivot]):
                chosen = i
        row = at(small, pivot * (m + 1))
        if chosen != pivot:
            other = at(small, chosen * (m + 1))
            for j in range(m):
                row[j], other[j] = other[j], row[j]
        row[m] = chosen
        if row[pivot] == 0.0:
            return 0.0
        row[pivot] = 1.0 / row[pivot]
        for i in range(pivot + 1, m):
            other = at(small, i * (m + 1))
            other[pivot] *= row[pivot]
            for j in range(pivot + 1, m):
                other[j] -= other[pivot] * row[j]
    return ratio


@routine()
def solve_bordered(solver: MotionSolver) -> None:
    """Replace the right-hand side by the solution, multipliers last."""
    edge, k, right = solver.edge, solver.conditions, solver.right
    n, m, numbers, border = solver.unknown - k, edge + k, solver.edge_numbers, solver.border
    columns, small, coupled = solver.edge_columns, solver.edge_factors, solver.step
    solver.routines.solve_both(n, solver.half, solver.rows, right)
    for i in range(edge):
        coupled[i] = right[numbers[i]]
    for i in range(k):
        coupled[edge + i] = right[n + i]
    for i in range(m):
        chosen = int(small[i * (m + 1) + m])
        coupled[i], coupled[chosen] = coupled[chosen], coupled[i]
    for i in range(m):
        for j in range(i + 1, m):
            coupled[j] -= small[j * (m + 1) + i] * coupled[i]
    for i in range(m - 1, -1, -1):
        for j in range(i + 1, m):
            coupled[i] -= small[i * (m + 1) + j] * coupled[j]
        coupled[i] *= small[i * (m + 1) + i]
    for column in range(edge):
        force, x = 0.0, at(columns, column * n)
        for j in range(m):
            force += border[column * m + j] * coupled[j]
        for i in range(n):
            right[i] -= force * x[i]
    for i in range(k):
        right[n + i] = coupled[edge + i]
