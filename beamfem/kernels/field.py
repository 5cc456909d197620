"""The beam axis at a quadrature point: q = (r0', d, third), third being d', or r0'' for the elastic line; in batches.

Tables have a row of lanes each: elements of a batch may all be different.
"""

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at
from beamfem.kernels.record import ROW

FAST = {"contract", "reassoc", "nsz"}


@routine("iiiiirrrrr", fastmath=FAST)
def interpolate(nodes, vectors, bends, count, stride, slope, second, director, e, q):
    """Fill q (6, ROW) from nodal vectors e (nodes, stride, ROW).

    slope, second (nodes * vectors, ROW): derivatives of shape functions; director (nodes,): those of d.
    """
    last = vectors - 1
    for n in range(nodes):
        own = at(e, n * stride * ROW)
        x, y = at(own, 2 * last * ROW), at(own, (2 * last + 1) * ROW)
        factor, table = director[n], at(slope, (n * vectors + last) * ROW)
        if n == 0:
            for i in range(count):
                q[2 * ROW + i] = factor * x[i]
                q[3 * ROW + i] = factor * y[i]
            if bends != 0:
                for i in range(count):
                    q[4 * ROW + i] = 0.0
                    q[5 * ROW + i] = 0.0
            else:
                for i in range(count):
                    q[4 * ROW + i] = table[i] * x[i]
                    q[5 * ROW + i] = table[i] * y[i]
        else:
            for i in range(count):
                q[2 * ROW + i] += factor * x[i]
                q[3 * ROW + i] += factor * y[i]
            if bends == 0:
                for i in range(count):
                    q[4 * ROW + i] += table[i] * x[i]
                    q[5 * ROW + i] += table[i] * y[i]
    for n in range(nodes):
        for s in range(last):
            own = at(e, (n * stride + 2 * s) * ROW)
            table, curved = at(slope, (n * vectors + s) * ROW), at(second, (n * vectors + s) * ROW)
            if n == 0 and s == 0:
                for i in range(count):
                    q[i] = table[i] * own[i]
                    q[ROW + i] = table[i] * own[ROW + i]
            else:
                for i in range(count):
                    q[i] += table[i] * own[i]
                    q[ROW + i] += table[i] * own[ROW + i]
            if bends != 0:
                for i in range(count):
                    q[4 * ROW + i] += curved[i] * own[i]
                    q[5 * ROW + i] += curved[i] * own[ROW + i]


@routine("iiiirrrrr", fastmath=FAST)
def spread(nodes, vectors, bends, count, slope, second, director, q, f):
    """Add what forces on q (6, ROW) give to those of the nodes f (nodes, 2 vectors, ROW)."""
    last = vectors - 1
    for n in range(nodes):
        for s in range(last):
            own = at(f, 2 * (n * vectors + s) * ROW)
            table, curved = at(slope, (n * vectors + s) * ROW), at(second, (n * vectors + s) * ROW)
            for i in range(count):
                own[i] += table[i] * q[i]
                own[ROW + i] += table[i] * q[ROW + i]
            if bends != 0:
                for i in range(count):
                    own[i] += curved[i] * q[4 * ROW + i]
                    own[ROW + i] += curved[i] * q[5 * ROW + i]
        own = at(f, 2 * (n * vectors + last) * ROW)
        factor, table = director[n], at(slope, (n * vectors + last) * ROW)
        if bends != 0:
            for i in range(count):
                own[i] += factor * q[2 * ROW + i]
                own[ROW + i] += factor * q[3 * ROW + i]
        else:
            for i in range(count):
                own[i] += factor * q[2 * ROW + i] + table[i] * q[4 * ROW + i]
                own[ROW + i] += factor * q[3 * ROW + i] + table[i] * q[5 * ROW + i]
