"""Force and tangent of the connection `beamfem.physics.connections.BODY`.

Written by beamfem.physics.generate: do not edit.
"""

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def force(q, v, a, own, turned, data, gravity, out):
    """Fill the force."""
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
    x0 = across * c2
    x1 = along * s2
    x2 = x0 + x1
    x3 = v2 * v2
    x4 = across * s2
    x5 = along * c2
    x6 = x4 - x5
    x7 = mass * x5
    x8 = gx * mass
    x9 = mass * x4
    x10 = a2 * mass
    x11 = a0 * mass
    out[0] = mass * (a0 - a2 * x2 - gx + x3 * x6)
    out[1] = -mass * (-a1 + a2 * x6 + gy + x2 * x3)
    out[2] = (
        a1 * x7
        - a1 * x9
        + a2 * inertia
        + (across * across) * x10
        + (along * along) * x10
        - gy * x7
        + gy * x9
        - x0 * x11
        + x0 * x8
        - x1 * x11
        + x1 * x8
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
    x1 = across * c2
    x2 = along * s2
    x3 = x1 + x2
    x4 = across * s2
    x5 = -along * c2 + x4
    x6 = -x5
    x7 = v2 * v2
    x8 = along * c2
    out[0] = x0
    out[1] = 0.0
    out[2] = mass * (-ca * x3 - ck * (a2 * x6 - x3 * x7) + 2.0 * cv * v2 * x5)
    out[3] = 0.0
    out[4] = x0
    out[5] = -mass * (ca * x5 + ck * (a2 * x3 + x6 * x7) + 2.0 * cv * v2 * x3)
    out[6] = -x0 * x3
    out[7] = -x0 * x5
    out[8] = ca * ((across * across) * mass + (along * along) * mass + inertia) + ck * mass * (
        a0 * x4 - a0 * x8 - a1 * x1 - a1 * x2 - gx * x4 + gx * x8 + gy * x1 + gy * x2
    )
