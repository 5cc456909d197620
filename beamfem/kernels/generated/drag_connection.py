"""Force and tangent of the connection `beamfem.physics.connections.DRAG`.

Written by beamfem.physics.generate: do not edit.
"""

import math

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    v0 = v[0]
    v1 = v[1]
    coefficient = data[0]
    x0 = coefficient * math.sqrt((v0 * v0) + (v1 * v1) + 1.0e-300)
    out[0] = v0 * x0
    out[1] = v1 * x0


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    v0 = v[0]
    v1 = v[1]
    coefficient = data[0]
    x0 = v0 * v0
    x1 = v1 * v1
    x2 = math.sqrt(x0 + x1 + 1.0e-300)
    x3 = 1.0 / x2
    x4 = coefficient * cv
    x5 = v0 * v1 * x3 * x4
    out[0] = x4 * (x0 * x3 + x2)
    out[1] = x5
    out[2] = x5
    out[3] = x4 * (x1 * x3 + x2)
