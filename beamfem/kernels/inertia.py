"""Inertia and body forces of a batch, and what inertia adds to its matrices; a row of lanes for each table entry."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at
from beamfem.kernels.record import ROW

FAST = {"contract", "reassoc", "nsz"}


@routine("iiiiiiirrrrrr", fastmath=FAST)
def add_inertia(nodes, vectors, count, stride, loaded, moving, apart, mass, gravity, length, body, e, f):
    """Fill f (nodes, 2 vectors, ROW) with M e'' less body forces; e (nodes, stride, ROW), e'' behind e.

    apart: the mass of d has no entries with that of r0, as in every section that is as heavy above as below the axis.
    """
    slots, last = nodes * vectors, vectors - 1
    for slot in range(slots):
        x, y = at(f, 2 * slot * ROW), at(f, (2 * slot + 1) * ROW)
        if loaded != 0:
            m, own = at(gravity, slot * ROW), at(length, slot * ROW)
            for i in range(count):
                x[i] = -body[i] * m[i] - body[2 * ROW + i] * own[i]
                y[i] = -body[ROW + i] * m[i] - body[3 * ROW + i] * own[i]
        else:
            for i in range(count):
                x[i] = 0.0
                y[i] = 0.0
    if moving == 0:
        return
    for own_node in range(nodes):
        for own_vector in range(vectors):
            slot = own_node * vectors + own_vector
            x, y = at(f, 2 * slot * ROW), at(f, (2 * slot + 1) * ROW)
            begin = last if apart != 0 and own_vector == last else 0
            end = last if apart != 0 and own_vector < last else vectors
            for n in range(nodes):
                for s in range(begin, end):
                    m = at(mass, (slot * slots + n * vectors + s) * ROW)
                    own = at(e, (n * stride + 2 * vectors + 2 * s) * ROW)
                    for i in range(count):
                        x[i] += m[i] * own[i]
                        y[i] += m[i] * own[ROW + i]


@routine("iidrr", fastmath=FAST)
def add_scaled(rows, count, factor, source, to):
    """Add rows times a factor to others."""
    for row in range(rows):
        own, its = at(source, row * ROW), at(to, row * ROW)
        for i in range(count):
            its[i] += factor * own[i]


@routine("iiiiiidrrrr", fastmath=FAST)
def add_mass(nodes, vectors, turned, turning, count, stride, ca, mass, b, c, k):
    """Add B^T M C to reduced matrices k; b, c (nodes, stride, ROW): of the vectors that turn, C = ca B + what turns.

    Vectors that are coordinates themselves have B = 1, C = ca.
    """
    linear = vectors - turned // 2
    coordinates = 2 * linear + turning
    rows, slots = nodes * coordinates, nodes * vectors
    for m in range(nodes):
        for n in range(nodes):
            block = at(k, (rows * m * coordinates + n * coordinates) * ROW)
            own, its = at(b, n * stride * ROW), at(c, m * stride * ROW)
            for t in range(vectors):
                for s in range(vectors):
                    value = at(mass, ((n * vectors + s) * slots + m * vectors + t) * ROW)
                    if s < linear and t < linear:
                        x = at(block, (2 * t * rows + 2 * s) * ROW)
                        y = at(block, ((2 * t + 1) * rows + 2 * s + 1) * ROW)
                        for i in range(count):
                            x[i] += ca * value[i]
                            y[i] += ca * value[i]
                    elif s < linear:
                        for column in range(turning):
                            x = at(block, ((2 * linear + column) * rows + 2 * s) * ROW)
                            cx = at(its, (2 * (t - linear) * turning + column) * ROW)
                            cy = at(cx, turning * ROW)
                            for i in range(count):
                                x[i] += value[i] * cx[i]
                                x[ROW + i] += value[i] * cy[i]
                    elif t < linear:
                        for row in range(turning):
                            x = at(block, (2 * t * rows + 2 * linear + row) * ROW)
                            y = at(x, rows * ROW)
                            bx = at(own, (2 * (s - linear) * turning + row) * ROW)
                            by = at(bx, turning * ROW)
                            for i in range(count):
                                x[i] += ca * value[i] * bx[i]
                                y[i] += ca * value[i] * by[i]
                    else:
                        for column in range(turning):
                            for row in range(turning):
                                to = at(block, ((2 * linear + column) * rows + 2 * linear + row) * ROW)
                                bx = at(own, (2 * (s - linear) * turning + row) * ROW)
                                by = at(bx, turning * ROW)
                                cx = at(its, (2 * (t - linear) * turning + column) * ROW)
                                cy = at(cx, turning * ROW)
                                for i in range(count):
                                    to[i] += value[i] * (bx[i] * cx[i] + by[i] * cy[i])
