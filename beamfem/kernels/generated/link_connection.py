"""Force and tangent of the connection `beamfem.physics.connections.LINK`.

Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    own0 = own[0]
    length = data[0]
    x0 = q0 - q2
    x1 = 1.0 / length
    x2 = own0 * x1
    x3 = x0 * x2
    x4 = q1 - q3
    x5 = x2 * x4
    out[0] = x3
    out[1] = x5
    out[2] = -x3
    out[3] = -x5
    out[4] = (0.5) * x1 * (-(length * length) + (x0 * x0) + (x4 * x4))


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    own0 = own[0]
    length = data[0]
    x0 = ck / length
    x1 = own0 * x0
    x2 = -x1
    x3 = x0 * (q0 - q2)
    x4 = x0 * (q1 - q3)
    x5 = -x3
    x6 = -x4
    out[0] = x1
    out[1] = 0.0
    out[2] = x2
    out[3] = 0.0
    out[4] = x3
    out[5] = 0.0
    out[6] = x1
    out[7] = 0.0
    out[8] = x2
    out[9] = x4
    out[10] = x2
    out[11] = 0.0
    out[12] = x1
    out[13] = 0.0
    out[14] = x5
    out[15] = 0.0
    out[16] = x2
    out[17] = 0.0
    out[18] = x1
    out[19] = x6
    out[20] = x3
    out[21] = x4
    out[22] = x5
    out[23] = x6
    out[24] = 0.0
