"""Rows of the work space of a batch, one after the other: where each begins is counted from the sizes of a group."""

from beamfem.kernels.compiling import inlined
from beamfem.kernels.point import POINT_ROWS

BODY_ROWS = 4
SPARE_ROWS = 40  # for a node's coordinates and what comes of them, and for reductions


@inlined
def rows_of(nodes, vectors, points, gathered, table_rows):
    """Return the first rows of each part of the work space, and their end.

    Body, nodal vectors, forces, predicted forces, tables, a point, second derivatives of all points, columns of a node
    at all points, rows of a pair of nodes, matrix.
    """
    size, slots = 2 * vectors, nodes * vectors
    body = SPARE_ROWS
    e = body + BODY_ROWS
    f = e + nodes * gathered
    g = f + nodes * size
    t = g + nodes * size
    x = t + table_rows
    h = x + POINT_ROWS
    z = h + 21 * points
    own = z + 6 * size * points
    k = own + size * size
    return body, e, f, g, t, x, h, z, own, k, k + 4 * slots * slots
