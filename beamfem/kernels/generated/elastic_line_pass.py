"""Passes of the strain measure `beamfem.physics.measures.elastic_line`.

A row has 72 numbers. Written by beamfem.physics.generate: do not edit.
"""

import math

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at
from beamfem.kernels.simd import WIDTH

FAST = {"contract", "reassoc", "nsz"}


@routine("iv", fastmath=FAST)
def strains(count, x):
    """Fill strains."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        rx = own[0]
        ry = own[72]
        dx = own[144]
        dy = own[216]
        ex = own[288]
        ey = own[360]
        x0 = (rx * rx) + (ry * ry)
        own[432] = math.sqrt(x0) - 1.0
        own[504] = -(ex * ry - ey * rx) / x0
        own[576] = dx * rx + dy * ry
        own[648] = (0.5) * ((dx * dx) + (dy * dy) - 1.0)


@routine("iv", fastmath=FAST)
def forces(count, x):
    """Fill forces on q of stress resultants."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        rx = own[0]
        ry = own[72]
        dx = own[144]
        dy = own[216]
        ex = own[288]
        ey = own[360]
        s0 = own[864]
        s1 = own[936]
        s2 = own[1008]
        s3 = own[1080]
        x0 = (rx * rx) + (ry * ry)
        x1 = s0 / math.sqrt(x0)
        x2 = 1.0 / x0
        x3 = 2.0 * x2 * (ex * ry - ey * rx)
        x4 = s1 * x2
        own[2808] = dx * s2 + rx * x1 + x4 * (ey + rx * x3)
        own[2880] = dy * s2 + ry * x1 - x4 * (ex - ry * x3)
        own[2952] = dx * s3 + rx * s2
        own[3024] = dy * s3 + ry * s2
        own[3096] = -ry * x4
        own[3168] = rx * x4


@routine("iv", fastmath=FAST)
def rates(count, x):
    """Fill the change of strains with a change of q, in its place."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        rx = own[0]
        ry = own[72]
        dx = own[144]
        dy = own[216]
        ex = own[288]
        ey = own[360]
        rx_ = own[4752]
        ry_ = own[4824]
        dx_ = own[4896]
        dy_ = own[4968]
        ex_ = own[5040]
        ey_ = own[5112]
        x0 = (rx * rx) + (ry * ry)
        x1 = 1.0 / x0
        x2 = ex * ry - ey * rx
        x3 = 2.0 * x1
        own[4752] = (rx * rx_ + ry * ry_) / math.sqrt(x0)
        own[4824] = x1 * (-ex_ * ry + ey_ * rx + rx_ * (ey + rx * x2 * x3) - ry_ * (ex - ry * x2 * x3))
        own[4896] = dx * rx_ + dx_ * rx + dy * ry_ + dy_ * ry
        own[4968] = dx * dx_ + dy * dy_


@routine("iv", fastmath=FAST)
def rate_changes(count, x):
    """Fill the change of strain rates with a change of q at constant q'."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        rx = own[0]
        ry = own[72]
        ex = own[288]
        ey = own[360]
        rxt = own[2808]
        ryt = own[2880]
        dxt = own[2952]
        dyt = own[3024]
        ext = own[3096]
        eyt = own[3168]
        rx_ = own[4752]
        ry_ = own[4824]
        dx_ = own[4896]
        dy_ = own[4968]
        ex_ = own[5040]
        ey_ = own[5112]
        x0 = rx * rx
        x1 = ry * ry
        x2 = x0 + x1
        x3 = 1.0 / x2
        x4 = ryt * x3
        x5 = rx * ry
        x6 = x4 * x5
        x7 = x0 * x3
        x8 = rxt * x3
        x9 = x5 * x8
        x10 = x1 * x3
        x11 = 2.0 * x7
        x12 = ex * ry
        x13 = ey * rx
        x14 = 4.0 * x12 - 4.0 * x13
        x15 = x3 * x5
        x16 = -ex * rx + ey * ry + x14 * x15
        x17 = 2.0 * x8
        own[3240] = -(rx_ * (rxt * x7 - rxt + x6) + ry_ * (ryt * x10 - ryt + x9)) / math.sqrt(x2)
        own[3312] = x3 * (
            ex_ * (ryt * (2.0 * x10 - 1.0) + 2.0 * x9)
            - ey_ * (rxt * (x11 - 1.0) + 2.0 * x6)
            + rx_ * (2.0 * ext * rx * ry * x3 - eyt * x11 + eyt - 2.0 * x16 * x4 - x17 * (-x12 + 3.0 * x13 + x14 * x7))
            + ry_
            * (
                2.0 * ext * x1 * x3
                - ext
                - 2.0 * eyt * x15
                + 2.0 * ryt * x3 * (3.0 * ex * ry - x10 * x14 - x13)
                - x16 * x17
            )
        )
        own[3384] = dx_ * rxt + dxt * rx_ + dy_ * ryt + dyt * ry_
        own[3456] = dx_ * dxt + dy_ * dyt


@routine("iv", fastmath=FAST)
def hessian(count, x):
    """Fill the second derivative of the energy by q."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        rx = own[0]
        ry = own[72]
        dx = own[144]
        dy = own[216]
        ex = own[288]
        ey = own[360]
        s0 = own[864]
        s1 = own[936]
        s2 = own[1008]
        s3 = own[1080]
        c00 = own[1296]
        c01 = own[1368]
        c02 = own[1440]
        c03 = own[1512]
        c11 = own[1584]
        c12 = own[1656]
        c13 = own[1728]
        c22 = own[1800]
        c23 = own[1872]
        c33 = own[1944]
        x0 = rx * rx
        x1 = ry * ry
        x2 = x0 + x1
        x3 = 1.0 / math.sqrt(x2)
        x4 = 1.0 / x2
        x5 = rx * x4
        x6 = ex * ry
        x7 = ey * rx
        x8 = x6 - x7
        x9 = ry * x4
        x10 = x0 * x4
        x11 = s0 * x3
        x12 = 1.0 / (x2 * x2)
        x13 = 2.0 * s1 * x12
        x14 = rx * ry
        x15 = 4.0 * x8
        x16 = x1 * x4
        x17 = x13 * x14
        x18 = s1 * x4
        j00 = rx * x3
        j01 = ry * x3
        j10 = x4 * (ey + 2.0 * x5 * x8)
        j11 = x4 * (-ex + 2.0 * ry * x4 * x8)
        j14 = -x9
        j15 = x5
        j20 = dx
        j21 = dy
        j22 = rx
        j23 = ry
        j32 = dx
        j33 = dy
        u00 = c00 * j00 + c01 * j10 + c02 * j20
        u01 = c00 * j01 + c01 * j11 + c02 * j21
        u02 = c02 * j22 + c03 * j32
        u03 = c02 * j23 + c03 * j33
        u04 = c01 * j14
        u05 = c01 * j15
        u10 = c01 * j00 + c11 * j10 + c12 * j20
        u11 = c01 * j01 + c11 * j11 + c12 * j21
        u12 = c12 * j22 + c13 * j32
        u13 = c12 * j23 + c13 * j33
        u14 = c11 * j14
        u15 = c11 * j15
        u20 = c02 * j00 + c12 * j10 + c22 * j20
        u21 = c02 * j01 + c12 * j11 + c22 * j21
        u22 = c22 * j22 + c23 * j32
        u23 = c22 * j23 + c23 * j33
        u24 = c12 * j14
        u25 = c12 * j15
        u32 = c23 * j22 + c33 * j32
        u33 = c23 * j23 + c33 * j33
        u34 = c13 * j14
        u35 = c13 * j15
        own[3240] = j00 * u00 + j10 * u10 + j20 * u20 - x11 * (x10 - 1.0) - x13 * (3.0 * ey * rx + 4.0 * x10 * x8 - x6)
        own[3312] = (
            j00 * u01
            + j10 * u11
            + j20 * u21
            - s0 * x14 / (x2 * math.sqrt(x2))
            + 2.0 * s1 * x12 * (ex * rx - ey * ry - rx * x15 * x9)
        )
        own[3384] = (
            j01 * u01 + j11 * u11 + j21 * u21 + 2.0 * s1 * x12 * (3.0 * ex * ry - x15 * x16 - x7) - x11 * (x16 - 1.0)
        )
        own[3456] = j00 * u02 + j10 * u12 + j20 * u22 + s2
        own[3528] = j00 * u03 + j10 * u13 + j20 * u23
        own[3600] = j01 * u02 + j11 * u12 + j21 * u22
        own[3672] = j01 * u03 + j11 * u13 + j21 * u23 + s2
        own[3744] = j00 * u04 + j10 * u14 + j20 * u24 + x17
        own[3816] = j00 * u05 + j10 * u15 + j20 * u25 - x18 * (2.0 * x10 - 1.0)
        own[3888] = j01 * u04 + j11 * u14 + j21 * u24 + x18 * (2.0 * x16 - 1.0)
        own[3960] = j01 * u05 + j11 * u15 + j21 * u25 - x17
        own[4032] = j22 * u22 + j32 * u32 + s3
        own[4104] = j22 * u23 + j32 * u33
        own[4176] = j23 * u23 + j33 * u33 + s3
        own[4248] = j22 * u24 + j32 * u34
        own[4320] = j22 * u25 + j32 * u35
        own[4392] = j23 * u24 + j33 * u34
        own[4464] = j23 * u25 + j33 * u35
        own[4536] = j14 * u14
        own[4608] = j14 * u15
        own[4680] = j15 * u15
