"""Strain measures of the elastic line, whose curvature comes from r_xx; paper, section 3.4.

eps = (|r'| - 1, (r' x r'') / |r'|^2, r'.d, (d.d - 1) / 2), primes by arc length. Arguments r = r0', d and b = r0''.
"""

import math

from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True, fastmath=FAST)
def strains(q):
    """Return eps and two zeros."""
    rx, ry, dx, dy, bx, by = q
    square = rx * rx + ry * ry
    return (
        math.sqrt(square) - 1.0,
        (rx * by - ry * bx) / square,
        rx * dx + ry * dy,
        0.5 * (dx * dx + dy * dy - 1.0),
        0.0,
        0.0,
    )


@kernel(forceinline=True, fastmath=FAST)
def gradients(rx, ry, bx, by):
    """Return t = r' / |r'|, the gradient g of the angle of r' and that of the curvature with respect to r'."""
    inverse = 1.0 / math.sqrt(rx * rx + ry * ry)
    tx, ty = rx * inverse, ry * inverse
    gx, gy = -ty * inverse, tx * inverse
    hxx, hxy = -2.0 * gx * gy, gx * gx - gy * gy
    return tx, ty, gx, gy, hxx * bx + hxy * by, hxy * bx - hxx * by


@kernel(forceinline=True, fastmath=FAST)
def forces(q, s):
    """Return the vectors on r, d and b of stress resultants s."""
    rx, ry, dx, dy, bx, by = q
    s0, s1, s2, s3, _, _ = s
    tx, ty, gx, gy, kx, ky = gradients(rx, ry, bx, by)
    return (
        s0 * tx + s1 * kx + s2 * dx,
        s0 * ty + s1 * ky + s2 * dy,
        s2 * rx + s3 * dx,
        s2 * ry + s3 * dy,
        s1 * gx,
        s1 * gy,
    )


@kernel(forceinline=True, fastmath=FAST)
def rates(q, dq):
    """Return the change of eps with changes of r, d and b."""
    rx, ry, dx, dy, bx, by = q
    rx_, ry_, dx_, dy_, bx_, by_ = dq
    tx, ty, gx, gy, kx, ky = gradients(rx, ry, bx, by)
    return (
        tx * rx_ + ty * ry_,
        kx * rx_ + ky * ry_ + gx * bx_ + gy * by_,
        rx * dx_ + ry * dy_ + dx * rx_ + dy * ry_,
        dx * dx_ + dy * dy_,
        0.0,
        0.0,
    )


@kernel(forceinline=True, fastmath=FAST)
def hessian(q, c, k, g, w, s):
    """Return w grad^T c[k, g] grad + sum_i s_i d2 eps_i, as its blocks rr (xx, xy, yy), rd, rb (4 each), dd, db, bb."""
    rx, ry, dx, dy, bx, by = q
    s0, s1, s2, s3, _, _ = s
    tx, ty, gx, gy, kx, ky = gradients(rx, ry, bx, by)
    inverse = 1.0 / math.sqrt(rx * rx + ry * ry)
    hxx, hxy = -2.0 * gx * gy, gx * gx - gy * gy
    c00, c01, c02, c03 = w * c[k, g, 0, 0], w * c[k, g, 0, 1], w * c[k, g, 0, 2], w * c[k, g, 0, 3]
    c11, c12, c13 = w * c[k, g, 1, 1], w * c[k, g, 1, 2], w * c[k, g, 1, 3]
    c22, c23, c33 = w * c[k, g, 2, 2], w * c[k, g, 2, 3], w * c[k, g, 3, 3]
    # change of a measure's stress with r' is a vector u_i, with d a vector v_i
    u0x, u0y = c00 * tx + c01 * kx + c02 * dx, c00 * ty + c01 * ky + c02 * dy
    u1x, u1y = c01 * tx + c11 * kx + c12 * dx, c01 * ty + c11 * ky + c12 * dy
    u2x, u2y = c02 * tx + c12 * kx + c22 * dx, c02 * ty + c12 * ky + c22 * dy
    u3x, u3y = c03 * tx + c13 * kx + c23 * dx, c03 * ty + c13 * ky + c23 * dy
    v1x, v1y = c12 * rx + c13 * dx, c12 * ry + c13 * dy
    v2x, v2y = c22 * rx + c23 * dx, c22 * ry + c23 * dy
    v3x, v3y = c23 * rx + c33 * dx, c23 * ry + c33 * dy
    # r' is read as a complex number: real and imaginary part of 2 / r'^3, the third derivative of log r'
    cube = 2.0 * inverse * inverse * inverse
    real, imaginary = cube * tx * (tx * tx - 3.0 * ty * ty), cube * ty * (ty * ty - 3.0 * tx * tx)
    bend, stretch = s1 * (imaginary * bx + real * by), s0 * inverse
    return (
        tx * u0x + kx * u1x + dx * u2x + bend + stretch * ty * ty,
        tx * u0y + kx * u1y + dx * u2y + s1 * (real * bx - imaginary * by) - stretch * tx * ty,
        ty * u0y + ky * u1y + dy * u2y - bend + stretch * tx * tx,
        u2x * rx + u3x * dx + s2,
        u2x * ry + u3x * dy,
        u2y * rx + u3y * dx,
        u2y * ry + u3y * dy + s2,
        u1x * gx + s1 * hxx,
        u1x * gy + s1 * hxy,
        u1y * gx + s1 * hxy,
        u1y * gy - s1 * hxx,
        rx * v2x + dx * v3x + s3,
        rx * v2y + dx * v3y,
        ry * v2y + dy * v3y + s3,
        v1x * gx,
        v1x * gy,
        v1y * gx,
        v1y * gy,
        c11 * gx * gx,
        c11 * gx * gy,
        c11 * gy * gy,
    )
