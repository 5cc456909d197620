"""Passes of nodes of the kind `beamfem.physics.kinematics.STRETCH`.

Rows: u_s, u_theta, v_s, v_theta, a_s, a_theta, c, s, length; then results.

Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine
from beamfem.kernels.lanes import WIDTH
from beamfem.kernels.record import ROW

FAST = {"contract", "reassoc", "nsz"}


@routine("iv", fastmath=FAST)
def place(count, x):
    """Fill w, w'' and B."""
    for i in range(0, count, WIDTH):
        u_s = x[0 * ROW + i]
        v_s = x[2 * ROW + i]
        v_theta = x[3 * ROW + i]
        a_s = x[4 * ROW + i]
        a_theta = x[5 * ROW + i]
        c = x[6 * ROW + i]
        s = x[7 * ROW + i]
        x0 = c * u_s
        x1 = s * u_s
        x2 = -s
        x3 = 2.0 * v_s * v_theta
        x4 = v_theta * v_theta
        x[9 * ROW + i] = x0
        x[10 * ROW + i] = x1
        x[11 * ROW + i] = x2
        x[12 * ROW + i] = c
        x[13 * ROW + i] = a_s * c - a_theta * x1 - s * x3 - x0 * x4
        x[14 * ROW + i] = a_s * s + a_theta * x0 + c * x3 - x1 * x4
        x[15 * ROW + i] = -a_theta * c + s * x4
        x[16 * ROW + i] = -a_theta * s - c * x4
        x[17 * ROW + i] = c
        x[18 * ROW + i] = -x1
        x[19 * ROW + i] = s
        x[20 * ROW + i] = x0
        x[21 * ROW + i] = 0.0
        x[22 * ROW + i] = -c
        x[23 * ROW + i] = 0.0
        x[24 * ROW + i] = x2


@routine("iddv", fastmath=FAST)
def convect(count, ck, cv, x):
    """Fill ck dw''/du + cv dw''/du'."""
    for i in range(0, count, WIDTH):
        u_s = x[0 * ROW + i]
        v_s = x[2 * ROW + i]
        v_theta = x[3 * ROW + i]
        a_s = x[4 * ROW + i]
        a_theta = x[5 * ROW + i]
        c = x[6 * ROW + i]
        s = x[7 * ROW + i]
        x0 = 2.0 * cv
        x1 = v_theta * x0
        x2 = a_theta * s
        x3 = v_theta * v_theta
        x4 = c * x3
        x5 = ck * (x2 + x4) + s * x1
        x6 = s * v_s
        x7 = u_s * v_theta
        x8 = a_theta * c
        x9 = c * v_s
        x10 = 2.0 * v_theta
        x11 = s * x3
        x12 = c * x1 + ck * (-x11 + x8)
        x[9 * ROW + i] = -x5
        x[10 * ROW + i] = -ck * (a_s * s - u_s * x11 + u_s * x8 + x10 * x9) - x0 * (c * x7 + x6)
        x[11 * ROW + i] = x12
        x[12 * ROW + i] = -ck * (-a_s * c + u_s * x2 + u_s * x4 + x10 * x6) + 2.0 * cv * (-s * x7 + x9)
        x[13 * ROW + i] = 0.0
        x[14 * ROW + i] = x5
        x[15 * ROW + i] = 0.0
        x[16 * ROW + i] = -x12


@routine("iv", fastmath=FAST)
def curve(count, x):
    """Fill the derivative of B^T f."""
    for i in range(0, count, WIDTH):
        u_s = x[0 * ROW + i]
        c = x[6 * ROW + i]
        s = x[7 * ROW + i]
        f0 = x[9 * ROW + i]
        f1 = x[10 * ROW + i]
        f2 = x[11 * ROW + i]
        f3 = x[12 * ROW + i]
        x0 = c * f1 - f0 * s
        x[13 * ROW + i] = 0.0
        x[14 * ROW + i] = x0
        x[15 * ROW + i] = x0
        x[16 * ROW + i] = -c * f0 * u_s - c * f3 - f1 * s * u_s + f2 * s
