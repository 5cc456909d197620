"""Rollers on inclined planes: pairs of unknowns (x, y) of which only the normal direction is prescribed."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at


@routine("iiirnr")
def constrain_normals(n, half, rollers, rows, first, normal):
    """Rotate each pair of unknowns to (normal, tangent) in a band matrix, and constrain the normal one to zero change.

    rows (n, 2 half + 1): the matrix, changed in place; first (rollers,): number of the x of each pair among the
    unknowns; normal (rollers, 2): unit vectors.
    """
    width = 2 * half + 1
    for k in range(rollers):
        i, j = first[k], first[k] + 1
        c, s = normal[2 * k], normal[2 * k + 1]
        upper, lower = at(rows, i * width + half - i), at(rows, j * width + half - j)
        for column in range(max(0, j - half), min(n, i + half + 1)):
            x, y = upper[column], lower[column]
            upper[column] = c * x + s * y
            lower[column] = -s * x + c * y
        for row in range(max(0, j - half), min(n, i + half + 1)):
            entries = at(rows, row * width + half - row)
            x, y = entries[i], entries[j]
            entries[i] = c * x + s * y
            entries[j] = -s * x + c * y
        size = abs(lower[j])
        for other in range(max(0, i - half), min(n, i + half + 1)):
            upper[other] = 0.0
            rows[other * width + half + i - other] = 0.0
        upper[i] = size if size > 0.0 else 1.0


@routine("iiirnr")
def constrain_nothing(n, half, rollers, rows, first, normal):
    """Leave a matrix as it is: the one who factorises it constrains the normals."""


@routine("iinrnrr")
def stay_on_planes(n, rollers, first, normal, free, state, before):
    """Remove what p, p' and p'' (3, n) of a predicted state have along normals beyond p of the state before.

    No correction has a normal component, so that round-off in it would be extrapolated from step to step, and grow.
    free (unknown,): coordinates of the unknowns.
    """
    for k in range(rollers):
        x, y, c, s = free[first[k]], free[first[k] + 1], normal[2 * k], normal[2 * k + 1]
        for part in range(3):
            along = c * state[part * n + x] + s * state[part * n + y]
            if part == 0:
                along -= c * before[x] + s * before[y]
            state[part * n + x] -= along * c
            state[part * n + y] -= along * s


@routine("inrr")
def rotate_in(rollers, first, normal, right):
    """Rotate each pair of a right-hand side (n,) to (normal, tangent) in place, with a normal component of zero."""
    for k in range(rollers):
        i, j = first[k], first[k] + 1
        right[j] = -normal[2 * k + 1] * right[i] + normal[2 * k] * right[j]
        right[i] = 0.0


@routine("inrr")
def rotate_back(rollers, first, normal, x):
    """Rotate each pair of the solution from (normal, tangent) back to (x, y), in place."""
    for k in range(rollers):
        i, j = first[k], first[k] + 1
        c, s = normal[2 * k], normal[2 * k + 1]
        x[i], x[j] = c * x[i] - s * x[j], s * x[i] + c * x[j]
