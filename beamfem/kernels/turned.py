"""Pairs of coordinates (x, y) of which only one direction is held: a roller on an inclined plane."""

from beamfem.kernels.compiling import kernel


@kernel()
def hold_normals(rows, first, normal):
    """Turn each pair of unknowns to (normal, tangent) in a band matrix and hold the normal one at zero change.

    rows (n, 2 w + 1) in place; first (nt,) number of the pair's x; normal (nt, 2) unit vectors.
    """
    n, width = rows.shape
    w = width // 2
    for k in range(first.shape[0]):
        i, j = first[k], first[k] + 1
        c, s = normal[k, 0], normal[k, 1]
        for column in range(max(0, j - w), min(n, i + w + 1)):
            x, y = rows[i, w + column - i], rows[j, w + column - j]
            rows[i, w + column - i] = c * x + s * y
            rows[j, w + column - j] = -s * x + c * y
        for row in range(max(0, j - w), min(n, i + w + 1)):
            x, y = rows[row, w + i - row], rows[row, w + j - row]
            rows[row, w + i - row] = c * x + s * y
            rows[row, w + j - row] = -s * x + c * y
        size = abs(rows[j, w])
        for other in range(max(0, i - w), min(n, i + w + 1)):
            rows[i, w + other - i] = 0.0
            rows[other, w + i - other] = 0.0
        rows[i, w] = size if size > 0.0 else 1.0


@kernel()
def turn_in(right, first, normal):
    """Turn each pair of a right-hand side (n,) to (normal, tangent) in place, the normal one zero."""
    for k in range(first.shape[0]):
        i, j = first[k], first[k] + 1
        right[j] = -normal[k, 1] * right[i] + normal[k, 0] * right[j]
        right[i] = 0.0


@kernel()
def turn_back(x, first, normal):
    """Turn the solution's pairs (normal, tangent) back to (x, y), in place."""
    for k in range(first.shape[0]):
        i, j = first[k], first[k] + 1
        c, s = normal[k, 0], normal[k, 1]
        x[i], x[j] = c * x[i] - s * x[j], s * x[i] + c * x[j]
