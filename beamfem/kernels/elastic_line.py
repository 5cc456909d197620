"""Strain measures of the elastic line, whose curvature comes from r_xx; paper, section 3.4.

eps = (|r'| - 1, (r' x r'') / |r'|^2, r'.d, (d.d - 1) / 2), primes by arc length; q = (r', d, d', r'').
"""

import math

from numba import njit


@njit(cache=True, inline="always", error_model="numpy")
def elastic_line(q, eps, grad):
    """Fill strain measures eps (4,) and their gradients (4, 8)."""
    square = q[0] * q[0] + q[1] * q[1]
    size = math.sqrt(square)
    # gradient of the angle of r'; the curvature is its product with r''
    gx, gy = -q[1] / square, q[0] / square
    hxx, hxy = 2.0 * q[0] * q[1] / square**2, (q[1] * q[1] - q[0] * q[0]) / square**2
    eps[0] = size - 1.0
    eps[1] = gx * q[6] + gy * q[7]
    eps[2] = q[0] * q[2] + q[1] * q[3]
    eps[3] = 0.5 * (q[2] * q[2] + q[3] * q[3] - 1.0)
    grad[:, :] = 0.0
    grad[0, 0], grad[0, 1] = q[0] / size, q[1] / size
    grad[1, 0], grad[1, 1] = hxx * q[6] + hxy * q[7], hxy * q[6] - hxx * q[7]
    grad[1, 6], grad[1, 7] = gx, gy
    grad[2, 0], grad[2, 1], grad[2, 2], grad[2, 3] = q[2], q[3], q[0], q[1]
    grad[3, 2], grad[3, 3] = q[2], q[3]


@njit(cache=True, inline="always", error_model="numpy")
def elastic_line_hessian(q, s, h):
    """Add sum_i s_i d2 eps_i / dq dq to the symmetric matrix h (8, 8); r' is read as a complex number."""
    square = q[0] * q[0] + q[1] * q[1]
    size = math.sqrt(square)
    tx, ty = q[0] / size, q[1] / size
    hxx, hxy = 2.0 * tx * ty / square, (ty * ty - tx * tx) / square
    # real and imaginary part of 2 / r'^3, the third derivative of log r'
    cube = 2.0 / (square * size)
    real, imaginary = cube * (tx**3 - 3.0 * tx * ty * ty), cube * (ty**3 - 3.0 * tx * tx * ty)
    turning = s[1] * (imaginary * q[6] + real * q[7])
    h[0, 0] += s[0] * ty * ty / size + turning
    h[1, 1] += s[0] * tx * tx / size - turning
    mixed = -s[0] * tx * ty / size + s[1] * (real * q[6] - imaginary * q[7])
    h[0, 1] += mixed
    h[1, 0] += mixed
    h[0, 6] += s[1] * hxx
    h[6, 0] += s[1] * hxx
    h[1, 7] -= s[1] * hxx
    h[7, 1] -= s[1] * hxx
    for i in range(2):
        h[i, 7 - i] += s[1] * hxy
        h[7 - i, i] += s[1] * hxy
        h[i, i + 2] += s[2]
        h[i + 2, i] += s[2]
        h[i + 2, i + 2] += s[3]
