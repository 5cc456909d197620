"""Layout of the workspace of a batch, in rows: the offset of each part follows from the sizes of the group."""

from beamfem.kernels.compiling import inlined
from beamfem.kernels.point import POINT_ROWS

BODY_ROWS = 4
SPARE_ROWS = 40  # scratch for the coordinates and vectors of nodes, and for reductions


@inlined
def rows_of(nodes, vectors, points, gathered, table_rows):
    """Return the first row of each of the ten parts of the workspace, and the total number of rows.

    The parts are body forces, nodal vectors, forces, predicted forces, tables, one quadrature point, second derivatives
    at all points, columns of a node at all points, rows of a pair of nodes, and the element matrix.
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
    pair = z + 6 * size * points
    k = pair + size * size
    return body, e, f, g, t, x, h, z, pair, k, k + 4 * slots * slots
