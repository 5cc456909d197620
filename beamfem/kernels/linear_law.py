"""The linear section law s = C (eps - eps0); resultants and stiffness are multiplied by the weight of the point.

A law is a pass over one quadrature point, `number`, of the `count` elements from `first` on: it computes resultants and
their derivatives from strains. A law with history reads it from the state of the system. c: upper triangle of C, row by
row; w: weights.
"""

from beamfem.kernels.compiling import routine
from beamfem.kernels.point import RATE, RESULTANT, STIFFNESS, STRAIN
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.record import ROW, Group, System
from beamfem.kernels.records import Rows
from beamfem.kernels.simd import WIDTH

FAST = {"contract", "reassoc", "nsz"}


@routine(fastmath=FAST)
def four_resultants(
    group: Group, system: System, first: int, number: int, count: int, stiff: int, w: Rows, c: Rows, eps0: Rows, x: Rows
) -> None:
    """Fill the resultants of four measures and, if `stiff`, their stiffness; x: rows of a point, see `point`."""
    small_code()
    eps, s = at(x, STRAIN * ROW), at(x, RESULTANT * ROW)
    for i in range(0, count, WIDTH):
        weight = w[i]
        a0, a1 = eps[i] - eps0[i], eps[ROW + i] - eps0[ROW + i]
        a2, a3 = eps[2 * ROW + i] - eps0[2 * ROW + i], eps[3 * ROW + i] - eps0[3 * ROW + i]
        c01, c02, c03 = c[ROW + i], c[2 * ROW + i], c[3 * ROW + i]
        c12, c13, c23 = c[5 * ROW + i], c[6 * ROW + i], c[8 * ROW + i]
        s[i] = weight * (c[i] * a0 + c01 * a1 + c02 * a2 + c03 * a3)
        s[ROW + i] = weight * (c01 * a0 + c[4 * ROW + i] * a1 + c12 * a2 + c13 * a3)
        s[2 * ROW + i] = weight * (c02 * a0 + c12 * a1 + c[7 * ROW + i] * a2 + c23 * a3)
        s[3 * ROW + i] = weight * (c03 * a0 + c13 * a1 + c23 * a2 + c[9 * ROW + i] * a3)
    if stiff != 0:
        for k in range(10):
            to, entry = at(x, (STIFFNESS + k) * ROW), at(c, k * ROW)
            for i in range(0, count, WIDTH):
                to[i] = w[i] * entry[i]


@routine(fastmath=FAST)
def six_resultants(
    group: Group, system: System, first: int, number: int, count: int, stiff: int, w: Rows, c: Rows, eps0: Rows, x: Rows
) -> None:
    """Do the same as `four_resultants` for six measures."""
    eps, s = at(x, STRAIN * ROW), at(x, RESULTANT * ROW)
    for i in range(0, count, WIDTH):
        weight = w[i]
        a0, a1 = eps[i] - eps0[i], eps[ROW + i] - eps0[ROW + i]
        a2, a3 = eps[2 * ROW + i] - eps0[2 * ROW + i], eps[3 * ROW + i] - eps0[3 * ROW + i]
        a4, a5 = eps[4 * ROW + i] - eps0[4 * ROW + i], eps[5 * ROW + i] - eps0[5 * ROW + i]
        c01, c02, c03, c04, c05 = c[ROW + i], c[2 * ROW + i], c[3 * ROW + i], c[4 * ROW + i], c[5 * ROW + i]
        c12, c13, c14, c15 = c[7 * ROW + i], c[8 * ROW + i], c[9 * ROW + i], c[10 * ROW + i]
        c23, c24, c25 = c[12 * ROW + i], c[13 * ROW + i], c[14 * ROW + i]
        c34, c35 = c[16 * ROW + i], c[17 * ROW + i]
        c45 = c[19 * ROW + i]
        s[i] = weight * (c[i] * a0 + c01 * a1 + c02 * a2 + c03 * a3 + c04 * a4 + c05 * a5)
        s[ROW + i] = weight * (c01 * a0 + c[6 * ROW + i] * a1 + c12 * a2 + c13 * a3 + c14 * a4 + c15 * a5)
        s[2 * ROW + i] = weight * (c02 * a0 + c12 * a1 + c[11 * ROW + i] * a2 + c23 * a3 + c24 * a4 + c25 * a5)
        s[3 * ROW + i] = weight * (c03 * a0 + c13 * a1 + c23 * a2 + c[15 * ROW + i] * a3 + c34 * a4 + c35 * a5)
        s[4 * ROW + i] = weight * (c04 * a0 + c14 * a1 + c24 * a2 + c34 * a3 + c[18 * ROW + i] * a4 + c45 * a5)
        s[5 * ROW + i] = weight * (c05 * a0 + c15 * a1 + c25 * a2 + c35 * a3 + c45 * a4 + c[20 * ROW + i] * a5)
    if stiff != 0:
        for k in range(21):
            to, entry = at(x, (STIFFNESS + k) * ROW), at(c, k * ROW)
            for i in range(0, count, WIDTH):
                to[i] = w[i] * entry[i]


@routine("iiddvvvv", fastmath=FAST)
def add_viscous(count, measures, ck, cv, weight, c, time, x):
    """Add the viscous resultants t C eps' (Kelvin-Voigt), and replace the stiffness K by ck K + cv t C.

    time: row of retardation times t [s]; for the change of eps' with p at constant p' see `rate_tangent`.
    """
    rate, s, stiffness, pair = at(x, RATE * ROW), at(x, RESULTANT * ROW), at(x, STIFFNESS * ROW), 0
    for row in range(measures):
        for column in range(row, measures):
            entry, to = at(c, pair * ROW), at(stiffness, pair * ROW)
            row_stress, column_stress = at(s, row * ROW), at(s, column * ROW)
            column_rate, row_rate = at(rate, column * ROW), at(rate, row * ROW)
            for i in range(0, count, WIDTH):
                row_stress[i] += weight[i] * time[i] * entry[i] * column_rate[i]
            if column != row:
                for i in range(0, count, WIDTH):
                    column_stress[i] += weight[i] * time[i] * entry[i] * row_rate[i]
            if ck != 0.0 or cv != 0.0:
                for i in range(0, count, WIDTH):
                    to[i] = ck * to[i] + cv * weight[i] * time[i] * entry[i]
            pair += 1


@routine("iiiiirr")
def release(first, count, points, number, measures, natural, x):
    """Subtract imposed strains (elements, points, measures) from those of a point of a batch.

    number: of the point; x: rows of the point, see `point`.
    """
    for i in range(count):
        strains = at(natural, ((first + i) * points + number) * measures)
        for row in range(measures):
            x[(STRAIN + row) * ROW + i] -= strains[row]
