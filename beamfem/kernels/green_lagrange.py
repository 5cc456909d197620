"""Components of E = (F^T F - 1)/2 for r = r0 + y d in powers of y; paper, section 3.3.

eps = (a, b, c, eyy, g0, g1) with exx = a + b y + c y^2 and 2 exy = g0 + g1 y. Arguments r = r0', d and e = d'. Each is
the product of two of these vectors, so that its gradient is one of them: with respect to r, eps 0, 4, 1 have gradients
r, d, e; with respect to d, eps 4, 3, 5; with respect to e, eps 1, 5, 2.
"""

from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True, fastmath=FAST)
def strains(q):
    """Return eps."""
    rx, ry, dx, dy, ex, ey = q
    return (
        0.5 * (rx * rx + ry * ry - 1.0),
        rx * ex + ry * ey,
        0.5 * (ex * ex + ey * ey),
        0.5 * (dx * dx + dy * dy - 1.0),
        rx * dx + ry * dy,
        dx * ex + dy * ey,
    )


@kernel(forceinline=True, fastmath=FAST)
def forces(q, s):
    """Return the vectors on r, d and e of stress resultants s."""
    rx, ry, dx, dy, ex, ey = q
    s0, s1, s2, s3, s4, s5 = s
    return (
        s0 * rx + s4 * dx + s1 * ex,
        s0 * ry + s4 * dy + s1 * ey,
        s4 * rx + s3 * dx + s5 * ex,
        s4 * ry + s3 * dy + s5 * ey,
        s1 * rx + s5 * dx + s2 * ex,
        s1 * ry + s5 * dy + s2 * ey,
    )


@kernel(forceinline=True, fastmath=FAST)
def rates(q, dq):
    """Return the change of eps with changes of r, d and e."""
    rx, ry, dx, dy, ex, ey = q
    rx_, ry_, dx_, dy_, ex_, ey_ = dq
    return (
        rx * rx_ + ry * ry_,
        rx * ex_ + ry * ey_ + ex * rx_ + ey * ry_,
        ex * ex_ + ey * ey_,
        dx * dx_ + dy * dy_,
        rx * dx_ + ry * dy_ + dx * rx_ + dy * ry_,
        dx * ex_ + dy * ey_ + ex * dx_ + ey * dy_,
    )


@kernel(forceinline=True, fastmath=FAST)
def _products(w, q, c, k, p, rows, columns):
    """Return w sum_kl c[k, p, rows_k, columns_l] v_k v_l^T (xx, xy, yx, yy) of the vectors v = r, d, e in q."""
    rx, ry, dx, dy, ex, ey = q
    i0, i1, i2 = rows
    j0, j1, j2 = columns
    a, b, g = w * c[k, p, i0, j0], w * c[k, p, i0, j1], w * c[k, p, i0, j2]
    ux, uy = a * rx + b * dx + g * ex, a * ry + b * dy + g * ey
    a, b, g = w * c[k, p, i1, j0], w * c[k, p, i1, j1], w * c[k, p, i1, j2]
    vx, vy = a * rx + b * dx + g * ex, a * ry + b * dy + g * ey
    a, b, g = w * c[k, p, i2, j0], w * c[k, p, i2, j1], w * c[k, p, i2, j2]
    wx, wy = a * rx + b * dx + g * ex, a * ry + b * dy + g * ey
    return (
        rx * ux + dx * vx + ex * wx,
        rx * uy + dx * vy + ex * wy,
        ry * ux + dy * vx + ey * wx,
        ry * uy + dy * vy + ey * wy,
    )


@kernel(forceinline=True, fastmath=FAST)
def hessian(q, c, k, g, w, s):
    """Return w grad^T c[k, g] grad + sum_i s_i d2 eps_i, as its blocks rr (xx, xy, yy), rd, re (4 each), dd, de, ee."""
    s0, s1, s2, s3, s4, s5 = s
    on_r, on_d, on_e = (0, 4, 1), (4, 3, 5), (1, 5, 2)
    rr = _products(w, q, c, k, g, on_r, on_r)
    rd = _products(w, q, c, k, g, on_r, on_d)
    re = _products(w, q, c, k, g, on_r, on_e)
    dd = _products(w, q, c, k, g, on_d, on_d)
    de = _products(w, q, c, k, g, on_d, on_e)
    ee = _products(w, q, c, k, g, on_e, on_e)
    return (
        rr[0] + s0,
        rr[1],
        rr[3] + s0,
        rd[0] + s4,
        rd[1],
        rd[2],
        rd[3] + s4,
        re[0] + s1,
        re[1],
        re[2],
        re[3] + s1,
        dd[0] + s3,
        dd[1],
        dd[3] + s3,
        de[0] + s5,
        de[1],
        de[2],
        de[3] + s5,
        ee[0] + s2,
        ee[1],
        ee[3] + s2,
    )
