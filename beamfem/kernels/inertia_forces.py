"""Inertia and body forces of a batch, and the contribution of inertia to its matrices; each table entry is a row."""

from beamfem.kernels.compiling import FAST, routine
from beamfem.kernels.model_record import ROW
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, zeros


@routine("iiiiiiivvvvvv", fastmath=FAST)
def add_inertia(nodes, vectors, count, stride, loaded, moving, apart, mass, gravity, length, body, e, f):
    """Fill f (nodes, 2 vectors, ROW) with M e'' minus body forces.

    e: e and then e'' of each node, `stride` numbers apart; apart: whether the mass does not couple d with r0, as for
    any section whose centre of mass is on the axis; loaded, moving: whether there are body forces and accelerations;
    body (4, ROW): acceleration of gravity and load per length.
    """
    small_code()
    slots, last = nodes * vectors, vectors - 1
    for i in range(0, count, WIDTH):
        for slot in range(slots):
            vector = slot % vectors
            x, y = zeros(), zeros()
            if loaded != 0:
                m, weight = gravity[slot * ROW + i], length[slot * ROW + i]
                x = -body[i] * m - body[2 * ROW + i] * weight
                y = -body[ROW + i] * m - body[3 * ROW + i] * weight
            if moving != 0:
                begin = last if apart != 0 and vector == last else 0
                end = last if apart != 0 and vector < last else vectors
                for n in range(nodes):
                    masses = at(mass, (slot * slots + n * vectors) * ROW + i)
                    acceleration = at(e, n * stride + 2 * vectors * ROW + i)
                    for s in range(begin, end):
                        m = masses[s * ROW]
                        x, y = x + m * acceleration[2 * s * ROW], y + m * acceleration[(2 * s + 1) * ROW]
            f[2 * slot * ROW + i], f[(2 * slot + 1) * ROW + i] = x, y


@routine("iidvv", fastmath=FAST)
def add_scaled(rows, count, factor, source, to):
    """Add the rows of `source` times a factor to those of `to`."""
    small_code()
    for row in range(rows):
        terms, sums = at(source, row * ROW), at(to, row * ROW)
        for i in range(0, count, WIDTH):
            sums[i] += factor * terms[i]


@routine("iiiiiidvvvv", fastmath=FAST)
def add_mass(nodes, vectors, dependent, parameters, count, stride, ca, mass, b, c, k):
    """Add B^T M C to the reduced matrices k, with C = ca B + ck de''/dp + cv de''/dp'.

    b, c (nodes, stride, ROW): B and C of the vectors that depend on rotations; other vectors are coordinates
    themselves, with B = 1 and C = ca.
    """
    linear = vectors - dependent // 2
    coordinates = 2 * linear + parameters
    rows, slots = nodes * coordinates, nodes * vectors
    for m in range(nodes):
        for n in range(nodes):
            block = at(k, (rows * m * coordinates + n * coordinates) * ROW)
            b_n, c_m = at(b, n * stride * ROW), at(c, m * stride * ROW)
            for t in range(vectors):
                for s in range(vectors):
                    value = at(mass, ((n * vectors + s) * slots + m * vectors + t) * ROW)
                    if s < linear and t < linear:
                        x = at(block, (2 * t * rows + 2 * s) * ROW)
                        y = at(block, ((2 * t + 1) * rows + 2 * s + 1) * ROW)
                        for i in range(0, count, WIDTH):
                            x[i] += ca * value[i]
                            y[i] += ca * value[i]
                    elif s < linear:
                        for column in range(parameters):
                            x = at(block, ((2 * linear + column) * rows + 2 * s) * ROW)
                            cx = at(c_m, (2 * (t - linear) * parameters + column) * ROW)
                            cy = at(cx, parameters * ROW)
                            for i in range(0, count, WIDTH):
                                x[i] += value[i] * cx[i]
                                x[ROW + i] += value[i] * cy[i]
                    elif t < linear:
                        for row in range(parameters):
                            x = at(block, (2 * t * rows + 2 * linear + row) * ROW)
                            y = at(x, rows * ROW)
                            bx = at(b_n, (2 * (s - linear) * parameters + row) * ROW)
                            by = at(bx, parameters * ROW)
                            for i in range(0, count, WIDTH):
                                x[i] += ca * value[i] * bx[i]
                                y[i] += ca * value[i] * by[i]
                    else:
                        for column in range(parameters):
                            for row in range(parameters):
                                to = at(block, ((2 * linear + column) * rows + 2 * linear + row) * ROW)
                                bx = at(b_n, (2 * (s - linear) * parameters + row) * ROW)
                                by = at(bx, parameters * ROW)
                                cx = at(c_m, (2 * (t - linear) * parameters + column) * ROW)
                                cy = at(cx, parameters * ROW)
                                for i in range(0, count, WIDTH):
                                    to[i] += value[i] * (bx[i] * cx[i] + by[i] * cy[i])
