"""Passes of the strain measure `beamfem.physics.measures.green_lagrange`.

A row has 72 numbers. Written by beamfem.physics.generate: do not edit.
"""

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
        own[432] = (0.5) * ((rx * rx) + (ry * ry) - 1.0)
        own[504] = ex * rx + ey * ry
        own[576] = (0.5) * ((ex * ex) + (ey * ey))
        own[648] = (0.5) * ((dx * dx) + (dy * dy) - 1.0)
        own[720] = dx * rx + dy * ry
        own[792] = dx * ex + dy * ey


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
        s4 = own[1152]
        s5 = own[1224]
        own[2808] = dx * s4 + ex * s1 + rx * s0
        own[2880] = dy * s4 + ey * s1 + ry * s0
        own[2952] = dx * s3 + ex * s5 + rx * s4
        own[3024] = dy * s3 + ey * s5 + ry * s4
        own[3096] = dx * s5 + ex * s2 + rx * s1
        own[3168] = dy * s5 + ey * s2 + ry * s1


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
        own[4752] = rx * rx_ + ry * ry_
        own[4824] = ex * rx_ + ex_ * rx + ey * ry_ + ey_ * ry
        own[4896] = ex * ex_ + ey * ey_
        own[4968] = dx * dx_ + dy * dy_
        own[5040] = dx * rx_ + dx_ * rx + dy * ry_ + dy_ * ry
        own[5112] = dx * ex_ + dx_ * ex + dy * ey_ + dy_ * ey


@routine("iv", fastmath=FAST)
def rate_changes(count, x):
    """Fill the change of strain rates with a change of q at constant q'."""
    for i in range(0, count, WIDTH):
        own = at(x, i)
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
        own[3240] = rx_ * rxt + ry_ * ryt
        own[3312] = ex_ * rxt + ext * rx_ + ey_ * ryt + eyt * ry_
        own[3384] = ex_ * ext + ey_ * eyt
        own[3456] = dx_ * dxt + dy_ * dyt
        own[3528] = dx_ * rxt + dxt * rx_ + dy_ * ryt + dyt * ry_
        own[3600] = dx_ * ext + dxt * ex_ + dy_ * eyt + dyt * ey_


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
        s4 = own[1152]
        s5 = own[1224]
        c00 = own[1296]
        c01 = own[1368]
        c02 = own[1440]
        c03 = own[1512]
        c04 = own[1584]
        c05 = own[1656]
        c11 = own[1728]
        c12 = own[1800]
        c13 = own[1872]
        c14 = own[1944]
        c15 = own[2016]
        c22 = own[2088]
        c23 = own[2160]
        c24 = own[2232]
        c25 = own[2304]
        c33 = own[2376]
        c34 = own[2448]
        c35 = own[2520]
        c44 = own[2592]
        c45 = own[2664]
        c55 = own[2736]
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
        own[3240] = j00 * u00 + j10 * u10 + j40 * u40 + s0
        own[3312] = j00 * u01 + j10 * u11 + j40 * u41
        own[3384] = j01 * u01 + j11 * u11 + j41 * u41 + s0
        own[3456] = j00 * u02 + j10 * u12 + j40 * u42 + s4
        own[3528] = j00 * u03 + j10 * u13 + j40 * u43
        own[3600] = j01 * u02 + j11 * u12 + j41 * u42
        own[3672] = j01 * u03 + j11 * u13 + j41 * u43 + s4
        own[3744] = j00 * u04 + j10 * u14 + j40 * u44 + s1
        own[3816] = j00 * u05 + j10 * u15 + j40 * u45
        own[3888] = j01 * u04 + j11 * u14 + j41 * u44
        own[3960] = j01 * u05 + j11 * u15 + j41 * u45 + s1
        own[4032] = j32 * u32 + j42 * u42 + j52 * u52 + s3
        own[4104] = j32 * u33 + j42 * u43 + j52 * u53
        own[4176] = j33 * u33 + j43 * u43 + j53 * u53 + s3
        own[4248] = j32 * u34 + j42 * u44 + j52 * u54 + s5
        own[4320] = j32 * u35 + j42 * u45 + j52 * u55
        own[4392] = j33 * u34 + j43 * u44 + j53 * u54
        own[4464] = j33 * u35 + j43 * u45 + j53 * u55 + s5
        own[4536] = j14 * u14 + j24 * u24 + j54 * u54 + s2
        own[4608] = j14 * u15 + j24 * u25 + j54 * u55
        own[4680] = j15 * u15 + j25 * u25 + j55 * u55 + s2
