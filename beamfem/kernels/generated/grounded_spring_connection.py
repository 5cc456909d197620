"""Force and tangent of the connection `beamfem.physics.connections.GROUNDED_SPRING`.

Written by beamfem.physics.generate: do not edit.
"""

import math

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    q0 = q[0]
    q1 = q[1]
    v0 = v[0]
    v1 = v[1]
    stiffness = data[0]
    damping = data[1]
    length = data[2]
    x = data[3]
    y = data[4]
    x0 = q0 - x
    x1 = -x0
    x2 = q1 - y
    x3 = -x2
    x4 = (x0 * x0) + (x2 * x2)
    x5 = damping * (v0 * x1 + v1 * x3) / x4 + stiffness * (length - math.sqrt((x1 * x1) + (x3 * x3))) / math.sqrt(x4)
    out[0] = -x0 * x5
    out[1] = -x2 * x5


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    q0 = q[0]
    q1 = q[1]
    v0 = v[0]
    v1 = v[1]
    stiffness = data[0]
    damping = data[1]
    length = data[2]
    x = data[3]
    y = data[4]
    x0 = q0 - x
    x1 = x0 * x0
    x2 = q1 - y
    x3 = x2 * x2
    x4 = x1 + x3
    x5 = 1.0 / x4
    x6 = damping * x5
    x7 = cv * x6
    x8 = stiffness * x5
    x9 = v0 * x0
    x10 = math.sqrt(x4)
    x11 = stiffness * (length - x10)
    x12 = x11 / (x4 * math.sqrt(x4))
    x13 = v1 * x2
    x14 = x13 + x9
    x15 = 2.0 * damping * x14 / (x4 * x4)
    x16 = x14 * x6 - x11 / x10
    out[0] = ck * (x1 * x12 - x1 * x15 + x1 * x8 + x16 + x6 * x9) + x1 * x7
    out[1] = x0 * (ck * (v1 * x6 + x12 * x2 - x15 * x2 + x2 * x8) + x2 * x7)
    out[2] = x2 * (ck * (v0 * x6 + x0 * x12 - x0 * x15 + x0 * x8) + x0 * x7)
    out[3] = ck * (x12 * x3 + x13 * x6 - x15 * x3 + x16 + x3 * x8) + x3 * x7
