"""Passes of nodes of the kind `beamfem.physics.kinematics.ROTATION`.

Rows: u_theta, v_theta, a_theta, c, s, length; then results.

A row has 72 numbers. Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at
from beamfem.kernels.simd import WIDTH

FAST = {"contract", "reassoc", "nsz"}


@routine("iv", fastmath=FAST)
def place(count, x):
    """Fill w, w'' and B."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        v_theta = own[72]
        a_theta = own[144]
        c = own[216]
        s = own[288]
        x0 = -s
        x1 = v_theta * v_theta
        own[432] = x0
        own[504] = c
        own[576] = -a_theta * c + s * x1
        own[648] = -a_theta * s - c * x1
        own[720] = -c
        own[792] = x0


@routine("iddv", fastmath=FAST)
def convect(count, ck, cv, x):
    """Fill ck dw''/du + cv dw''/du'."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        v_theta = own[72]
        a_theta = own[144]
        c = own[216]
        s = own[288]
        x0 = 2.0 * cv * v_theta
        x1 = v_theta * v_theta
        own[432] = ck * (a_theta * s + c * x1) + s * x0
        own[504] = -c * x0 - ck * (a_theta * c - s * x1)


@routine("iv", fastmath=FAST)
def curve(count, x):
    """Fill the derivative of B^T f."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        c = own[216]
        s = own[288]
        f0 = own[432]
        f1 = own[504]
        own[576] = -c * f1 + f0 * s
