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
    x1 = q1 - y
    x2 = (x0 * x0) + (x1 * x1)
    x3 = math.sqrt(x2)
    x4 = (damping * x3 * (v0 * x0 + v1 * x1) - stiffness * x2 * (length - x3)) / (x2 * math.sqrt(x2))
    out[0] = x0 * x4
    out[1] = x1 * x4


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
    x6 = x1 * x5
    x7 = cv * damping
    x8 = math.sqrt(x4)
    x9 = damping * x8
    x10 = stiffness * x8
    x11 = stiffness * (length - x8)
    x12 = 2.0 * x11
    x13 = v0 * x0 + v1 * x2
    x14 = x13 / x8
    x15 = damping * x0 * x14 + v0 * x9 + x0 * x10 - x0 * x12
    x16 = -x11 * x4 + x13 * x9
    x17 = 3.0 * x16
    x18 = ck / (x4 * math.sqrt(x4))
    x19 = damping * x14 * x2 + v1 * x9 + x10 * x2 - x12 * x2
    out[0] = x18 * (x0 * x15 + x16 - x17 * x6) + x6 * x7
    out[1] = x0 * (cv * damping * x2 * x5 - x18 * (3.0 * x16 * x2 * x5 - x19))
    out[2] = x2 * (cv * damping * x0 * x5 - x18 * (3.0 * x0 * x16 * x5 - x15))
    out[3] = x18 * (x16 - x17 * x3 * x5 + x19 * x2) + x3 * x5 * x7
