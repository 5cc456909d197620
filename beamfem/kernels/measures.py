"""Strain measures, their gradients and their second derivatives, at one point of the beam axis.

q = (r0', d, d') holds six numbers; a measure is a function eps(q). Written once readable in `beamfem.element.forces`.
"""

from numba import njit


@njit(cache=True, inline="always", error_model="numpy")
def green_lagrange(q, eps, grad):
    """Components of E = (F^T F - 1)/2 for r = r0 + y d in powers of y; paper, section 3.3.

    eps = (a, b, c, eyy, g0, g1) with exx = a + b y + c y^2 and 2 exy = g0 + g1 y.
    """
    rx, ry, dx, dy, ex, ey = q[0], q[1], q[2], q[3], q[4], q[5]
    eps[0] = 0.5 * (rx * rx + ry * ry - 1.0)
    eps[1] = rx * ex + ry * ey
    eps[2] = 0.5 * (ex * ex + ey * ey)
    eps[3] = 0.5 * (dx * dx + dy * dy - 1.0)
    eps[4] = rx * dx + ry * dy
    eps[5] = dx * ex + dy * ey
    grad[:, :] = 0.0
    grad[0, 0], grad[0, 1] = rx, ry
    grad[1, 0], grad[1, 1], grad[1, 4], grad[1, 5] = ex, ey, rx, ry
    grad[2, 4], grad[2, 5] = ex, ey
    grad[3, 2], grad[3, 3] = dx, dy
    grad[4, 0], grad[4, 1], grad[4, 2], grad[4, 3] = dx, dy, rx, ry
    grad[5, 2], grad[5, 3], grad[5, 4], grad[5, 5] = ex, ey, dx, dy


@njit(cache=True, inline="always", error_model="numpy")
def green_lagrange_hessian(s, h):
    """Add sum_i s_i d2 eps_i / dq dq to the symmetric matrix h (6, 6)."""
    for i in range(2):
        h[i, i] += s[0]
        h[i, i + 4] += s[1]
        h[i + 4, i] += s[1]
        h[i + 4, i + 4] += s[2]
        h[i + 2, i + 2] += s[3]
        h[i, i + 2] += s[4]
        h[i + 2, i] += s[4]
        h[i + 2, i + 4] += s[5]
        h[i + 4, i + 2] += s[5]
