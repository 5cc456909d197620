"""Force and tangent of the connection `beamfem.physics.connections.TORSION_SPRING`.

Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    q2 = q[2]
    q5 = q[5]
    v2 = v[2]
    v5 = v[5]
    stiffness = data[0]
    damping = data[1]
    x0 = damping * (v2 - v5) + stiffness * (q2 - q5)
    out[0] = 0.0
    out[1] = 0.0
    out[2] = x0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = -x0


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    stiffness = data[0]
    damping = data[1]
    x0 = ck * stiffness + cv * damping
    x1 = -x0
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    out[8] = 0.0
    out[9] = 0.0
    out[10] = 0.0
    out[11] = 0.0
    out[12] = 0.0
    out[13] = 0.0
    out[14] = x0
    out[15] = 0.0
    out[16] = 0.0
    out[17] = x1
    out[18] = 0.0
    out[19] = 0.0
    out[20] = 0.0
    out[21] = 0.0
    out[22] = 0.0
    out[23] = 0.0
    out[24] = 0.0
    out[25] = 0.0
    out[26] = 0.0
    out[27] = 0.0
    out[28] = 0.0
    out[29] = 0.0
    out[30] = 0.0
    out[31] = 0.0
    out[32] = x1
    out[33] = 0.0
    out[34] = 0.0
    out[35] = x0
