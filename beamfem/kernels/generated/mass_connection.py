"""Force and tangent of the connection `beamfem.physics.connections.MASS`.

Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    a0 = a[0]
    a1 = a[1]
    mass = data[0]
    gx = gravity[0]
    gy = gravity[1]
    out[0] = mass * (a0 - gx)
    out[1] = mass * (a1 - gy)


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    mass = data[0]
    x0 = ca * mass
    out[0] = x0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = x0
