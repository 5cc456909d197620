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
    x4 = (damping * x3 * (x0 * (v0 - v2) + x1 * (v1 - v3)) - stiffness * x2 * (length - x3)) / (x2 * math.sqrt(x2))
    x5 = x0 * x4
    x6 = x1 * x4
    out[0] = x5
    out[1] = x6
    out[2] = -x5
    out[3] = -x6


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
    x6 = x1 * x5
    x7 = cv * damping
    x8 = x6 * x7
    x9 = v0 - v2
    x10 = math.sqrt(x4)
    x11 = damping * x10
    x12 = stiffness * x10
    x13 = stiffness * (length - x10)
    x14 = 2.0 * x13
    x15 = v1 - v3
    x16 = x0 * x9 + x15 * x2
    x17 = x16 / x10
    x18 = damping * x0 * x17 + x0 * x12 - x0 * x14 + x11 * x9
    x19 = x13 * x4
    x20 = x11 * x16
    x21 = -x19 + x20
    x22 = 3.0 * x21
    x23 = x22 * x6
    x24 = x0 * x18 + x21 - x23
    x25 = ck / (x4 * math.sqrt(x4))
    x26 = x24 * x25 + x8
    x27 = -cv * damping * x2 * x5
    x28 = damping * x17
    x29 = x11 * x15 + x12 * x2 - x14 * x2 + x2 * x28
    x30 = x25 * (3.0 * x2 * x21 * x5 - x29) + x27
    x31 = -x8
    x32 = x0 * x30
    x33 = -cv * damping * x0 * x5
    x34 = x25 * (3.0 * x0 * x21 * x5 - x18) + x33
    x35 = x3 * x5 * x7
    x36 = x22 * x5
    x37 = x3 * x36
    x38 = x2 * x29 + x21 - x37
    x39 = x25 * x38 + x35
    x40 = x2 * x34
    x41 = -x35
    x42 = -x0
    x43 = -x11 * x9 + x12 * x42 - x14 * x42 + x28 * x42
    x44 = x19 - x20
    x45 = -x2
    x46 = -x11 * x15 + x12 * x45 - x14 * x45 + x28 * x45
    out[0] = x26
    out[1] = -x0 * x30
    out[2] = -x24 * x25 + x31
    out[3] = x32
    out[4] = -x2 * x34
    out[5] = x39
    out[6] = x40
    out[7] = -x25 * x38 + x41
    out[8] = -x26
    out[9] = x32
    out[10] = -x25 * (x0 * x43 + x23 + x44) - x31
    out[11] = x0 * (-x25 * (x2 * x22 * x5 + x46) - x27)
    out[12] = x40
    out[13] = -x39
    out[14] = x2 * (-x25 * (x0 * x36 + x43) - x33)
    out[15] = -x25 * (x2 * x46 + x37 + x44) - x41
