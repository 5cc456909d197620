"""Passes of nodes of the kind `beamfem.physics.kinematics.ROTATION`.

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
        x0 = -s
        x1 = v_theta * v_theta
        x[6 * ROW + i] = x0
        x[7 * ROW + i] = c
        x[8 * ROW + i] = -a_theta * c + s * x1
        x[9 * ROW + i] = -a_theta * s - c * x1
        x[10 * ROW + i] = -c
        x[11 * ROW + i] = x0


@routine("iddv", fastmath=FAST)
def convect(count, ck, cv, x):
    """Fill ck dw''/du + cv dw''/du'."""
    for i in range(0, count, WIDTH):
        v_theta = x[1 * ROW + i]
        a_theta = x[2 * ROW + i]
        c = x[3 * ROW + i]
        s = x[4 * ROW + i]
        x0 = 2.0 * cv * v_theta
        x1 = v_theta * v_theta
        x[6 * ROW + i] = ck * (a_theta * s + c * x1) + s * x0
        x[7 * ROW + i] = -c * x0 - ck * (a_theta * c - s * x1)


@routine("iv", fastmath=FAST)
def curve(count, x):
    """Fill the derivative of B^T f."""
    for i in range(0, count, WIDTH):
        c = x[3 * ROW + i]
        s = x[4 * ROW + i]
        f0 = x[6 * ROW + i]
        f1 = x[7 * ROW + i]
        x[8 * ROW + i] = -c * f1 + f0 * s
