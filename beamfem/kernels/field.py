"""The fields at a quadrature point of a batch: q = (r0', d, third), where third is d', or r0'' for the elastic line.

Each table entry is a row of lanes, since the elements of a batch may all be different.
"""

from beamfem.kernels.compiling import FAST, routine
from beamfem.kernels.model_record import ROW
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, zeros


@routine("iiiiivvrvv", fastmath=FAST)
def interpolate(nodes, vectors, bends, count, stride, slope, second, director, e, q):
    """Fill q (6, ROW) from the nodal vectors e (2 vectors, ROW) of each node, `stride` numbers apart.

    slope, second (nodes * vectors, ROW): derivatives of shape functions; director (nodes,): shape functions of d;
    bends: whether the third vector is r0''.
    """
    small_code()
    last = vectors - 1
    for i in range(0, count, WIDTH):
        rx, ry, dx, dy, third_x, third_y = zeros(), zeros(), zeros(), zeros(), zeros(), zeros()
        for n in range(nodes):
            nodal, table = at(e, n * stride + i), at(slope, n * vectors * ROW + i)
            curved = at(second, n * vectors * ROW + i)
            for s in range(last):
                x, y, w = nodal[2 * s * ROW], nodal[(2 * s + 1) * ROW], table[s * ROW]
                rx, ry = rx + w * x, ry + w * y
                if bends != 0:
                    u = curved[s * ROW]
                    third_x, third_y = third_x + u * x, third_y + u * y
            x, y, factor = nodal[2 * last * ROW], nodal[(2 * last + 1) * ROW], director[n]
            dx, dy = dx + factor * x, dy + factor * y
            if bends == 0:
                w = table[last * ROW]
                third_x, third_y = third_x + w * x, third_y + w * y
        q[i], q[ROW + i], q[2 * ROW + i], q[3 * ROW + i] = rx, ry, dx, dy
        q[4 * ROW + i], q[5 * ROW + i] = third_x, third_y


@routine("iiiivvrvv", fastmath=FAST)
def distribute(nodes, vectors, bends, count, slope, second, director, q, f):
    """Add the nodal forces that are equivalent to forces on q (6, ROW) to f (nodes, 2 vectors, ROW)."""
    small_code()
    last = vectors - 1
    for i in range(0, count, WIDTH):
        rx, ry, dx, dy = q[i], q[ROW + i], q[2 * ROW + i], q[3 * ROW + i]
        third_x, third_y = q[4 * ROW + i], q[5 * ROW + i]
        for n in range(nodes):
            force, table = at(f, 2 * n * vectors * ROW + i), at(slope, n * vectors * ROW + i)
            curved = at(second, n * vectors * ROW + i)
            for s in range(last):
                w = table[s * ROW]
                x, y = force[2 * s * ROW] + w * rx, force[(2 * s + 1) * ROW] + w * ry
                if bends != 0:
                    u = curved[s * ROW]
                    x, y = x + u * third_x, y + u * third_y
                force[2 * s * ROW], force[(2 * s + 1) * ROW] = x, y
            factor = director[n]
            x, y = force[2 * last * ROW] + factor * dx, force[(2 * last + 1) * ROW] + factor * dy
            if bends == 0:
                w = table[last * ROW]
                x, y = x + w * third_x, y + w * third_y
            force[2 * last * ROW], force[(2 * last + 1) * ROW] = x, y
