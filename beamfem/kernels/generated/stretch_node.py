"""Passes of nodes of the kind `beamfem.physics.kinematics.STRETCH`.

Rows: u_s, u_theta, v_s, v_theta, a_s, a_theta, c, s, length; then results.

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
        u_s = own[0]
        v_s = own[144]
        v_theta = own[216]
        a_s = own[288]
        a_theta = own[360]
        c = own[432]
        s = own[504]
        x0 = c * u_s
        x1 = s * u_s
        x2 = -s
        x3 = 2.0 * v_s * v_theta
        x4 = v_theta * v_theta
        own[648] = x0
        own[720] = x1
        own[792] = x2
        own[864] = c
        own[936] = a_s * c - a_theta * x1 - s * x3 - x0 * x4
        own[1008] = a_s * s + a_theta * x0 + c * x3 - x1 * x4
        own[1080] = -a_theta * c + s * x4
        own[1152] = -a_theta * s - c * x4
        own[1224] = c
        own[1296] = -x1
        own[1368] = s
        own[1440] = x0
        own[1512] = 0.0
        own[1584] = -c
        own[1656] = 0.0
        own[1728] = x2


@routine("iddv", fastmath=FAST)
def convect(count, ck, cv, x):
    """Fill ck dw''/du + cv dw''/du'."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        u_s = own[0]
        v_s = own[144]
        v_theta = own[216]
        a_s = own[288]
        a_theta = own[360]
        c = own[432]
        s = own[504]
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
        own[648] = -x5
        own[720] = -ck * (a_s * s - u_s * x11 + u_s * x8 + x10 * x9) - x0 * (c * x7 + x6)
        own[792] = x12
        own[864] = -ck * (-a_s * c + u_s * x2 + u_s * x4 + x10 * x6) + 2.0 * cv * (-s * x7 + x9)
        own[936] = 0.0
        own[1008] = x5
        own[1080] = 0.0
        own[1152] = -x12


@routine("iv", fastmath=FAST)
def curve(count, x):
    """Fill the derivative of B^T f."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        u_s = own[0]
        c = own[432]
        s = own[504]
        f0 = own[648]
        f1 = own[720]
        f2 = own[792]
        f3 = own[864]
        x0 = c * f1 - f0 * s
        own[936] = 0.0
        own[1008] = x0
        own[1080] = x0
        own[1152] = -c * f0 * u_s - c * f3 - f1 * s * u_s + f2 * s
