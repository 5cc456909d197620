"""Forces and tangents of parts at points and at stations, see `physics.connections` and `physics.stations`.

Written by beamfem.physics.generate: do not edit.
"""

import math

from beamfem.kernels.compiling import routine


@routine("rrrrrrrr")
def mass_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `MASS`."""
    a0 = a[0]
    a1 = a[1]
    mass = data[0]
    gx = gravity[0]
    gy = gravity[1]
    out[0] = mass * (a0 - gx)
    out[1] = mass * (a1 - gy)


@routine("rrrrrrrdddr")
def mass_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `MASS`, row by row."""
    mass = data[0]
    x0 = ca * mass
    out[0] = x0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = x0


@routine("rrrrrrrr")
def body_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `BODY`."""
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
def body_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `BODY`, row by row."""
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


@routine("rrrrrrrr")
def spring_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `SPRING`."""
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
def spring_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `SPRING`, row by row."""
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


@routine("rrrrrrrr")
def grounded_spring_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `GROUNDED_SPRING`."""
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
def grounded_spring_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `GROUNDED_SPRING`, row by row."""
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


@routine("rrrrrrrr")
def coordinate_spring_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `COORDINATE_SPRING`."""
    q0 = q[0]
    stiffness = data[0]
    rest = data[1]
    out[0] = stiffness * (q0 - rest)


@routine("rrrrrrrdddr")
def coordinate_spring_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `COORDINATE_SPRING`, row by row."""
    stiffness = data[0]
    out[0] = ck * stiffness


@routine("rrrrrrrr")
def torsion_spring_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `TORSION_SPRING`."""
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
def torsion_spring_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `TORSION_SPRING`, row by row."""
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


@routine("rrrrrrrr")
def cable_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `CABLE`."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    stiffness = data[0]
    length = data[1]
    x0 = q0 - q2
    x1 = q1 - q3
    x2 = math.sqrt((x0 * x0) + (x1 * x1))
    x3 = length - x2
    x4 = 2.0 * x3 / x2
    x5 = x0 * x4
    x6 = x3 < 0.0
    x7 = (0.5) * stiffness
    x8 = x1 * x4
    out[0] = x7 * ((-x5) if x6 else (0.0))
    out[1] = x7 * ((-x8) if x6 else (0.0))
    out[2] = x7 * ((x5) if x6 else (0.0))
    out[3] = x7 * ((x8) if x6 else (0.0))


@routine("rrrrrrrdddr")
def cable_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `CABLE`, row by row."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    stiffness = data[0]
    length = data[1]
    x0 = q0 - q2
    x1 = x0 * x0
    x2 = q1 - q3
    x3 = x2 * x2
    x4 = x1 + x3
    x5 = 1.0 / x4
    x6 = x1 * x5
    x7 = math.sqrt(x4)
    x8 = 1.0 / x7
    x9 = length - x7
    x10 = -x8 * x9
    x11 = 1.0 / (x4 * math.sqrt(x4))
    x12 = x11 * x9
    x13 = x9 < 0.0
    x14 = (0.5) * ck * stiffness
    x15 = x14 * ((2.0 * x1 * x12 + 2.0 * x10 + 2.0 * x6) if x13 else (0.0))
    x16 = 2.0 * x0 * x2
    x17 = x14 * ((x16 * (x12 + x5)) if x13 else (0.0))
    x18 = length - math.sqrt((x0 * x0) + (x2 * x2))
    x19 = -x18 * x8
    x20 = x11 * x18
    x21 = x14 * ((-2.0 * x1 * x20 - 2.0 * x19 - 2.0 * x6) if x13 else (0.0))
    x22 = x14 * ((-x16 * (x20 + x5)) if x13 else (0.0))
    x23 = x3 * x5
    x24 = x14 * ((2.0 * x10 + 2.0 * x12 * x3 + 2.0 * x23) if x13 else (0.0))
    x25 = x14 * ((-2.0 * x19 - 2.0 * x20 * x3 - 2.0 * x23) if x13 else (0.0))
    out[0] = x15
    out[1] = x17
    out[2] = x21
    out[3] = x22
    out[4] = x17
    out[5] = x24
    out[6] = x22
    out[7] = x25
    out[8] = x21
    out[9] = x22
    out[10] = x15
    out[11] = x17
    out[12] = x22
    out[13] = x25
    out[14] = x17
    out[15] = x24


@routine("rrrrrrrr")
def grounded_cable_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `GROUNDED_CABLE`."""
    q0 = q[0]
    q1 = q[1]
    stiffness = data[0]
    length = data[1]
    x = data[2]
    y = data[3]
    x0 = q0 - x
    x1 = q1 - y
    x2 = math.sqrt((x0 * x0) + (x1 * x1))
    x3 = length - x2
    x4 = 2.0 * x3 / x2
    x5 = x3 < 0.0
    x6 = (0.5) * stiffness
    out[0] = x6 * ((-x0 * x4) if x5 else (0.0))
    out[1] = x6 * ((-x1 * x4) if x5 else (0.0))


@routine("rrrrrrrdddr")
def grounded_cable_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `GROUNDED_CABLE`, row by row."""
    q0 = q[0]
    q1 = q[1]
    stiffness = data[0]
    length = data[1]
    x = data[2]
    y = data[3]
    x0 = q0 - x
    x1 = x0 * x0
    x2 = q1 - y
    x3 = x2 * x2
    x4 = x1 + x3
    x5 = 1.0 / x4
    x6 = math.sqrt(x4)
    x7 = length - x6
    x8 = -x7 / x6
    x9 = x7 / (x4 * math.sqrt(x4))
    x10 = x7 < 0.0
    x11 = (0.5) * ck * stiffness
    x12 = x11 * ((2.0 * x0 * x2 * (x5 + x9)) if x10 else (0.0))
    out[0] = x11 * ((2.0 * x1 * x5 + 2.0 * x1 * x9 + 2.0 * x8) if x10 else (0.0))
    out[1] = x12
    out[2] = x12
    out[3] = x11 * ((2.0 * x3 * x5 + 2.0 * x3 * x9 + 2.0 * x8) if x10 else (0.0))


@routine("rrrrrrrr")
def bushing_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `BUSHING`."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    q4 = q[4]
    q5 = q[5]
    v0 = v[0]
    v1 = v[1]
    v2 = v[2]
    v3 = v[3]
    v4 = v[4]
    v5 = v[5]
    kx = data[0]
    ky = data[1]
    kt = data[2]
    cx = data[3]
    cy = data[4]
    ct = data[5]
    x = data[6]
    y = data[7]
    c2 = turned[0]
    s2 = turned[1]
    x0 = q0 - q3
    x1 = q1 - q4
    x2 = c2 * x0 + s2 * x1
    x3 = kx * (x + x2)
    x4 = c2 * x3
    x5 = -x0
    x6 = -x1
    x7 = ky * (-c2 * x6 + s2 * x5 + y)
    x8 = v0 - v3
    x9 = v1 - v4
    x10 = cy * (c2 * x9 - s2 * x8 + v2 * (c2 * x5 + s2 * x6))
    x11 = c2 * x1 - s2 * x0
    x12 = c2 * x8 + s2 * x9 + v2 * x11
    x13 = -cx * x12
    x14 = c2 * x10 + c2 * x7 - s2 * x13 + s2 * x3
    x15 = cx * x12
    x16 = c2 * x9 - s2 * x8 - v2 * x2
    x17 = x11 + y
    x18 = ct * (v2 - v5) + kt * (q2 - q5)
    out[0] = -c2 * x13 - s2 * x10 - s2 * x7 + x4
    out[1] = x14
    out[2] = -cy * x16 * x2 - ky * x17 * x2 + x11 * x15 + x11 * x3 + x18
    out[3] = -c2 * x15 + cy * s2 * x16 + ky * s2 * x17 - x4
    out[4] = -x14
    out[5] = -x18


@routine("rrrrrrrdddr")
def bushing_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `BUSHING`, row by row."""
    q0 = q[0]
    q1 = q[1]
    q3 = q[3]
    q4 = q[4]
    v0 = v[0]
    v1 = v[1]
    v2 = v[2]
    v3 = v[3]
    v4 = v[4]
    kx = data[0]
    ky = data[1]
    kt = data[2]
    cx = data[3]
    cy = data[4]
    ct = data[5]
    x = data[6]
    y = data[7]
    c2 = turned[0]
    s2 = turned[1]
    x0 = c2 * c2
    x1 = cx * x0
    x2 = s2 * s2
    x3 = cy * x2
    x4 = c2 * s2
    x5 = v2 * x4
    x6 = cy * x5
    x7 = cx * x5
    x8 = ck * (kx * x0 + ky * x2 + x6 - x7) + cv * (x1 + x3)
    x9 = cv * x4 * (cx - cy)
    x10 = kx * x4
    x11 = ky * x4
    x12 = ck * (v2 * x1 + v2 * x3 + x10 - x11) + x9
    x13 = q0 - q3
    x14 = -x13
    x15 = q1 - q4
    x16 = -x15
    x17 = c2 * x14 + s2 * x16
    x18 = cy * s2
    x19 = c2 * x15 - s2 * x13
    x20 = -x19
    x21 = c2 * cx
    x22 = x17 * x18 + x20 * x21
    x23 = cv * x22
    x24 = v1 - v4
    x25 = c2 * x24
    x26 = v0 - v3
    x27 = s2 * x26
    x28 = v2 * x17
    x29 = x25 - x27 + x28
    x30 = -x26
    x31 = -x24
    x32 = c2 * x16
    x33 = s2 * x14
    x34 = x32 - x33
    x35 = v2 * x34
    x36 = c2 * x30 + s2 * x31 + x35
    x37 = ky * s2
    x38 = x17 * x37
    x39 = x18 * x36 + x38
    x40 = -c2 * x31 + s2 * x30 + x28
    x41 = c2 * cy
    x42 = c2 * kx
    x43 = -x32 + x33 + y
    x44 = c2 * ky
    x45 = c2 * x13 + s2 * x15
    x46 = x + x45
    x47 = kx * s2
    x48 = c2 * x26 + s2 * x24 - v2 * x20
    x49 = -x48
    x50 = cx * s2
    x51 = x20 * x42 + x40 * x41 + x43 * x44 + x46 * x47 - x49 * x50
    x52 = -x8
    x53 = -x12
    x54 = cy * x0
    x55 = cx * x2
    x56 = -ck * (v2 * x54 + v2 * x55 - x10 + x11) + x9
    x57 = ck * (kx * x2 + ky * x0 - x6 + x7) + cv * (x54 + x55)
    x58 = x17 * x41
    x59 = cv * (cx * s2 * x34 - x58)
    x60 = -x40
    x61 = -x + x17
    x62 = -x43
    x63 = -x17 * x44 - x18 * x60 + x21 * x36 + x34 * x47 - x37 * x62 + x42 * x61
    x64 = -x56
    x65 = -x57
    x66 = x28 * x41
    x67 = x45 * x45
    x68 = x19 * x19
    x69 = x19 + y
    x70 = v2 * x45
    x71 = x25 - x27 - x70
    x72 = -cv * x22
    x73 = x34 * x42
    x74 = -cv * (-x20 * x50 + x58)
    x75 = -c2 * ky * x45 - cy * s2 * x71 - ky * s2 * x69 + x19 * x47 + x21 * x48 + x42 * x46
    x76 = ck * kt + ct * cv
    x77 = -x76
    out[0] = x8
    out[1] = x12
    out[2] = -ck * (-x21 * x29 + x39 + x51) - x23
    out[3] = x52
    out[4] = x53
    out[5] = 0.0
    out[6] = x56
    out[7] = x57
    out[8] = -ck * (-x36 * x41 + x50 * x60 + x63) - x59
    out[9] = x64
    out[10] = x65
    out[11] = 0.0
    out[12] = -ck * (-v2 * x20 * x50 + x38 + x51 + x66) - x23
    out[13] = -ck * (x18 * x28 + x21 * x35 + x63) - x59
    out[14] = ck * (
        cx * x19 * x29
        - cx * x45 * x48
        + cy * x20 * x71
        - cy * x45 * x49
        + kt
        - kx * x45 * x46
        + kx * x68
        + ky * x20 * x69
        + ky * x67
    ) + cv * (ct + cx * x68 + cy * x67)
    out[15] = -ck * (x35 * x50 + x36 * x50 - x38 + x41 * x60 + x44 * x62 + x47 * x61 - x66 - x73) - x72
    out[16] = ck * (-v2 * x19 * x21 - x18 * x70 - x75) + x74
    out[17] = x77
    out[18] = x52
    out[19] = x53
    out[20] = -ck * (c2 * cy * x60 + c2 * ky * x62 + cx * s2 * x36 + kx * s2 * x61 - x21 * x60 - x39 - x73) - x72
    out[21] = x8
    out[22] = x12
    out[23] = 0.0
    out[24] = x64
    out[25] = x65
    out[26] = ck * (-x29 * x50 - x41 * x49 - x75) + x74
    out[27] = x56
    out[28] = x57
    out[29] = 0.0
    out[30] = 0.0
    out[31] = 0.0
    out[32] = x77
    out[33] = 0.0
    out[34] = 0.0
    out[35] = x76


@routine("rrrrrrrr")
def link_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `LINK`."""
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
def link_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `LINK`, row by row."""
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


@routine("rrrrrrrr")
def slider_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `SLIDER`."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    q4 = q[4]
    q5 = q[5]
    own0 = own[0]
    own1 = own[1]
    nx = data[0]
    ny = data[1]
    offset = data[2]
    c2 = turned[0]
    s2 = turned[1]
    x0 = own0 * (c2 * nx - ny * s2)
    x1 = own0 * (c2 * ny + nx * s2)
    x2 = q1 - q4
    x3 = q0 - q3
    x4 = c2 * x2 - s2 * x3
    x5 = c2 * x3 + s2 * x2
    out[0] = -x0
    out[1] = -x1
    out[2] = own0 * (-nx * x4 + ny * x5) - own1
    out[3] = x0
    out[4] = x1
    out[5] = own1
    out[6] = -nx * x5 - ny * x4 - offset
    out[7] = -q2 + q5


@routine("rrrrrrrdddr")
def slider_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `SLIDER`, row by row."""
    q0 = q[0]
    q1 = q[1]
    q3 = q[3]
    q4 = q[4]
    own0 = own[0]
    nx = data[0]
    ny = data[1]
    c2 = turned[0]
    s2 = turned[1]
    x0 = ck * (c2 * ny + nx * s2)
    x1 = own0 * x0
    x2 = ck * (c2 * nx - ny * s2)
    x3 = -x2
    x4 = own0 * x2
    x5 = -x4
    x6 = -x0
    x7 = q0 - q3
    x8 = -x7
    x9 = q1 - q4
    x10 = -x9
    x11 = -x1
    x12 = ck * (-nx * (c2 * x9 - s2 * x7) + ny * (c2 * x7 + s2 * x9))
    x13 = -ck
    out[0] = 0.0
    out[1] = 0.0
    out[2] = x1
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = x3
    out[7] = 0.0
    out[8] = 0.0
    out[9] = 0.0
    out[10] = x5
    out[11] = 0.0
    out[12] = 0.0
    out[13] = 0.0
    out[14] = x6
    out[15] = 0.0
    out[16] = x1
    out[17] = x5
    out[18] = -ck * own0 * (nx * (c2 * x8 + s2 * x10) + ny * (c2 * x10 - s2 * x8))
    out[19] = x11
    out[20] = x4
    out[21] = 0.0
    out[22] = x12
    out[23] = x13
    out[24] = 0.0
    out[25] = 0.0
    out[26] = x11
    out[27] = 0.0
    out[28] = 0.0
    out[29] = 0.0
    out[30] = x2
    out[31] = 0.0
    out[32] = 0.0
    out[33] = 0.0
    out[34] = x4
    out[35] = 0.0
    out[36] = 0.0
    out[37] = 0.0
    out[38] = x0
    out[39] = 0.0
    out[40] = 0.0
    out[41] = 0.0
    out[42] = 0.0
    out[43] = 0.0
    out[44] = 0.0
    out[45] = 0.0
    out[46] = 0.0
    out[47] = ck
    out[48] = x3
    out[49] = x6
    out[50] = x12
    out[51] = x2
    out[52] = x0
    out[53] = 0.0
    out[54] = 0.0
    out[55] = 0.0
    out[56] = 0.0
    out[57] = 0.0
    out[58] = x13
    out[59] = 0.0
    out[60] = 0.0
    out[61] = ck
    out[62] = 0.0
    out[63] = 0.0


@routine("rrrrrrrr")
def rough_slider_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `ROUGH_SLIDER`."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    q4 = q[4]
    q5 = q[5]
    own0 = own[0]
    own1 = own[1]
    nx = data[0]
    ny = data[1]
    offset = data[2]
    friction = data[3]
    stiffness = data[4]
    along = data[5]
    slip = data[6]
    c2 = turned[0]
    s2 = turned[1]
    x0 = c2 * nx - ny * s2
    x1 = own0 * x0
    x2 = c2 * ny + nx * s2
    x3 = q1 - q4
    x4 = -x3
    x5 = q0 - q3
    x6 = -x5
    x7 = -ny * (c2 * x6 + s2 * x4)
    x8 = along + nx * (c2 * x4 - s2 * x6) + slip + x7
    x9 = -stiffness * x8
    x10 = own0 > 0.0
    x11 = own0 < 0.0
    x12 = friction * (((-own0) if x11 else (0.0)) + ((own0) if x10 else (0.0)))
    x13 = -x12 - x9
    x14 = x10 and x11
    x15 = x9 < 0.0
    x16 = friction * own0
    x17 = x16 + x9
    x18 = -x9
    x19 = x16 + x18
    x20 = -x12 - x18
    x21 = x9 > 0.0
    x22 = (
        x9
        + ((x13) if ((x15) if x14 else ((x17 < 0.0) if x10 else ((x19 > 0.0) if x11 else (x15)))) else (0.0))
        - ((x20) if ((x21) if x14 else ((x19 < 0.0) if x10 else ((x17 > 0.0) if x11 else (x21)))) else (0.0))
    )
    x23 = own0 * x2
    x24 = c2 * x3 - s2 * x5
    x25 = stiffness * x8
    x26 = x25 < 0.0
    x27 = x16 + x25
    x28 = x16 - x25
    x29 = x25 > 0.0
    x30 = (
        x25
        - ((x13) if ((x29) if x14 else ((x28 < 0.0) if x10 else ((x27 > 0.0) if x11 else (x29)))) else (0.0))
        + ((x20) if ((x26) if x14 else ((x27 < 0.0) if x10 else ((x28 > 0.0) if x11 else (x26)))) else (0.0))
    )
    out[0] = -x1 - x2 * x22
    out[1] = x0 * x22 - x23
    out[2] = own0 * (-nx * x24 + x7) - own1 + x30 * (-x0 * x6 - x2 * x4)
    out[3] = x1 - x2 * x30
    out[4] = x0 * x30 + x23
    out[5] = own1
    out[6] = -nx * (c2 * x5 + s2 * x3) - ny * x24 - offset
    out[7] = -q2 + q5


@routine("rrrrrrrdddr")
def rough_slider_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `ROUGH_SLIDER`, row by row."""
    q0 = q[0]
    q1 = q[1]
    q3 = q[3]
    q4 = q[4]
    own0 = own[0]
    nx = data[0]
    ny = data[1]
    friction = data[3]
    stiffness = data[4]
    along = data[5]
    slip = data[6]
    c2 = turned[0]
    s2 = turned[1]
    x0 = c2 * ny + nx * s2
    x1 = stiffness * x0
    x2 = -x1
    x3 = own0 > 0.0
    x4 = own0 < 0.0
    x5 = x3 and x4
    x6 = q1 - q4
    x7 = -x6
    x8 = q0 - q3
    x9 = -x8
    x10 = c2 * x7 - s2 * x9
    x11 = c2 * x9 + s2 * x7
    x12 = along + slip
    x13 = nx * x10 - ny * x11 + x12
    x14 = stiffness * x13
    x15 = x14 < 0.0
    x16 = friction * own0
    x17 = x14 + x16
    x18 = -x14 + x16
    x19 = (x15) if x5 else ((x17 < 0.0) if x3 else ((x18 > 0.0) if x4 else (x15)))
    x20 = x14 > 0.0
    x21 = (x20) if x5 else ((x18 < 0.0) if x3 else ((x17 > 0.0) if x4 else (x20)))
    x22 = x1 - ((x1) if x21 else (0.0)) + ((x2) if x19 else (0.0))
    x23 = -x22
    x24 = ck * x0
    x25 = c2 * nx
    x26 = ny * s2
    x27 = x25 - x26
    x28 = stiffness * x27
    x29 = -x28
    x30 = x28 - ((x28) if x19 else (0.0)) + ((x29) if x21 else (0.0))
    x31 = own0 * x0
    x32 = -x31
    x33 = nx * x11 + ny * x10
    x34 = stiffness * x33
    x35 = -x34
    x36 = -stiffness * x13
    x37 = x36 < 0.0
    x38 = x16 + x36
    x39 = -x36
    x40 = x16 + x39
    x41 = (x37) if x5 else ((x38 < 0.0) if x3 else ((x40 > 0.0) if x4 else (x37)))
    x42 = x36 > 0.0
    x43 = (x42) if x5 else ((x40 < 0.0) if x3 else ((x38 > 0.0) if x4 else (x42)))
    x44 = x34 - ((x34) if x43 else (0.0)) + ((x35) if x41 else (0.0))
    x45 = friction * (((-own0) if x4 else (0.0)) + ((own0) if x3 else (0.0)))
    x46 = -x36 - x45
    x47 = -x39 - x45
    x48 = x36 + ((x46) if x41 else (0.0)) - ((x47) if x43 else (0.0))
    x49 = x1 - ((x1) if x19 else (0.0)) + ((x2) if x21 else (0.0))
    x50 = x28 - ((x28) if x21 else (0.0)) + ((x29) if x19 else (0.0))
    x51 = -x50
    x52 = -friction * (((-1.0) if x4 else (0.0)) + ((1.0) if x3 else (0.0)))
    x53 = -((x52) if x19 else (0.0)) + ((x52) if x21 else (0.0))
    x54 = ck * x27
    x55 = own0 * x27
    x56 = -x53
    x57 = ck * (x0 + x27 * x56)
    x58 = -x0 * x7 - x27 * x9
    x59 = x14 - ((x46) if x21 else (0.0)) + ((x47) if x19 else (0.0))
    x60 = -x59
    x61 = x27 * x60
    x62 = x34 - ((x34) if x19 else (0.0)) + ((x35) if x21 else (0.0))
    x63 = x0 * x6 + x27 * x8
    x64 = -x0 * x59 + x55
    x65 = c2 * x8 + s2 * x6
    x66 = ny * x65
    x67 = c2 * x6 - s2 * x8
    x68 = nx * x67
    x69 = -ck
    x70 = stiffness * (-nx * x67 + x12 + x66)
    x71 = x70 > 0.0
    x72 = x16 - x70
    x73 = x16 + x70
    x74 = (x71) if x5 else ((x72 < 0.0) if x3 else ((x73 > 0.0) if x4 else (x71)))
    x75 = x70 < 0.0
    x76 = (x75) if x5 else ((x73 < 0.0) if x3 else ((x72 > 0.0) if x4 else (x75)))
    x77 = x28 - ((x28) if x76 else (0.0)) + ((x29) if x74 else (0.0))
    x78 = -x62
    x79 = x1 - ((x1) if x76 else (0.0)) + ((x2) if x74 else (0.0))
    out[0] = -x23 * x24
    out[1] = -x24 * x30
    out[2] = -ck * (x0 * x44 + x27 * x48 + x32)
    out[3] = -x24 * x49
    out[4] = -x24 * x51
    out[5] = 0.0
    out[6] = ck * (-x0 * x53 - x27)
    out[7] = 0.0
    out[8] = x23 * x54
    out[9] = x30 * x54
    out[10] = -ck * (x0 * x48 - x27 * x44 + x55)
    out[11] = x49 * x54
    out[12] = x51 * x54
    out[13] = 0.0
    out[14] = -x57
    out[15] = 0.0
    out[16] = -ck * (x23 * x58 + x32 + x61)
    out[17] = -ck * (x0 * x60 + x30 * x58 + x55)
    out[18] = -ck * (own0 * x33 + x58 * x62 + x60 * (x0 * x9 - x27 * x7))
    out[19] = -ck * (x31 + x49 * x58 - x61)
    out[20] = ck * (x50 * x63 + x64)
    out[21] = 0.0
    out[22] = ck * (x56 * x63 + x66 - x68)
    out[23] = x69
    out[24] = -x22 * x24
    out[25] = x24 * x77
    out[26] = -ck * (x0 * x78 + x27 * x59 + x31)
    out[27] = x24 * x79
    out[28] = -x24 * x50
    out[29] = 0.0
    out[30] = -ck * (x0 * (-((x52) if x41 else (0.0)) + ((x52) if x43 else (0.0))) - x25 + x26)
    out[31] = 0.0
    out[32] = x22 * x54
    out[33] = -x54 * x77
    out[34] = ck * (x27 * x78 + x64)
    out[35] = -x54 * x79
    out[36] = x50 * x54
    out[37] = 0.0
    out[38] = x57
    out[39] = 0.0
    out[40] = 0.0
    out[41] = 0.0
    out[42] = 0.0
    out[43] = 0.0
    out[44] = 0.0
    out[45] = 0.0
    out[46] = 0.0
    out[47] = ck
    out[48] = -x54
    out[49] = -x24
    out[50] = ck * (ny * x65 - x68)
    out[51] = x54
    out[52] = x24
    out[53] = 0.0
    out[54] = 0.0
    out[55] = 0.0
    out[56] = 0.0
    out[57] = 0.0
    out[58] = x69
    out[59] = 0.0
    out[60] = 0.0
    out[61] = ck
    out[62] = 0.0
    out[63] = 0.0


@routine("rrrrrrrr")
def weld_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `WELD`."""
    q0 = q[0]
    q1 = q[1]
    q2 = q[2]
    q3 = q[3]
    q4 = q[4]
    q5 = q[5]
    own0 = own[0]
    own1 = own[1]
    own2 = own[2]
    x = data[0]
    y = data[1]
    c2 = turned[0]
    s2 = turned[1]
    x0 = c2 * own0 - own1 * s2
    x1 = c2 * own1 + own0 * s2
    x2 = q0 - q3
    x3 = q1 - q4
    x4 = c2 * x3 - s2 * x2
    out[0] = -x0
    out[1] = -x1
    out[2] = -own0 * x4 - own1 * (-c2 * x2 - s2 * x3) - own2
    out[3] = x0
    out[4] = x1
    out[5] = own2
    out[6] = -c2 * x2 - s2 * x3 - x
    out[7] = -x4 - y
    out[8] = -q2 + q5


@routine("rrrrrrrdddr")
def weld_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `WELD`, row by row."""
    q0 = q[0]
    q1 = q[1]
    q3 = q[3]
    q4 = q[4]
    own0 = own[0]
    own1 = own[1]
    c2 = turned[0]
    s2 = turned[1]
    x0 = ck * (c2 * own1 + own0 * s2)
    x1 = c2 * ck
    x2 = -x1
    x3 = ck * s2
    x4 = ck * (c2 * own0 - own1 * s2)
    x5 = -x4
    x6 = -x3
    x7 = q0 - q3
    x8 = -x7
    x9 = q1 - q4
    x10 = -x9
    x11 = -x0
    x12 = -ck * (c2 * x9 - s2 * x7)
    x13 = ck * (c2 * x7 + s2 * x9)
    x14 = -ck
    out[0] = 0.0
    out[1] = 0.0
    out[2] = x0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = x2
    out[7] = x3
    out[8] = 0.0
    out[9] = 0.0
    out[10] = 0.0
    out[11] = x5
    out[12] = 0.0
    out[13] = 0.0
    out[14] = 0.0
    out[15] = x6
    out[16] = x2
    out[17] = 0.0
    out[18] = x0
    out[19] = x5
    out[20] = -ck * (own0 * (c2 * x8 + s2 * x10) + own1 * (c2 * x10 - s2 * x8))
    out[21] = x11
    out[22] = x4
    out[23] = 0.0
    out[24] = x12
    out[25] = x13
    out[26] = x14
    out[27] = 0.0
    out[28] = 0.0
    out[29] = x11
    out[30] = 0.0
    out[31] = 0.0
    out[32] = 0.0
    out[33] = x1
    out[34] = x6
    out[35] = 0.0
    out[36] = 0.0
    out[37] = 0.0
    out[38] = x4
    out[39] = 0.0
    out[40] = 0.0
    out[41] = 0.0
    out[42] = x3
    out[43] = x1
    out[44] = 0.0
    out[45] = 0.0
    out[46] = 0.0
    out[47] = 0.0
    out[48] = 0.0
    out[49] = 0.0
    out[50] = 0.0
    out[51] = 0.0
    out[52] = 0.0
    out[53] = ck
    out[54] = x2
    out[55] = x6
    out[56] = x12
    out[57] = x1
    out[58] = x3
    out[59] = 0.0
    out[60] = 0.0
    out[61] = 0.0
    out[62] = 0.0
    out[63] = x3
    out[64] = x2
    out[65] = x13
    out[66] = x6
    out[67] = x1
    out[68] = 0.0
    out[69] = 0.0
    out[70] = 0.0
    out[71] = 0.0
    out[72] = 0.0
    out[73] = 0.0
    out[74] = x14
    out[75] = 0.0
    out[76] = 0.0
    out[77] = ck
    out[78] = 0.0
    out[79] = 0.0
    out[80] = 0.0


@routine("rrrrrrrr")
def gear_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `GEAR`."""
    q2 = q[2]
    q5 = q[5]
    own0 = own[0]
    ratio = data[0]
    out[0] = 0.0
    out[1] = 0.0
    out[2] = -own0 * ratio
    out[3] = 0.0
    out[4] = 0.0
    out[5] = own0
    out[6] = -q2 * ratio + q5


@routine("rrrrrrrdddr")
def gear_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `GEAR`, row by row."""
    ratio = data[0]
    x0 = -ck * ratio
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
    out[14] = 0.0
    out[15] = 0.0
    out[16] = 0.0
    out[17] = 0.0
    out[18] = 0.0
    out[19] = 0.0
    out[20] = x0
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
    out[32] = 0.0
    out[33] = 0.0
    out[34] = 0.0
    out[35] = 0.0
    out[36] = 0.0
    out[37] = 0.0
    out[38] = 0.0
    out[39] = 0.0
    out[40] = 0.0
    out[41] = ck
    out[42] = 0.0
    out[43] = 0.0
    out[44] = x0
    out[45] = 0.0
    out[46] = 0.0
    out[47] = ck
    out[48] = 0.0


@routine("rrrrrrrr")
def motor_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `MOTOR`."""
    q2 = q[2]
    q5 = q[5]
    own0 = own[0]
    value0 = own[1]
    x0 = -own0
    out[0] = 0.0
    out[1] = 0.0
    out[2] = x0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = own0
    out[6] = -q2 + q5 - value0
    out[7] = x0


@routine("rrrrrrrdddr")
def motor_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `MOTOR`, row by row."""
    x0 = -ck
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
    out[14] = 0.0
    out[15] = 0.0
    out[16] = 0.0
    out[17] = 0.0
    out[18] = 0.0
    out[19] = 0.0
    out[20] = 0.0
    out[21] = 0.0
    out[22] = x0
    out[23] = 0.0
    out[24] = 0.0
    out[25] = 0.0
    out[26] = 0.0
    out[27] = 0.0
    out[28] = 0.0
    out[29] = 0.0
    out[30] = 0.0
    out[31] = 0.0
    out[32] = 0.0
    out[33] = 0.0
    out[34] = 0.0
    out[35] = 0.0
    out[36] = 0.0
    out[37] = 0.0
    out[38] = 0.0
    out[39] = 0.0
    out[40] = 0.0
    out[41] = 0.0
    out[42] = 0.0
    out[43] = 0.0
    out[44] = 0.0
    out[45] = 0.0
    out[46] = ck
    out[47] = 0.0
    out[48] = 0.0
    out[49] = 0.0
    out[50] = x0
    out[51] = 0.0
    out[52] = 0.0
    out[53] = ck
    out[54] = 0.0
    out[55] = x0
    out[56] = 0.0
    out[57] = 0.0
    out[58] = 0.0
    out[59] = 0.0
    out[60] = 0.0
    out[61] = 0.0
    out[62] = x0
    out[63] = 0.0


@routine("rrrrrrrr")
def drag_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `DRAG`."""
    v0 = v[0]
    v1 = v[1]
    coefficient = data[0]
    x0 = coefficient * math.sqrt((v0 * v0) + (v1 * v1) + 1.0e-300)
    out[0] = v0 * x0
    out[1] = v1 * x0


@routine("rrrrrrrdddr")
def drag_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `DRAG`, row by row."""
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


@routine("rrrrrrrr")
def stop_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `STOP`."""
    q0 = q[0]
    q1 = q[1]
    v0 = v[0]
    v1 = v[1]
    stiffness = data[0]
    damping = data[1]
    x = data[3]
    y = data[4]
    nx = data[5]
    ny = data[6]
    x0 = nx * (q0 - x) + ny * (q1 - y)
    x1 = 2.0 * x0
    x2 = x0 < 0.0
    x3 = damping * (nx * v0 + ny * v1) * ((-x0) if x2 else (0.0))
    out[0] = stiffness * (nx * x3 + (0.5) * ((nx * x1) if x2 else (0.0)))
    out[1] = stiffness * (ny * x3 + (0.5) * ((ny * x1) if x2 else (0.0)))


@routine("rrrrrrrdddr")
def stop_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `STOP`, row by row."""
    q0 = q[0]
    q1 = q[1]
    v0 = v[0]
    v1 = v[1]
    stiffness = data[0]
    damping = data[1]
    x = data[3]
    y = data[4]
    nx = data[5]
    ny = data[6]
    x0 = nx * nx
    x1 = nx * (q0 - x) + ny * (q1 - y)
    x2 = x1 < 0.0
    x3 = cv * damping * ((-x1) if x2 else (0.0))
    x4 = (-nx) if x2 else (0.0)
    x5 = 2.0 * nx
    x6 = damping * (nx * v0 + ny * v1)
    x7 = x5 * x6
    x8 = (0.5) * ck
    x9 = nx * ny * x3
    x10 = (ny * x5) if x2 else (0.0)
    x11 = (-ny) if x2 else (0.0)
    x12 = 2.0 * ny * x6
    x13 = ny * ny
    out[0] = stiffness * (x0 * x3 + x8 * (x4 * x7 + ((2.0 * x0) if x2 else (0.0))))
    out[1] = stiffness * (x8 * (x10 + x11 * x7) + x9)
    out[2] = stiffness * (x8 * (x10 + x12 * x4) + x9)
    out[3] = stiffness * (x13 * x3 + x8 * (x11 * x12 + ((2.0 * x13) if x2 else (0.0))))


@routine("rrrrrrrr")
def rough_stop_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `ROUGH_STOP`."""
    q0 = q[0]
    q1 = q[1]
    v0 = v[0]
    v1 = v[1]
    stiffness = data[0]
    damping = data[1]
    friction = data[2]
    x = data[3]
    y = data[4]
    nx = data[5]
    ny = data[6]
    x0 = data[7]
    y0 = data[8]
    slip = data[9]
    x1 = q0 - x
    x2 = q1 - y
    x3 = nx * x1 + ny * x2
    x4 = 2.0 * x3
    x5 = x3 < 0.0
    x6 = (0.5) * stiffness
    x7 = damping * stiffness * (nx * v0 + ny * v1) * ((-x3) if x5 else (0.0))
    x8 = ny * (q0 - x0)
    x9 = nx * (q1 - y0)
    x10 = slip + x8 - x9
    x11 = stiffness * x10
    x12 = -nx * x1 - ny * x2
    x13 = friction * ((x12) if (x12 > 0.0) else (0.0))
    x14 = friction * x3
    x15 = -slip - x8 + x9
    x16 = (
        x11
        + ((stiffness * (-x10 - x13)) if ((stiffness * (-x14 - x15) < 0.0) if x5 else (x11 < 0.0)) else (0.0))
        - ((-stiffness * (x13 + x15)) if ((stiffness * (x10 + x14) > 0.0) if x5 else (x11 > 0.0)) else (0.0))
    )
    out[0] = nx * x7 + ny * x16 + x6 * ((nx * x4) if x5 else (0.0))
    out[1] = -nx * x16 + ny * x7 + x6 * ((ny * x4) if x5 else (0.0))


@routine("rrrrrrrdddr")
def rough_stop_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `ROUGH_STOP`, row by row."""
    q0 = q[0]
    q1 = q[1]
    v0 = v[0]
    v1 = v[1]
    stiffness = data[0]
    damping = data[1]
    friction = data[2]
    x = data[3]
    y = data[4]
    nx = data[5]
    ny = data[6]
    x0 = data[7]
    y0 = data[8]
    slip = data[9]
    x1 = nx * nx
    x2 = q0 - x
    x3 = q1 - y
    x4 = nx * x2 + ny * x3
    x5 = x4 < 0.0
    x6 = cv * damping * ((-x4) if x5 else (0.0))
    x7 = stiffness * x6
    x8 = -nx
    x9 = (x8) if x5 else (0.0)
    x10 = nx * stiffness
    x11 = 2.0 * damping * (nx * v0 + ny * v1)
    x12 = x10 * x11
    x13 = ny * stiffness
    x14 = friction * ((x8) if (nx * x2 + ny * x3 < 0.0) else (0.0))
    x15 = nx * (q1 - y0)
    x16 = q0 - x0
    x17 = friction * x4
    x18 = -ny * x16 - slip + x15 + x17
    x19 = ny * x16 + slip - x15
    x20 = stiffness * x19
    x21 = x20 < 0.0
    x22 = -ny
    x23 = (stiffness * (x17 + x19) > 0.0) if x5 else (x20 > 0.0)
    x24 = (
        x13
        + ((-stiffness * (ny + x14)) if ((stiffness * x18 > 0.0) if x5 else (x21)) else (0.0))
        - ((stiffness * (-x14 - x22)) if x23 else (0.0))
    )
    x25 = 2.0 * ny
    x26 = (0.5) * ck
    x27 = nx * x13 * x6
    x28 = stiffness * ((nx * x25) if x5 else (0.0))
    x29 = (x22) if x5 else (0.0)
    x30 = friction * x29
    x31 = (
        x10
        + ((-stiffness * (nx + x30)) if x23 else (0.0))
        - ((stiffness * (-x30 - x8)) if ((stiffness * x18 > 0.0) if x5 else (x21)) else (0.0))
    )
    x32 = x11 * x13
    x33 = 2.0 * nx
    x34 = ny * ny
    out[0] = x1 * x7 + x26 * (stiffness * ((2.0 * x1) if x5 else (0.0)) + x12 * x9 + x24 * x25)
    out[1] = x26 * (x12 * x29 - x25 * x31 + x28) + x27
    out[2] = x26 * (-x24 * x33 + x28 + x32 * x9) + x27
    out[3] = x26 * (stiffness * ((2.0 * x34) if x5 else (0.0)) + x29 * x32 + x31 * x33) + x34 * x7


@routine("rrrrrrrr")
def hinge_friction_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `HINGE_FRICTION`."""
    q2 = q[2]
    q5 = q[5]
    stiffness = data[0]
    torque = data[1]
    slip = data[2]
    x0 = q2 - q5 + slip
    x1 = stiffness * x0
    x2 = torque + x1
    x3 = x1 + ((-x2) if (x2 < 0.0) else (0.0)) - ((stiffness * x0 - torque) if (torque - x1 < 0.0) else (0.0))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = x3
    out[3] = 0.0
    out[4] = 0.0
    out[5] = -x3


@routine("rrrrrrrdddr")
def hinge_friction_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `HINGE_FRICTION`, row by row."""
    q2 = q[2]
    q5 = q[5]
    stiffness = data[0]
    torque = data[1]
    slip = data[2]
    x0 = -stiffness
    x1 = stiffness * (q2 - q5 + slip)
    x2 = torque + x1 < 0.0
    x3 = -torque + x1 > 0.0
    x4 = ck * (stiffness - ((stiffness) if x3 else (0.0)) + ((x0) if x2 else (0.0)))
    x5 = ck * (stiffness - ((stiffness) if x2 else (0.0)) + ((x0) if x3 else (0.0)))
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
    out[14] = x4
    out[15] = 0.0
    out[16] = 0.0
    out[17] = -x5
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
    out[32] = -x4
    out[33] = 0.0
    out[34] = 0.0
    out[35] = x5


@routine("rrrrrrrr")
def hinge_stop_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `HINGE_STOP`."""
    q2 = q[2]
    q5 = q[5]
    v2 = v[2]
    v5 = v[5]
    low = data[0]
    high = data[1]
    stiffness = data[2]
    damping = data[3]
    x0 = q2 - q5
    x1 = high + x0
    x2 = x1 < 0.0
    x3 = low + x0
    x4 = x3 > 0.0
    x5 = -x1
    x6 = damping * (v2 - v5) * (((x3) if x4 else (0.0)) + ((x5) if x2 else (0.0)))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = stiffness * (x6 + (0.5) * ((2.0 * x1) if x2 else (0.0)) + (0.5) * ((2.0 * x3) if x4 else (0.0)))
    out[3] = 0.0
    out[4] = 0.0
    out[5] = stiffness * (-x6 + (0.5) * ((-2.0 * x3) if x4 else (0.0)) + (0.5) * ((2.0 * x5) if x2 else (0.0)))


@routine("rrrrrrrdddr")
def hinge_stop_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `HINGE_STOP`, row by row."""
    q2 = q[2]
    q5 = q[5]
    v2 = v[2]
    v5 = v[5]
    low = data[0]
    high = data[1]
    stiffness = data[2]
    damping = data[3]
    x0 = q2 - q5
    x1 = low + x0
    x2 = x1 > 0.0
    x3 = high + x0
    x4 = x3 < 0.0
    x5 = cv * damping * (((x1) if x2 else (0.0)) + ((-x3) if x4 else (0.0)))
    x6 = ((-1.0) if x4 else (0.0)) + ((1.0) if x2 else (0.0))
    x7 = v2 - v5
    x8 = 2.0 * damping * x7
    x9 = ((2.0) if x2 else (0.0)) + ((2.0) if x4 else (0.0))
    x10 = (0.5) * ck
    x11 = -x5
    x12 = ((-1.0) if x2 else (0.0)) + ((1.0) if x4 else (0.0))
    x13 = ((-2.0) if x2 else (0.0)) + ((-2.0) if x4 else (0.0))
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
    out[14] = stiffness * (x10 * (x6 * x8 + x9) + x5)
    out[15] = 0.0
    out[16] = 0.0
    out[17] = stiffness * (x10 * (x12 * x8 + x13) + x11)
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
    out[32] = -stiffness * (x10 * (2.0 * damping * x6 * x7 - x13) + x5)
    out[33] = 0.0
    out[34] = 0.0
    out[35] = stiffness * (-x10 * (2.0 * damping * x12 * x7 - x9) - x11)


@routine("rrrrrrrr")
def dead_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `DEAD`."""
    q2 = q[2]
    q3 = q[3]
    fx = data[0]
    fy = data[1]
    moment = data[2]
    x0 = moment / ((q2 * q2) + (q3 * q3))
    out[0] = -fx
    out[1] = -fy
    out[2] = q3 * x0
    out[3] = -q2 * x0


@routine("rrrrrrrdddr")
def dead_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `DEAD`, row by row."""
    q2 = q[2]
    q3 = q[3]
    moment = data[2]
    x0 = q2 * q2
    x1 = q3 * q3
    x2 = x0 + x1
    x3 = ck * moment
    x4 = 2.0 * q2 * q3 * x3 / (x2 * x2)
    x5 = 1.0 / x2
    x6 = 2.0 * x5
    x7 = x3 * x5
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
    out[10] = -x4
    out[11] = -x7 * (x1 * x6 - 1.0)
    out[12] = 0.0
    out[13] = 0.0
    out[14] = x7 * (x0 * x6 - 1.0)
    out[15] = x4


@routine("rrrrrrrr")
def following_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `FOLLOWING`."""
    q2 = q[2]
    q3 = q[3]
    fx = data[0]
    fy = data[1]
    moment = data[2]
    ux = data[3]
    uy = data[4]
    x0 = (q2 * q2) + (q3 * q3)
    x1 = 1.0 / math.sqrt(x0)
    x2 = q2 * ux + q3 * uy
    x3 = q2 * uy - q3 * ux
    x4 = moment / x0
    out[0] = -x1 * (fx * x2 + fy * x3)
    out[1] = x1 * (fx * x3 - fy * x2)
    out[2] = q3 * x4
    out[3] = -q2 * x4


@routine("rrrrrrrdddr")
def following_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `FOLLOWING`, row by row."""
    q2 = q[2]
    q3 = q[3]
    fx = data[0]
    fy = data[1]
    moment = data[2]
    ux = data[3]
    uy = data[4]
    x0 = q2 * q2
    x1 = q3 * q3
    x2 = x0 + x1
    x3 = 1.0 / x2
    x4 = q2 * x3
    x5 = q2 * ux + q3 * uy
    x6 = fx * x5
    x7 = q2 * uy - q3 * ux
    x8 = fy * x7
    x9 = ck / math.sqrt(x2)
    x10 = q3 * x3
    x11 = -fx * uy + fy * ux
    x12 = fx * x7
    x13 = fy * x5
    x14 = ck * moment
    x15 = 2.0 * q2 * q3 * x14 / (x2 * x2)
    x16 = 2.0 * x3
    x17 = x14 * x3
    out[0] = 0.0
    out[1] = 0.0
    out[2] = -x9 * (fx * ux + fy * uy - x4 * x6 - x4 * x8)
    out[3] = x9 * (x10 * x6 + x10 * x8 + x11)
    out[4] = 0.0
    out[5] = 0.0
    out[6] = -x9 * (x11 + x12 * x4 - x13 * x4)
    out[7] = -x9 * (fx * ux + fy * uy + x10 * x12 - x10 * x13)
    out[8] = 0.0
    out[9] = 0.0
    out[10] = -x15
    out[11] = -x17 * (x1 * x16 - 1.0)
    out[12] = 0.0
    out[13] = 0.0
    out[14] = x17 * (x0 * x16 - 1.0)
    out[15] = x15


@routine("rrrrrrrr")
def stretching_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `STRETCHING`."""
    q2 = q[2]
    q3 = q[3]
    fx = data[0]
    fy = data[1]
    moment = data[2]
    ux = data[3]
    uy = data[4]
    x0 = q2 * ux + q3 * uy
    x1 = q2 * uy - q3 * ux
    x2 = moment / ((q2 * q2) + (q3 * q3))
    out[0] = -fx * x0 - fy * x1
    out[1] = fx * x1 - fy * x0
    out[2] = q3 * x2
    out[3] = -q2 * x2


@routine("rrrrrrrdddr")
def stretching_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `STRETCHING`, row by row."""
    q2 = q[2]
    q3 = q[3]
    fx = data[0]
    fy = data[1]
    moment = data[2]
    ux = data[3]
    uy = data[4]
    x0 = -ck * (fx * ux + fy * uy)
    x1 = ck * (fx * uy - fy * ux)
    x2 = q2 * q2
    x3 = q3 * q3
    x4 = x2 + x3
    x5 = ck * moment
    x6 = 2.0 * q2 * q3 * x5 / (x4 * x4)
    x7 = 1.0 / x4
    x8 = 2.0 * x7
    x9 = x5 * x7
    out[0] = 0.0
    out[1] = 0.0
    out[2] = x0
    out[3] = -x1
    out[4] = 0.0
    out[5] = 0.0
    out[6] = x1
    out[7] = x0
    out[8] = 0.0
    out[9] = 0.0
    out[10] = -x6
    out[11] = -x9 * (x3 * x8 - 1.0)
    out[12] = 0.0
    out[13] = 0.0
    out[14] = x9 * (x2 * x8 - 1.0)
    out[15] = x6


@routine("rrrrrrrr")
def grounded_force(q, v, a, own, turned, data, gravity, out):
    """Fill the force of `GROUNDED`."""
    q0 = q[0]
    q1 = q[1]
    kx = data[3]
    ky = data[4]
    x = data[5]
    y = data[6]
    out[0] = kx * (q0 - x)
    out[1] = ky * (q1 - y)
    out[2] = 0.0
    out[3] = 0.0


@routine("rrrrrrrdddr")
def grounded_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill ck df/dq + cv df/dv + ca df/da of `GROUNDED`, row by row."""
    kx = data[3]
    ky = data[4]
    out[0] = ck * kx
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = ck * ky
    out[6] = 0.0
    out[7] = 0.0
    out[8] = 0.0
    out[9] = 0.0
    out[10] = 0.0
    out[11] = 0.0
    out[12] = 0.0
    out[13] = 0.0
    out[14] = 0.0
    out[15] = 0.0
