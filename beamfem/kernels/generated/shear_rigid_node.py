"""Passes of nodes of the kind `beamfem.physics.kinematics.SHEAR_RIGID`.

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
        length = own[360]
        x0 = c * length
        x1 = length * s
        x2 = -s
        x3 = v_theta * v_theta
        x4 = a_theta * s + c * x3
        x5 = a_theta * c - s * x3
        own[432] = x0
        own[504] = x1
        own[576] = x2
        own[648] = c
        own[720] = -length * x4
        own[792] = length * x5
        own[864] = -x5
        own[936] = -x4
        own[1008] = -x1
        own[1080] = x0
        own[1152] = -c
        own[1224] = x2


@routine("iddv", fastmath=FAST)
def convect(count, ck, cv, x):
    """Fill ck dw''/du + cv dw''/du'."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        v_theta = own[72]
        a_theta = own[144]
        c = own[216]
        s = own[288]
        length = own[360]
        x0 = 2.0 * cv * v_theta
        x1 = v_theta * v_theta
        x2 = c * x0 + ck * (a_theta * c - s * x1)
        x3 = ck * (a_theta * s + c * x1) + s * x0
        own[432] = -length * x2
        own[504] = -length * x3
        own[576] = x3
        own[648] = -x2


@routine("iv", fastmath=FAST)
def curve(count, x):
    """Fill the derivative of B^T f."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        c = own[216]
        s = own[288]
        length = own[360]
        f0 = own[432]
        f1 = own[504]
        f2 = own[576]
        f3 = own[648]
        own[720] = -c * f0 * length - c * f3 - f1 * length * s + f2 * s
