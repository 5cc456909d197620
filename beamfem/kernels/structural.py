"""Strain measures of a Reissner beam whose section stands along d.

With t = d / |d|, n = (t_y, -t_x): eps = (r'.n - 1, r'.t, (d x d') / |d|^2, |d| - 1). Arguments r = r0', d and e = d'.
"""

import math

from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True, fastmath=FAST)
def strains(q):
    """Return eps and two zeros."""
    rx, ry, dx, dy, ex, ey = q
    square = dx * dx + dy * dy
    size = math.sqrt(square)
    inverse = 1.0 / size
    tx, ty = dx * inverse, dy * inverse
    turn = (tx * ey - ty * ex) * inverse
    return rx * ty - ry * tx - 1.0, rx * tx + ry * ty, turn, size - 1.0, 0.0, 0.0


@kernel(forceinline=True, fastmath=FAST)
def gradients(q):
    """Return t, r'.n, r'.t, the gradient g of the angle of d and that of the curvature with respect to d."""
    rx, ry, dx, dy, ex, ey = q
    inverse = 1.0 / math.sqrt(dx * dx + dy * dy)
    tx, ty = dx * inverse, dy * inverse
    gx, gy = -ty * inverse, tx * inverse
    hxx, hxy = -2.0 * gx * gy, gx * gx - gy * gy
    return tx, ty, rx * ty - ry * tx, rx * tx + ry * ty, gx, gy, hxx * ex + hxy * ey, hxy * ex - hxx * ey


@kernel(forceinline=True, fastmath=FAST)
def forces(q, s):
    """Return the vectors on r, d and e of stress resultants s."""
    s0, s1, s2, s3, _, _ = s
    tx, ty, along, across, gx, gy, kx, ky = gradients(q)
    turn = s0 * across - s1 * along
    return (
        s0 * ty + s1 * tx,
        s1 * ty - s0 * tx,
        turn * gx + s2 * kx + s3 * tx,
        turn * gy + s2 * ky + s3 * ty,
        s2 * gx,
        s2 * gy,
    )


@kernel(forceinline=True, fastmath=FAST)
def rates(q, dq):
    """Return the change of eps with changes of r, d and e."""
    rx_, ry_, dx_, dy_, ex_, ey_ = dq
    tx, ty, along, across, gx, gy, kx, ky = gradients(q)
    turn = gx * dx_ + gy * dy_
    return (
        rx_ * ty - ry_ * tx + across * turn,
        rx_ * tx + ry_ * ty - along * turn,
        kx * dx_ + ky * dy_ + gx * ex_ + gy * ey_,
        tx * dx_ + ty * dy_,
        0.0,
        0.0,
    )


@kernel(forceinline=True, fastmath=FAST)
def hessian(q, c, k, g, w, s):
    """Return w grad^T c[k, g] grad + sum_i s_i d2 eps_i, as its blocks rr (xx, xy, yy), rd, re (4 each), dd, de, ee."""
    _, _, dx, dy, ex, ey = q
    s0, s1, s2, s3, _, _ = s
    tx, ty, along, across, gx, gy, kx, ky = gradients(q)
    inverse = 1.0 / math.sqrt(dx * dx + dy * dy)
    hxx, hxy = -2.0 * gx * gy, gx * gx - gy * gy
    c00, c01, c02, c03 = w * c[k, g, 0, 0], w * c[k, g, 0, 1], w * c[k, g, 0, 2], w * c[k, g, 0, 3]
    c11, c12, c13 = w * c[k, g, 1, 1], w * c[k, g, 1, 2], w * c[k, g, 1, 3]
    c22, c23, c33 = w * c[k, g, 2, 2], w * c[k, g, 2, 3], w * c[k, g, 3, 3]
    # gradients with respect to d are multiples of g, and k and t; a measure's stress change with d is a vector u_i
    ax, ay, bx, by = across * gx, across * gy, -along * gx, -along * gy
    u0x, u0y = c00 * ax + c01 * bx + c02 * kx + c03 * tx, c00 * ay + c01 * by + c02 * ky + c03 * ty
    u1x, u1y = c01 * ax + c11 * bx + c12 * kx + c13 * tx, c01 * ay + c11 * by + c12 * ky + c13 * ty
    u2x, u2y = c02 * ax + c12 * bx + c22 * kx + c23 * tx, c02 * ay + c12 * by + c22 * ky + c23 * ty
    u3x, u3y = c03 * ax + c13 * bx + c23 * kx + c33 * tx, c03 * ay + c13 * by + c23 * ky + c33 * ty
    # change of n with the angle is t, change of t is -n
    fx, fy = s0 * tx - s1 * ty, s0 * ty + s1 * tx
    mx, my = c02 * ty + c12 * tx, c12 * ty - c02 * tx
    turned, angle = -s0 * along - s1 * across, s0 * across - s1 * along
    # d is read as a complex number: real and imaginary part of 2 / d^3, the third derivative of log d
    cube = 2.0 * inverse * inverse * inverse
    real, imaginary = cube * tx * (tx * tx - 3.0 * ty * ty), cube * ty * (ty * ty - 3.0 * tx * tx)
    bend = s2 * (imaginary * ex + real * ey) + angle * hxx
    stretch = s3 * inverse
    return (
        ty * (c00 * ty + c01 * tx) + tx * (c01 * ty + c11 * tx),
        ty * (c01 * ty - c00 * tx) + tx * (c11 * ty - c01 * tx),
        -tx * (c01 * ty - c00 * tx) + ty * (c11 * ty - c01 * tx),
        ty * u0x + tx * u1x + fx * gx,
        ty * u0y + tx * u1y + fx * gy,
        ty * u1x - tx * u0x + fy * gx,
        ty * u1y - tx * u0y + fy * gy,
        mx * gx,
        mx * gy,
        my * gx,
        my * gy,
        ax * u0x + bx * u1x + kx * u2x + tx * u3x + turned * gx * gx + bend + stretch * ty * ty,
        ax * u0y
        + bx * u1y
        + kx * u2y
        + tx * u3y
        + turned * gx * gy
        + angle * hxy
        + s2 * (real * ex - imaginary * ey)
        - stretch * tx * ty,
        ay * u0y + by * u1y + ky * u2y + ty * u3y + turned * gy * gy - bend + stretch * tx * tx,
        u2x * gx + s2 * hxx,
        u2x * gy + s2 * hxy,
        u2y * gx + s2 * hxy,
        u2y * gy - s2 * hxx,
        c22 * gx * gx,
        c22 * gx * gy,
        c22 * gy * gy,
    )
