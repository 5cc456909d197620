"""Force and tangent of the connection `beamfem.physics.connections.SPRING`.

Written by beamfem.physics.generate: do not edit.
"""

import math

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    v0 = v[0]
    v1 = v[1]
    v2 = v[2]
    v3 = v[3]
    stiffness = data[0]
    damping = data[1]
    length = data[2]
    x0 = q0 - q2
    x1 = q1 - q3
    x2 = (x0 * x0) + (x1 * x1)
    x3 = math.sqrt(x2)
    x4 = 1.0 / x3
    x5 = damping * (x0 * (v0 - v2) + x1 * (v1 - v3)) / x2
    x6 = -stiffness * x4 * (length - x3) + x5
    x7 = stiffness * x4 * (length - math.sqrt((x0 * x0) + (x1 * x1))) - x5
    out[0] = x0 * x6
    out[1] = x1 * x6
    out[2] = x0 * x7
    out[3] = x1 * x7


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    v0 = v[0]
    v1 = v[1]
    v2 = v[2]
    v3 = v[3]
    stiffness = data[0]
    damping = data[1]
    length = data[2]
    x0 = q0 - q2
    x1 = x0 * x0
    x2 = q1 - q3
    x3 = x2 * x2
    x4 = x1 + x3
    x5 = 1.0 / x4
    x6 = damping * x5
    x7 = cv * x6
    x8 = x1 * x7
    x9 = math.sqrt(x4)
    x10 = length - x9
    x11 = stiffness / (x4 * math.sqrt(x4))
    x12 = x10 * x11
    x13 = v0 - v2
    x14 = x0 * x13
    x15 = v1 - v3
    x16 = x15 * x2
    x17 = x14 + x16
    x18 = x17 * x6
    x19 = stiffness / x9
    x20 = -x10 * x19 + x18
    x21 = stiffness * x5
    x22 = 2.0 * damping * x17 / (x4 * x4)
    x23 = x1 * x21 - x1 * x22 + x14 * x6
    x24 = ck * (x1 * x12 + x20 + x23) + x8
    x25 = x2 * x7
    x26 = x15 * x6 + x2 * x21 - x2 * x22
    x27 = x0 * (ck * (x12 * x2 + x26) + x25)
    x28 = length - math.sqrt((x0 * x0) + (x2 * x2))
    x29 = x11 * x28
    x30 = x18 - x19 * x28
    x31 = -ck * (x1 * x29 + x23 + x30) - x8
    x32 = -x0 * (ck * (x2 * x29 + x26) + x25)
    x33 = x0 * x7
    x34 = x0 * x21 - x0 * x22 + x13 * x6
    x35 = x2 * (ck * (x0 * x12 + x34) + x33)
    x36 = x3 * x7
    x37 = x16 * x6 + x21 * x3 - x22 * x3
    x38 = ck * (x12 * x3 + x20 + x37) + x36
    x39 = -x2 * (ck * (x0 * x29 + x34) + x33)
    x40 = -ck * (x29 * x3 + x30 + x37) - x36
    out[0] = x24
    out[1] = x27
    out[2] = x31
    out[3] = x32
    out[4] = x35
    out[5] = x38
    out[6] = x39
    out[7] = x40
    out[8] = x31
    out[9] = x32
    out[10] = x24
    out[11] = x27
    out[12] = x39
    out[13] = x40
    out[14] = x35
    out[15] = x38
