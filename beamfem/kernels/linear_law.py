"""The linear section law s = C (eps - eps0); resultants and stiffness are multiplied by the weight of the point.

A law is a pass over one quadrature point, `number`, of the `count` elements from `first` on: it computes resultants and
their derivatives from strains. A law with history reads it from the state of the system. c: upper triangle of C, row by
row; w: weights.
"""

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import RATE, RESULTANT, STIFFNESS, STRAIN
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Rows
from beamfem.kernels.simd import WIDTH, zeros


@inlined
def _resultants(measures, count, stiff, w, c, eps0, x):
    eps, s, pairs = at(x, STRAIN * ROW), at(x, RESULTANT * ROW), measures * (measures + 1) // 2
    for i in range(0, count, WIDTH):
        weight = w[i]
        for row in range(measures):
            total = zeros()
            for column in range(measures):
                first, last = min(row, column), max(row, column)
                pair = first * measures - first * (first + 1) // 2 + last
                total += c[pair * ROW + i] * (eps[column * ROW + i] - eps0[column * ROW + i])
            s[row * ROW + i] = weight * total
    if stiff != 0:
        for k in range(pairs):
            to, entry = at(x, (STIFFNESS + k) * ROW), at(c, k * ROW)
            for i in range(0, count, WIDTH):
                to[i] = w[i] * entry[i]


@routine(fastmath=FAST)
def four_resultants(
    group: Group, system: System, first: int, number: int, count: int, stiff: int, w: Rows, c: Rows, eps0: Rows, x: Rows
) -> None:
    """Fill the resultants of four measures and, if `stiff`, their stiffness; x: rows of a point, see `point`."""
    _resultants(4, count, stiff, w, c, eps0, x)


@routine(fastmath=FAST)
def six_resultants(
    group: Group, system: System, first: int, number: int, count: int, stiff: int, w: Rows, c: Rows, eps0: Rows, x: Rows
) -> None:
    """Do the same as `four_resultants` for six measures."""
    _resultants(6, count, stiff, w, c, eps0, x)


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
