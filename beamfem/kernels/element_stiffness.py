"""Elastic matrices of a batch: B^T (sum of T^T h T over quadrature points) B with q = T e, q = (r0', d, third).

h has 21 rows for each point: the blocks rr (xx, xy, yy), rd, rt (xx, xy, yx, yy each), dd (xx, xy, yy), dt (xx, xy, yx,
yy) and tt (xx, xy, yy). A matrix (columns, rows, ROW) has a row of lanes for each entry.
"""

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import ROW, Group
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Rows
from beamfem.kernels.simd import WIDTH, zeros


@routine("iiidvvrvv", fastmath=FAST)
def columns(vectors, bends, count, ck, slope, second, director, h, z):
    """Fill z (2 vectors, 6, ROW) with ck h T for the nodal vectors of one node; the six rows are r, d, t (x and y)."""
    last = vectors - 1
    for s in range(last):
        w, u, to = at(slope, s * ROW), at(second, s * ROW), at(z, 12 * s * ROW)
        for i in range(0, count, WIDTH):
            a = ck * w[i]
            to[i], to[ROW + i] = a * h[i], a * h[ROW + i]
            to[2 * ROW + i], to[3 * ROW + i] = a * h[3 * ROW + i], a * h[4 * ROW + i]
            to[4 * ROW + i], to[5 * ROW + i] = a * h[7 * ROW + i], a * h[8 * ROW + i]
            to[6 * ROW + i], to[7 * ROW + i] = a * h[ROW + i], a * h[2 * ROW + i]
            to[8 * ROW + i], to[9 * ROW + i] = a * h[5 * ROW + i], a * h[6 * ROW + i]
            to[10 * ROW + i], to[11 * ROW + i] = a * h[9 * ROW + i], a * h[10 * ROW + i]
        if bends != 0:
            for i in range(0, count, WIDTH):
                b = ck * u[i]
                to[i] += b * h[7 * ROW + i]
                to[ROW + i] += b * h[9 * ROW + i]
                to[2 * ROW + i] += b * h[14 * ROW + i]
                to[3 * ROW + i] += b * h[16 * ROW + i]
                to[4 * ROW + i] += b * h[18 * ROW + i]
                to[5 * ROW + i] += b * h[19 * ROW + i]
                to[6 * ROW + i] += b * h[8 * ROW + i]
                to[7 * ROW + i] += b * h[10 * ROW + i]
                to[8 * ROW + i] += b * h[15 * ROW + i]
                to[9 * ROW + i] += b * h[17 * ROW + i]
                to[10 * ROW + i] += b * h[19 * ROW + i]
                to[11 * ROW + i] += b * h[20 * ROW + i]
    w, to, b = at(slope, last * ROW), at(z, 12 * last * ROW), ck * director[0]
    if bends != 0:
        for i in range(0, count, WIDTH):
            to[i], to[ROW + i] = b * h[3 * ROW + i], b * h[5 * ROW + i]
            to[2 * ROW + i], to[3 * ROW + i] = b * h[11 * ROW + i], b * h[12 * ROW + i]
            to[4 * ROW + i], to[5 * ROW + i] = b * h[14 * ROW + i], b * h[15 * ROW + i]
            to[6 * ROW + i], to[7 * ROW + i] = b * h[4 * ROW + i], b * h[6 * ROW + i]
            to[8 * ROW + i], to[9 * ROW + i] = b * h[12 * ROW + i], b * h[13 * ROW + i]
            to[10 * ROW + i], to[11 * ROW + i] = b * h[16 * ROW + i], b * h[17 * ROW + i]
    else:
        for i in range(0, count, WIDTH):
            a = ck * w[i]
            to[i] = b * h[3 * ROW + i] + a * h[7 * ROW + i]
            to[ROW + i] = b * h[5 * ROW + i] + a * h[9 * ROW + i]
            to[2 * ROW + i] = b * h[11 * ROW + i] + a * h[14 * ROW + i]
            to[3 * ROW + i] = b * h[12 * ROW + i] + a * h[16 * ROW + i]
            to[4 * ROW + i] = b * h[14 * ROW + i] + a * h[18 * ROW + i]
            to[5 * ROW + i] = b * h[15 * ROW + i] + a * h[19 * ROW + i]
            to[6 * ROW + i] = b * h[4 * ROW + i] + a * h[8 * ROW + i]
            to[7 * ROW + i] = b * h[6 * ROW + i] + a * h[10 * ROW + i]
            to[8 * ROW + i] = b * h[12 * ROW + i] + a * h[15 * ROW + i]
            to[9 * ROW + i] = b * h[13 * ROW + i] + a * h[17 * ROW + i]
            to[10 * ROW + i] = b * h[16 * ROW + i] + a * h[19 * ROW + i]
            to[11 * ROW + i] = b * h[17 * ROW + i] + a * h[20 * ROW + i]


@inlined
def multiply(dependent, parameters, count, b, apart, own, to):
    """Fill the rows of `to` (parameters, ROW) with b^T own; own: `dependent` rows, `apart` rows from each other."""
    for column in range(parameters):
        sums = at(to, column * ROW)
        for part in range(0, dependent, 2):
            x, y = at(own, part * apart * ROW), at(own, (part + 1) * apart * ROW)
            c, s = at(b, (part * parameters + column) * ROW), at(b, ((part + 1) * parameters + column) * ROW)
            if part == 0:
                for i in range(0, count, WIDTH):
                    sums[i] = x[i] * c[i] + y[i] * s[i]
            else:
                for i in range(0, count, WIDTH):
                    sums[i] += x[i] * c[i] + y[i] * s[i]


@routine("iiiivvv", fastmath=FAST)
def combine(rows, dependent, parameters, count, b, own, space):
    """Replace the `dependent` columns of own (columns, rows, ROW) by the `parameters` columns own b.

    b (dependent, parameters, ROW); space (parameters, ROW): workspace.
    """
    for row in range(rows):
        if dependent == 2 and parameters == 1:
            x, y, sine = at(own, row * ROW), at(own, (rows + row) * ROW), at(b, ROW)
            for i in range(0, count, WIDTH):
                x[i] = x[i] * b[i] + y[i] * sine[i]
            continue
        multiply(dependent, parameters, count, b, rows, at(own, row * ROW), space)
        for column in range(parameters):
            source, to = at(space, column * ROW), at(own, (rows * column + row) * ROW)
            for i in range(0, count, WIDTH):
                to[i] = source[i]


@routine(fastmath=FAST)
def products(
    vectors: int, bends: int, count: int, group: Group, n: int, t: Rows, b: Rows, z: Rows, own: Rows, k: Rows
) -> int:
    """Fill the rows of node n of an element in the columns of another one: T^T z, summed over quadrature points.

    t: tables with T; z (points, 2 vectors, 6, ROW): 6 rows for each coordinate; b (dependent, parameters, ROW): of this
    node. Return 1 if its rows of k are done, see `store`, or 0 if own (coordinates, 2 vectors, ROW) has them before
    their multiplication by b^T.
    """
    nodes, points, coordinates, dependent = group.nodes_per_element, group.points, group.coordinates, group.dependent
    last, slots, z_stride, director = vectors - 1, nodes * vectors, 12 * vectors, at(group.director, n)
    slope, second = at(t, (group.slope + n * vectors) * ROW), at(t, (group.second + n * vectors * bends) * ROW)
    done = dependent == 0 or (dependent == 2 and group.parameters == 1)
    into, size = own, 2 * vectors
    if done:
        into, size = k, nodes * coordinates
    for c in range(coordinates):
        for s in range(vectors):
            for i in range(0, count, WIDTH):
                x, y = zeros(), zeros()
                for point in range(points):
                    column = at(z, (point * z_stride + 6 * c) * ROW + i)
                    w, u = slope[(point * slots + s) * ROW + i], director[point * nodes]
                    if s < last:
                        x, y = x + w * column[0], y + w * column[ROW]
                        if bends != 0:
                            curved = second[(point * slots + s) * ROW + i]
                            x, y = x + curved * column[4 * ROW], y + curved * column[5 * ROW]
                    else:
                        x, y = x + u * column[2 * ROW], y + u * column[3 * ROW]
                        if bends == 0:
                            x, y = x + w * column[4 * ROW], y + w * column[5 * ROW]
                to = at(into, (c * size + 2 * s) * ROW + i)
                if done and dependent != 0 and s == last:
                    to[0] = x * b[i] + y * b[ROW + i]
                else:
                    to[0], to[ROW] = x, y
    return 1 if done else 0


@routine("iiiiiivvv", fastmath=FAST)
def store(size, dependent, parameters, coordinates, count, rows, b, own, k):
    """Store own (coordinates, size, ROW) in k, with its last `dependent` rows multiplied by the transpose of b.

    own: rows of one node in the columns of another one; b (dependent, parameters, ROW): of the node of the rows; k:
    from the entry of the first coordinates of both nodes on; rows: number of rows of k.
    """
    linear = size - dependent
    for c in range(coordinates):
        for row in range(linear):
            source, to = at(own, (c * size + row) * ROW), at(k, (c * rows + row) * ROW)
            for i in range(0, count, WIDTH):
                to[i] = source[i]
        multiply(
            dependent, parameters, count, b, 1, at(own, (c * size + linear) * ROW), at(k, (c * rows + linear) * ROW)
        )


@routine("iiv")
def mirror(size, count, k):
    """Copy the upper triangle of k (columns, rows, ROW) to the lower one."""
    for column in range(size):
        for row in range(column):
            source, to = at(k, (column * size + row) * ROW), at(k, (row * size + column) * ROW)
            for i in range(0, count, WIDTH):
                to[i] = source[i]
