"""Passes of nodes of the kind `beamfem.physics.kinematics.SHEAR_RIGID`.

Rows: u_theta, v_theta, a_theta, c, s, length; then results.

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
        v_theta = x[1 * ROW + i]
        a_theta = x[2 * ROW + i]
        c = x[3 * ROW + i]
        s = x[4 * ROW + i]
        length = x[5 * ROW + i]
        x0 = c * length
        x1 = length * s
        x2 = -s
        x3 = v_theta * v_theta
        x4 = a_theta * s + c * x3
        x5 = a_theta * c - s * x3
        x[6 * ROW + i] = x0
        x[7 * ROW + i] = x1
        x[8 * ROW + i] = x2
        x[9 * ROW + i] = c
        x[10 * ROW + i] = -length * x4
        x[11 * ROW + i] = length * x5
        x[12 * ROW + i] = -x5
        x[13 * ROW + i] = -x4
        x[14 * ROW + i] = -x1
        x[15 * ROW + i] = x0
        x[16 * ROW + i] = -c
        x[17 * ROW + i] = x2


@routine("iddv", fastmath=FAST)
def convect(count, ck, cv, x):
    """Fill ck dw''/du + cv dw''/du'."""
    for i in range(0, count, WIDTH):
        v_theta = x[1 * ROW + i]
        a_theta = x[2 * ROW + i]
        c = x[3 * ROW + i]
        s = x[4 * ROW + i]
        length = x[5 * ROW + i]
        x0 = 2.0 * cv * v_theta
        x1 = v_theta * v_theta
        x2 = c * x0 + ck * (a_theta * c - s * x1)
        x3 = ck * (a_theta * s + c * x1) + s * x0
        x[6 * ROW + i] = -length * x2
        x[7 * ROW + i] = -length * x3
        x[8 * ROW + i] = x3
        x[9 * ROW + i] = -x2


@routine("iv", fastmath=FAST)
def curve(count, x):
    """Fill the derivative of B^T f."""
    for i in range(0, count, WIDTH):
        c = x[3 * ROW + i]
        s = x[4 * ROW + i]
        length = x[5 * ROW + i]
        f0 = x[6 * ROW + i]
        f1 = x[7 * ROW + i]
        f2 = x[8 * ROW + i]
        f3 = x[9 * ROW + i]
        x[10 * ROW + i] = -c * f0 * length - c * f3 - f1 * length * s + f2 * s
