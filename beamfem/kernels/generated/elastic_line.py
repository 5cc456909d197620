"""Passes of the strain measure `beamfem.physics.measures.elastic_line`.

Written by beamfem.physics.generate: do not edit.
"""

import math

from beamfem.kernels.compiling import routine
from beamfem.kernels.lanes import WIDTH
from beamfem.kernels.record import ROW

FAST = {"contract", "reassoc", "nsz"}


@routine("iv", fastmath=FAST)
def strains(count, x):
    """Fill strains."""
    for i in range(0, count, WIDTH):
        rx = x[0 * ROW + i]
        ry = x[1 * ROW + i]
        dx = x[2 * ROW + i]
        dy = x[3 * ROW + i]
        ex = x[4 * ROW + i]
        ey = x[5 * ROW + i]
        x0 = (rx * rx) + (ry * ry)
        x[6 * ROW + i] = math.sqrt(x0) - 1.0
        x[7 * ROW + i] = -(ex * ry - ey * rx) / x0
        x[8 * ROW + i] = dx * rx + dy * ry
        x[9 * ROW + i] = (0.5) * ((dx * dx) + (dy * dy) - 1.0)


@routine("iv", fastmath=FAST)
def forces(count, x):
    """Fill forces on q of stress resultants."""
    for i in range(0, count, WIDTH):
        rx = x[0 * ROW + i]
        ry = x[1 * ROW + i]
        dx = x[2 * ROW + i]
        dy = x[3 * ROW + i]
        ex = x[4 * ROW + i]
        ey = x[5 * ROW + i]
        s0 = x[12 * ROW + i]
        s1 = x[13 * ROW + i]
        s2 = x[14 * ROW + i]
        s3 = x[15 * ROW + i]
        x0 = (rx * rx) + (ry * ry)
        x1 = s0 / math.sqrt(x0)
        x2 = 1.0 / x0
        x3 = 2.0 * x2 * (ex * ry - ey * rx)
        x4 = s1 * x2
        x[39 * ROW + i] = dx * s2 + rx * x1 + x4 * (ey + rx * x3)
        x[40 * ROW + i] = dy * s2 + ry * x1 - x4 * (ex - ry * x3)
        x[41 * ROW + i] = dx * s3 + rx * s2
        x[42 * ROW + i] = dy * s3 + ry * s2
        x[43 * ROW + i] = -ry * x4
        x[44 * ROW + i] = rx * x4


@routine("iv", fastmath=FAST)
def rates(count, x):
    """Fill the change of strains with a change of q, in its place."""
    for i in range(0, count, WIDTH):
        rx = x[0 * ROW + i]
        ry = x[1 * ROW + i]
        dx = x[2 * ROW + i]
        dy = x[3 * ROW + i]
        ex = x[4 * ROW + i]
        ey = x[5 * ROW + i]
        rx_ = x[66 * ROW + i]
        ry_ = x[67 * ROW + i]
        dx_ = x[68 * ROW + i]
        dy_ = x[69 * ROW + i]
        ex_ = x[70 * ROW + i]
        ey_ = x[71 * ROW + i]
        x0 = (rx * rx) + (ry * ry)
        x1 = 1.0 / x0
        x2 = ex * ry - ey * rx
        x3 = 2.0 * x1
        x[66 * ROW + i] = (rx * rx_ + ry * ry_) / math.sqrt(x0)
        x[67 * ROW + i] = x1 * (-ex_ * ry + ey_ * rx + rx_ * (ey + rx * x2 * x3) - ry_ * (ex - ry * x2 * x3))
        x[68 * ROW + i] = dx * rx_ + dx_ * rx + dy * ry_ + dy_ * ry
        x[69 * ROW + i] = dx * dx_ + dy * dy_


@routine("iv", fastmath=FAST)
def hessian(count, x):
    """Fill the second derivative of the energy by q."""
    for i in range(0, count, WIDTH):
        rx = x[0 * ROW + i]
        ry = x[1 * ROW + i]
        dx = x[2 * ROW + i]
        dy = x[3 * ROW + i]
        ex = x[4 * ROW + i]
        ey = x[5 * ROW + i]
        s0 = x[12 * ROW + i]
        s1 = x[13 * ROW + i]
        s2 = x[14 * ROW + i]
        s3 = x[15 * ROW + i]
        c00 = x[18 * ROW + i]
        c01 = x[19 * ROW + i]
        c02 = x[20 * ROW + i]
        c03 = x[21 * ROW + i]
        c11 = x[22 * ROW + i]
        c12 = x[23 * ROW + i]
        c13 = x[24 * ROW + i]
        c22 = x[25 * ROW + i]
        c23 = x[26 * ROW + i]
        c33 = x[27 * ROW + i]
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
        x[45 * ROW + i] = (
            j00 * u00 + j10 * u10 + j20 * u20 - x11 * (x10 - 1.0) - x13 * (3.0 * ey * rx + 4.0 * x10 * x8 - x6)
        )
        x[46 * ROW + i] = (
            j00 * u01
            + j10 * u11
            + j20 * u21
            - s0 * x14 / (x2 * math.sqrt(x2))
            + 2.0 * s1 * x12 * (ex * rx - ey * ry - rx * x15 * x9)
        )
        x[47 * ROW + i] = (
            j01 * u01 + j11 * u11 + j21 * u21 + 2.0 * s1 * x12 * (3.0 * ex * ry - x15 * x16 - x7) - x11 * (x16 - 1.0)
        )
        x[48 * ROW + i] = j00 * u02 + j10 * u12 + j20 * u22 + s2
        x[49 * ROW + i] = j00 * u03 + j10 * u13 + j20 * u23
        x[50 * ROW + i] = j01 * u02 + j11 * u12 + j21 * u22
        x[51 * ROW + i] = j01 * u03 + j11 * u13 + j21 * u23 + s2
        x[52 * ROW + i] = j00 * u04 + j10 * u14 + j20 * u24 + x17
        x[53 * ROW + i] = j00 * u05 + j10 * u15 + j20 * u25 - x18 * (2.0 * x10 - 1.0)
        x[54 * ROW + i] = j01 * u04 + j11 * u14 + j21 * u24 + x18 * (2.0 * x16 - 1.0)
        x[55 * ROW + i] = j01 * u05 + j11 * u15 + j21 * u25 - x17
        x[56 * ROW + i] = j22 * u22 + j32 * u32 + s3
        x[57 * ROW + i] = j22 * u23 + j32 * u33
        x[58 * ROW + i] = j23 * u23 + j33 * u33 + s3
        x[59 * ROW + i] = j22 * u24 + j32 * u34
        x[60 * ROW + i] = j22 * u25 + j32 * u35
        x[61 * ROW + i] = j23 * u24 + j33 * u34
        x[62 * ROW + i] = j23 * u25 + j33 * u35
        x[63 * ROW + i] = j14 * u14
        x[64 * ROW + i] = j14 * u15
        x[65 * ROW + i] = j15 * u15
