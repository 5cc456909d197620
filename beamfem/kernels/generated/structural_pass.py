"""Passes of the strain measure `beamfem.physics.measures.structural`.

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
        x0 = (dx * dx) + (dy * dy)
        x1 = math.sqrt(x0)
        x2 = 1.0 / x1
        own[432] = -dx * ry * x2 + dy * rx * x2 - 1.0
        own[504] = x2 * (dx * rx + dy * ry)
        own[576] = (dx * ey - dy * ex) / x0
        own[648] = x1 - 1.0


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
        x0 = dx * dx
        x1 = dy * dy
        x2 = x0 + x1
        x3 = 1.0 / math.sqrt(x2)
        x4 = 1.0 / x2
        x5 = dx * x4
        x6 = dy * x5
        x7 = rx * x6
        x8 = x0 * x4
        x9 = s0 * x3
        x10 = ry * x6
        x11 = s1 * x3
        x12 = dy * ex
        x13 = dx * ey
        x14 = x4 * (-x12 + x13)
        x15 = s2 * x4
        x16 = x1 * x4
        own[2808] = x3 * (dx * s1 + dy * s0)
        own[2880] = x3 * (-dx * s0 + dy * s1)
        own[2952] = (
            dx * s3 * x3
            - x11 * (rx * x8 - rx + x10)
            - x15 * (dx * x14 + ey * x8 - ey - x12 * x5)
            - x9 * (-ry * x8 + ry + x7)
        )
        own[3024] = (
            dy * s3 * x3
            - x11 * (ry * x16 - ry + x7)
            - x15 * (dy * x13 * x4 + dy * x14 - ex * x16 + ex)
            + x9 * (-rx * x16 + rx + x10)
        )
        own[3096] = -dy * x15
        own[3168] = dx * x15


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
        x0 = dx * dx
        x1 = dy * dy
        x2 = x0 + x1
        x3 = 1.0 / math.sqrt(x2)
        x4 = 1.0 / x2
        x5 = rx * x4
        x6 = dx * dy
        x7 = x5 * x6
        x8 = ry * x4
        x9 = x6 * x8
        x10 = dx * ey
        x11 = dy * ex
        x12 = x4 * (x10 - x11)
        own[4752] = x3 * (-dx * ry_ - dx_ * (ry - x0 * x8 + x7) + dy * rx_ + dy_ * (rx - x1 * x5 + x9))
        own[4824] = x3 * (dx * rx_ - dx_ * (-rx + x0 * x5 + x9) + dy * ry_ - dy_ * (-ry + x1 * x8 + x7))
        own[4896] = x4 * (
            dx * ey_
            - dx_ * (-dx * x11 * x4 + dx * x12 + ey * x0 * x4 - ey)
            - dy * ex_
            - dy_ * (dy * x10 * x4 + dy * x12 - ex * x1 * x4 + ex)
        )
        own[4968] = x3 * (dx * dx_ + dy * dy_)


@routine("iv", fastmath=FAST)
def rate_changes(count, x):
    """Fill the change of strain rates with a change of q at constant q'."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
        rx = own[0]
        ry = own[72]
        dx = own[144]
        dy = own[216]
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
        x0 = dx * dx
        x1 = dy * dy
        x2 = x0 + x1
        x3 = 1.0 / math.sqrt(x2)
        x4 = 1.0 / x2
        x5 = dxt * x4
        x6 = dx * dy
        x7 = x5 * x6
        x8 = x1 * x4
        x9 = dyt * (x8 - 1.0) + x7
        x10 = dyt * x4
        x11 = x10 * x6
        x12 = x0 * x4
        x13 = dxt * (x12 - 1.0) + x11
        x14 = x4 * x6
        x15 = rxt * x14
        x16 = dy * rx
        x17 = dx * ry
        x18 = 3.0 * x17
        x19 = 3.0 * x4
        x20 = (dx * dx * dx) * x19
        x21 = 3.0 * x16
        x22 = x12 * x21
        x23 = dx * rx
        x24 = 3.0 * x23
        x25 = x24 * x8
        x26 = dy * ry
        x27 = 3.0 * x26
        x28 = x12 * x27 - x26
        x29 = x23 - x25 + x28
        x30 = -ryt * x14
        x31 = (dy * dy * dy) * x19
        x32 = -x17 + x18 * x8
        x33 = -x16 + x22 + x32
        x34 = 2.0 * dx
        x35 = dy * x34
        x36 = 2.0 * x8
        x37 = 2.0 * x12
        x38 = dy * x4
        x39 = x34 * x38
        x40 = dx * ey
        x41 = dy * ex
        x42 = 3.0 * x12
        x43 = x40 - x41
        x44 = 3.0 * x43
        x45 = dx * x4 * x41 - ey * x12 + ey
        x46 = dx * ex
        x47 = dy * ey
        x48 = 3.0 * x8
        x49 = -ex * x8 + ex + x38 * x40
        x50 = dx * x49 - dy * x45 + x19 * x43 * x6 + x42 * x47 - x46 * x48 + x46 - x47
        own[3240] = x3 * (
            -dx_ * (-ryt * x12 + ryt + x10 * x29 + x15 + x5 * (ry * x20 + x16 - x18 - x22))
            - dy_ * (rxt * x8 - rxt + x10 * (-rx * x31 + x21 + x32) + x29 * x5 + x30)
            - rx_ * x9
            + ry_ * x13
        )
        own[3312] = x3 * (
            dx_ * (-rxt * x12 + rxt + x10 * x33 + x30 + x5 * (rx * x20 - x24 + x28))
            + dy_ * (-ryt * x8 + ryt + x10 * (ry * x31 - x23 + x25 - x27) - x15 + x33 * x5)
            - rx_ * x13
            - ry_ * x9
        )
        own[3384] = x4 * (
            dx_
            * (
                ext * x39
                - eyt * x37
                + eyt
                + x10 * x50
                + x5 * (ey * x20 + x12 * x44 - x34 * x45 - 4.0 * x40 - x41 * x42 + 2.0 * x41)
            )
            + dy_
            * (
                ext * x36
                - ext
                - eyt * x39
                + x10 * (2.0 * dy * x49 - ex * x31 + x40 * x48 - 2.0 * x40 + 4.0 * x41 + x44 * x8)
                + x5 * x50
            )
            + ex_ * (dyt * (x36 - 1.0) + x35 * x5)
            - ey_ * (dxt * (x37 - 1.0) + x10 * x35)
        )
        own[3456] = -x3 * (dx_ * (dxt * x12 - dxt + x11) + dy_ * (dyt * x8 - dyt + x7))


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
        x0 = dx * dx
        x1 = dy * dy
        x2 = x0 + x1
        x3 = 1.0 / math.sqrt(x2)
        x4 = dy * x3
        x5 = dx * x3
        x6 = 1.0 / x2
        x7 = dy * x6
        x8 = dx * rx
        x9 = x7 * x8
        x10 = dx * ry
        x11 = x10 * x7
        x12 = x1 * x6
        x13 = x0 * x6
        x14 = ey * x13
        x15 = dx * ey
        x16 = dy * ex
        x17 = x15 - x16
        x18 = dx * x6
        x19 = x17 * x7
        x20 = -ex * x12 + ex + x15 * x7
        x21 = dx * x7
        x22 = s0 * x21
        x23 = x13 - 1.0
        x24 = s1 * x21
        x25 = x12 - 1.0
        x26 = s3 * x3
        x27 = dy * rx
        x28 = 3.0 * x6
        x29 = (dx * dx * dx) * x28
        x30 = x0 * x7
        x31 = 3.0 * x30
        x32 = rx * x31
        x33 = 1.0 / (x2 * math.sqrt(x2))
        x34 = s0 * x33
        x35 = dy * ry
        x36 = 3.0 * ry
        x37 = x30 * x36 - x35
        x38 = 1.0 / (x2 * x2)
        x39 = 3.0 * x17
        x40 = ey - x14 + x16 * x18
        x41 = 2.0 * dx
        x42 = x1 * x18
        x43 = 3.0 * x42
        x44 = rx * x43
        x45 = -x10 + x36 * x42
        x46 = (dy * dy * dy) * x28
        x47 = dy * s2 * x38 * x41
        x48 = s2 * x6
        j00 = x4
        j01 = -x5
        j02 = x3 * (ry * x0 * x6 - ry - x9)
        j03 = x3 * (-rx * x12 + rx + x11)
        j10 = x5
        j11 = x4
        j12 = x3 * (-rx * x13 + rx - x11)
        j13 = x3 * (-ry * x12 + ry - x9)
        j22 = x6 * (dx * dy * ex * x6 + ey - x14 - x17 * x18)
        j23 = -x6 * (x19 + x20)
        j24 = -x7
        j25 = x18
        j32 = x5
        j33 = x4
        u00 = c00 * j00 + c01 * j10
        u01 = c00 * j01 + c01 * j11
        u02 = c00 * j02 + c01 * j12 + c02 * j22 + c03 * j32
        u03 = c00 * j03 + c01 * j13 + c02 * j23 + c03 * j33
        u04 = c02 * j24
        u05 = c02 * j25
        u10 = c01 * j00 + c11 * j10
        u11 = c01 * j01 + c11 * j11
        u12 = c01 * j02 + c11 * j12 + c12 * j22 + c13 * j32
        u13 = c01 * j03 + c11 * j13 + c12 * j23 + c13 * j33
        u14 = c12 * j24
        u15 = c12 * j25
        u22 = c02 * j02 + c12 * j12 + c22 * j22 + c23 * j32
        u23 = c02 * j03 + c12 * j13 + c22 * j23 + c23 * j33
        u24 = c22 * j24
        u25 = c22 * j25
        u32 = c03 * j02 + c13 * j12 + c23 * j22 + c33 * j32
        u33 = c03 * j03 + c13 * j13 + c23 * j23 + c33 * j33
        u34 = c23 * j24
        u35 = c23 * j25
        own[3240] = j00 * u00 + j10 * u10
        own[3312] = j00 * u01 + j10 * u11
        own[3384] = j01 * u01 + j11 * u11
        own[3456] = j00 * u02 + j10 * u12 - x3 * (s1 * x23 + x22)
        own[3528] = j00 * u03 + j10 * u13 - x3 * (s0 * x25 + x24)
        own[3600] = j01 * u02 + j11 * u12 + x3 * (s0 * x23 - x24)
        own[3672] = j01 * u03 + j11 * u13 + x3 * (-s1 * x25 + x22)
        own[3744] = j00 * u04 + j10 * u14
        own[3816] = j00 * u05 + j10 * u15
        own[3888] = j01 * u04 + j11 * u14
        own[3960] = j01 * u05 + j11 * u15
        own[4032] = (
            j02 * u02
            + j12 * u12
            + j22 * u22
            + j32 * u32
            + s1 * x33 * (rx * x29 + x37 - 3.0 * x8)
            + s2 * x38 * (ey * x29 - 3.0 * x13 * x16 + x13 * x39 - 4.0 * x15 + 2.0 * x16 - x40 * x41)
            - x23 * x26
            - x34 * (ry * x29 - 3.0 * x10 + x27 - x32)
        )
        own[4104] = (
            -dx * dy * s3 * x33
            + j02 * u03
            + j12 * u13
            + j22 * u23
            + j32 * u33
            + s1 * x33 * (-x27 + x32 + x45)
            + s2 * x38 * (dx * ex + 3.0 * dx * x19 + dx * x20 - dy * ey - dy * x40 - ex * x43 + ey * x31)
            - x34 * (x37 - x44 + x8)
        )
        own[4176] = (
            j03 * u03
            + j13 * u13
            + j23 * u23
            + j33 * u33
            + s1 * x33 * (ry * x46 - 3.0 * x35 + x44 - x8)
            + s2 * x38 * (2.0 * dy * x20 - ex * x46 + 3.0 * x12 * x15 + x12 * x39 - 2.0 * x15 + 4.0 * x16)
            - x25 * x26
            - x34 * (-rx * x46 + 3.0 * x27 + x45)
        )
        own[4248] = j02 * u04 + j12 * u14 + j22 * u24 + j32 * u34 + x47
        own[4320] = j02 * u05 + j12 * u15 + j22 * u25 + j32 * u35 - x48 * (2.0 * x13 - 1.0)
        own[4392] = j03 * u04 + j13 * u14 + j23 * u24 + j33 * u34 + x48 * (2.0 * x12 - 1.0)
        own[4464] = j03 * u05 + j13 * u15 + j23 * u25 + j33 * u35 - x47
        own[4536] = j24 * u24
        own[4608] = j24 * u25
        own[4680] = j25 * u25
