"""Passes of the strain measure `beamfem.physics.measures.green_lagrange`.

Written by beamfem.physics.generate: do not edit.
"""

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
        x[6 * ROW + i] = (0.5) * ((rx * rx) + (ry * ry) - 1.0)
        x[7 * ROW + i] = ex * rx + ey * ry
        x[8 * ROW + i] = (0.5) * ((ex * ex) + (ey * ey))
        x[9 * ROW + i] = (0.5) * ((dx * dx) + (dy * dy) - 1.0)
        x[10 * ROW + i] = dx * rx + dy * ry
        x[11 * ROW + i] = dx * ex + dy * ey


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
        s4 = x[16 * ROW + i]
        s5 = x[17 * ROW + i]
        x[39 * ROW + i] = dx * s4 + ex * s1 + rx * s0
        x[40 * ROW + i] = dy * s4 + ey * s1 + ry * s0
        x[41 * ROW + i] = dx * s3 + ex * s5 + rx * s4
        x[42 * ROW + i] = dy * s3 + ey * s5 + ry * s4
        x[43 * ROW + i] = dx * s5 + ex * s2 + rx * s1
        x[44 * ROW + i] = dy * s5 + ey * s2 + ry * s1


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
        x[66 * ROW + i] = rx * rx_ + ry * ry_
        x[67 * ROW + i] = ex * rx_ + ex_ * rx + ey * ry_ + ey_ * ry
        x[68 * ROW + i] = ex * ex_ + ey * ey_
        x[69 * ROW + i] = dx * dx_ + dy * dy_
        x[70 * ROW + i] = dx * rx_ + dx_ * rx + dy * ry_ + dy_ * ry
        x[71 * ROW + i] = dx * ex_ + dx_ * ex + dy * ey_ + dy_ * ey


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
        s4 = x[16 * ROW + i]
        s5 = x[17 * ROW + i]
        c00 = x[18 * ROW + i]
        c01 = x[19 * ROW + i]
        c02 = x[20 * ROW + i]
        c03 = x[21 * ROW + i]
        c04 = x[22 * ROW + i]
        c05 = x[23 * ROW + i]
        c11 = x[24 * ROW + i]
        c12 = x[25 * ROW + i]
        c13 = x[26 * ROW + i]
        c14 = x[27 * ROW + i]
        c15 = x[28 * ROW + i]
        c22 = x[29 * ROW + i]
        c23 = x[30 * ROW + i]
        c24 = x[31 * ROW + i]
        c25 = x[32 * ROW + i]
        c33 = x[33 * ROW + i]
        c34 = x[34 * ROW + i]
        c35 = x[35 * ROW + i]
        c44 = x[36 * ROW + i]
        c45 = x[37 * ROW + i]
        c55 = x[38 * ROW + i]
        j00 = rx
        j01 = ry
        j10 = ex
        j11 = ey
        j14 = rx
        j15 = ry
        j24 = ex
        j25 = ey
        j32 = dx
        j33 = dy
        j40 = dx
        j41 = dy
        j42 = rx
        j43 = ry
        j52 = ex
        j53 = ey
        j54 = dx
        j55 = dy
        u00 = c00 * j00 + c01 * j10 + c04 * j40
        u01 = c00 * j01 + c01 * j11 + c04 * j41
        u02 = c03 * j32 + c04 * j42 + c05 * j52
        u03 = c03 * j33 + c04 * j43 + c05 * j53
        u04 = c01 * j14 + c02 * j24 + c05 * j54
        u05 = c01 * j15 + c02 * j25 + c05 * j55
        u10 = c01 * j00 + c11 * j10 + c14 * j40
        u11 = c01 * j01 + c11 * j11 + c14 * j41
        u12 = c13 * j32 + c14 * j42 + c15 * j52
        u13 = c13 * j33 + c14 * j43 + c15 * j53
        u14 = c11 * j14 + c12 * j24 + c15 * j54
        u15 = c11 * j15 + c12 * j25 + c15 * j55
        u24 = c12 * j14 + c22 * j24 + c25 * j54
        u25 = c12 * j15 + c22 * j25 + c25 * j55
        u32 = c33 * j32 + c34 * j42 + c35 * j52
        u33 = c33 * j33 + c34 * j43 + c35 * j53
        u34 = c13 * j14 + c23 * j24 + c35 * j54
        u35 = c13 * j15 + c23 * j25 + c35 * j55
        u40 = c04 * j00 + c14 * j10 + c44 * j40
        u41 = c04 * j01 + c14 * j11 + c44 * j41
        u42 = c34 * j32 + c44 * j42 + c45 * j52
        u43 = c34 * j33 + c44 * j43 + c45 * j53
        u44 = c14 * j14 + c24 * j24 + c45 * j54
        u45 = c14 * j15 + c24 * j25 + c45 * j55
        u52 = c35 * j32 + c45 * j42 + c55 * j52
        u53 = c35 * j33 + c45 * j43 + c55 * j53
        u54 = c15 * j14 + c25 * j24 + c55 * j54
        u55 = c15 * j15 + c25 * j25 + c55 * j55
        x[45 * ROW + i] = j00 * u00 + j10 * u10 + j40 * u40 + s0
        x[46 * ROW + i] = j00 * u01 + j10 * u11 + j40 * u41
        x[47 * ROW + i] = j01 * u01 + j11 * u11 + j41 * u41 + s0
        x[48 * ROW + i] = j00 * u02 + j10 * u12 + j40 * u42 + s4
        x[49 * ROW + i] = j00 * u03 + j10 * u13 + j40 * u43
        x[50 * ROW + i] = j01 * u02 + j11 * u12 + j41 * u42
        x[51 * ROW + i] = j01 * u03 + j11 * u13 + j41 * u43 + s4
        x[52 * ROW + i] = j00 * u04 + j10 * u14 + j40 * u44 + s1
        x[53 * ROW + i] = j00 * u05 + j10 * u15 + j40 * u45
        x[54 * ROW + i] = j01 * u04 + j11 * u14 + j41 * u44
        x[55 * ROW + i] = j01 * u05 + j11 * u15 + j41 * u45 + s1
        x[56 * ROW + i] = j32 * u32 + j42 * u42 + j52 * u52 + s3
        x[57 * ROW + i] = j32 * u33 + j42 * u43 + j52 * u53
        x[58 * ROW + i] = j33 * u33 + j43 * u43 + j53 * u53 + s3
        x[59 * ROW + i] = j32 * u34 + j42 * u44 + j52 * u54 + s5
        x[60 * ROW + i] = j32 * u35 + j42 * u45 + j52 * u55
        x[61 * ROW + i] = j33 * u34 + j43 * u44 + j53 * u54
        x[62 * ROW + i] = j33 * u35 + j43 * u45 + j53 * u55 + s5
        x[63 * ROW + i] = j14 * u14 + j24 * u24 + j54 * u54 + s2
        x[64 * ROW + i] = j14 * u15 + j24 * u25 + j54 * u55
        x[65 * ROW + i] = j15 * u15 + j25 * u25 + j55 * u55 + s2
