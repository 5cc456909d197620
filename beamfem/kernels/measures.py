"""Strain measures, their gradients and their second derivatives, at one point of the beam axis.

q = (r0', d, d') holds six numbers, and two more, r0'', for the elastic line; a measure is a function eps(q), written
once readable in `beamfem.element.forces`.
"""

import math

from numba import njit

from beamfem.kernels.block import GREEN_LAGRANGE, STRUCTURAL
from beamfem.kernels.elastic_line import elastic_line, elastic_line_hessian


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


@njit(cache=True, inline="always", error_model="numpy")
def structural(q, eps, grad):
    """Stretch, shear, curvature and thickness stretch of a Reissner beam whose section stands along d.

    With t = d / |d|, n = (t_y, -t_x): eps = (r0'.n - 1, r0'.t, (d x d') / |d|^2, |d| - 1).
    """
    square = q[2] * q[2] + q[3] * q[3]
    size = math.sqrt(square)
    tx, ty = q[2] / size, q[3] / size
    gx, gy = -ty / size, tx / size  # gradient of the angle of d
    along, across = q[0] * ty - q[1] * tx, q[0] * tx + q[1] * ty
    hxx, hxy = 2.0 * tx * ty / square, (ty * ty - tx * tx) / square
    eps[0] = along - 1.0
    eps[1] = across
    eps[2] = gx * q[4] + gy * q[5]
    eps[3] = size - 1.0
    grad[:, :] = 0.0
    grad[0, 0], grad[0, 1], grad[0, 2], grad[0, 3] = ty, -tx, across * gx, across * gy
    grad[1, 0], grad[1, 1], grad[1, 2], grad[1, 3] = tx, ty, -along * gx, -along * gy
    grad[2, 2], grad[2, 3] = hxx * q[4] + hxy * q[5], hxy * q[4] - hxx * q[5]
    grad[2, 4], grad[2, 5] = gx, gy
    grad[3, 2], grad[3, 3] = tx, ty


@njit(cache=True, inline="always", error_model="numpy")
def structural_hessian(q, s, h):
    """Add sum_i s_i d2 eps_i / dq dq to the symmetric matrix h (6, 6); d is read as a complex number."""
    square = q[2] * q[2] + q[3] * q[3]
    size = math.sqrt(square)
    tx, ty = q[2] / size, q[3] / size
    gx, gy = -ty / size, tx / size
    along, across = q[0] * ty - q[1] * tx, q[0] * tx + q[1] * ty
    hxx, hxy = 2.0 * tx * ty / square, (ty * ty - tx * tx) / square
    # real and imaginary part of 2 / d^3, the third derivative of log d
    cube = 2.0 / (square * size)
    real, imaginary = cube * (tx**3 - 3.0 * tx * ty * ty), cube * (ty**3 - 3.0 * tx * tx * ty)
    turned = -s[0] * along - s[1] * across
    angle = s[0] * across - s[1] * along
    h[2, 2] += turned * gx * gx + angle * hxx + s[2] * (imaginary * q[4] + real * q[5]) + s[3] * ty * ty / size
    h[3, 3] += turned * gy * gy - angle * hxx - s[2] * (imaginary * q[4] + real * q[5]) + s[3] * tx * tx / size
    mixed = turned * gx * gy + angle * hxy + s[2] * (real * q[4] - imaginary * q[5]) - s[3] * tx * ty / size
    h[2, 3] += mixed
    h[3, 2] += mixed
    # r0' with d: change of n is t, change of t is -n, times the change of the angle
    ux, uy = s[0] * tx - s[1] * ty, s[0] * ty + s[1] * tx
    for i in range(2):
        u = ux if i == 0 else uy
        h[i, 2] += u * gx
        h[2, i] += u * gx
        h[i, 3] += u * gy
        h[3, i] += u * gy
    h[2, 4] += s[2] * hxx
    h[4, 2] += s[2] * hxx
    h[3, 5] -= s[2] * hxx
    h[5, 3] -= s[2] * hxx
    for i in range(2):
        h[2 + i, 5 - i] += s[2] * hxy
        h[5 - i, 2 + i] += s[2] * hxy


@njit(cache=True, inline="always", error_model="numpy")
def measure(kind, q, eps, grad):
    """Fill strain measures eps (ns,) and their gradients (ns, 6 or 8) of the kind that a block asks for."""
    if kind == GREEN_LAGRANGE:
        green_lagrange(q, eps, grad)
    elif kind == STRUCTURAL:
        structural(q, eps, grad)
    else:
        elastic_line(q, eps, grad)


@njit(cache=True, inline="always", error_model="numpy")
def measure_hessian(kind, q, s, h):
    """Add the stress-weighted second derivatives of the kind that a block asks for to h (6, 6) or (8, 8)."""
    if kind == GREEN_LAGRANGE:
        green_lagrange_hessian(s, h)
    elif kind == STRUCTURAL:
        structural_hessian(q, s, h)
    else:
        elastic_line_hessian(q, s, h)
