"""Force and tangent of the connection `beamfem.physics.connections.BODY`.

Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
    v0 = v[0]
    v1 = v[1]
    v2 = v[2]
    a0 = a[0]
    a1 = a[1]
    a2 = a[2]
    mass = data[0]
    inertia = data[1]
    along = data[2]
    across = data[3]
    gx = gravity[0]
    gy = gravity[1]
    c2 = turned[0]
    s2 = turned[1]
    x0 = across * c2 + along * s2
    x1 = v2 * v2
    x2 = across * s2 - along * c2
    x3 = -x2
    x4 = v0 - v2 * x0
    x5 = mass * v2
    out[0] = mass * (a0 - a2 * x0 - gx + x1 * x2)
    out[1] = mass * (a1 - a2 * x2 - gy - x0 * x1)
    out[2] = (
        -a0 * mass * x0
        - a1 * mass * x2
        + a2 * (inertia + mass * ((x0 * x0) + (x2 * x2)))
        + mass * (gx * x0 + gy * x2)
        + x5 * (-x0 * (v1 - v2 * x2) + x2 * x4)
        + x5 * (x0 * (v1 + v2 * x3) + x3 * x4)
    )


@routine("rrrrrrrdddr")
def tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da, row by row."""
    v2 = v[2]
    a0 = a[0]
    a1 = a[1]
    a2 = a[2]
    mass = data[0]
    inertia = data[1]
    along = data[2]
    across = data[3]
    gx = gravity[0]
    gy = gravity[1]
    c2 = turned[0]
    s2 = turned[1]
    x0 = ca * mass
    x1 = across * c2 + along * s2
    x2 = across * s2 - along * c2
    x3 = 2.0 * cv * v2
    x4 = v2 * v2
    out[0] = x0
    out[1] = 0.0
    out[2] = mass * (-ca * x1 + ck * (a2 * x2 + x1 * x4) + x2 * x3)
    out[3] = 0.0
    out[4] = x0
    out[5] = mass * (-ca * x2 + ck * (-a2 * x1 + x2 * x4) - x1 * x3)
    out[6] = -x0 * x1
    out[7] = -x0 * x2
    out[8] = ca * (inertia + mass * ((x1 * x1) + (x2 * x2))) - ck * mass * (-a0 * x2 + a1 * x1 + gx * x2 - gy * x1)
