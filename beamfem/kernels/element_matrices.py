"""Element matrices of a batch: from second derivatives at points to their places in the matrix of the model."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at, caller, reals, slots, wholes
from beamfem.kernels.record import (
    ADD_MASS, ADD_SCALED, ADD_TO_BAND, ADD_TO_SPARSE, BENDS, CLEAR, COLUMNS, COMBINE, CONVECTIVE, COORDINATES, COUNTED, CURVATURE,
    DIRECTOR, ELEMENTS, FACTORS, HALF_WIDTH, LOAD_ELEMENT, LOAD_NUMBER, LOADS, MASS, MATRIX, MIRROR, NODES_PER_ELEMENT, NUMBER, POINTS,
    PRODUCTS, REDUCE_COLUMNS, REDUCE_ROWS, ROUTINES, ROW, SECOND, SLOPE, SLOT, STORE, TABLE_ROWS, TRANSFORM, TURNED, TURNING,
    VECTORS,
)  # fmt: skip

_columns, _combine, _products = caller("iiidrrrrr"), caller("iiiirrr"), caller("iiiiiiirrrrr")
_store, _mirror, _clear = caller("iiiiiirrr"), caller("iir"), caller("iir")
_add_scaled, _add_mass = caller("iidrr"), caller("iiiiiidrrrr")
_reduce, _add_to_band, _add_to_sparse = caller("iiiiiirrr"), caller("iiiiinirr"), caller("iiiinsrr")


@routine("iiir")
def form_matrices(group, system, count, x):
    """Fill the reduced matrices B^T (ck K B + M C) of a batch of elements; x: its work space."""
    b, s = wholes(group), wholes(system)
    call, factors = wholes(b[ROUTINES]), reals(s[FACTORS])
    nodes, vectors, turned, turning, gathered = b[NODES_PER_ELEMENT], b[VECTORS], b[TURNED], b[TURNING], b[CURVATURE]
    points, bends, coordinates = b[POINTS], b[BENDS], b[COORDINATES]
    size, slots_, rows = 2 * vectors, nodes * vectors, nodes * coordinates
    _, e, _, _, t, _, h, z, own, k, _ = rows_of(nodes, vectors, points, gathered, b[TABLE_ROWS])
    e, t, h, z, own, k = at(x, e * ROW), at(x, t * ROW), at(x, h * ROW), at(x, z * ROW), at(x, own * ROW), at(x, k * ROW)
    ck, linear = factors[0], size - turned
    transform, director = at(e, b[TRANSFORM] * ROW), reals(b[DIRECTOR])
    if ck != 0.0:
        for m in range(nodes):
            for point in range(points):
                slope = at(t, (b[SLOPE] + point * slots_ + m * vectors) * ROW)
                second = at(t, (b[SECOND] + (point * slots_ + m * vectors) * bends) * ROW)
                to = at(z, 6 * point * size * ROW)
                _columns(
                    call[COLUMNS], vectors, bends, count, ck, slope, second, at(director, point * nodes + m),
                    at(h, 21 * point * ROW), to,
                )  # fmt: skip
                if turned != 0:
                    turn = at(transform, m * gathered * ROW)
                    _combine(call[COMBINE], 6, turned, turning, count, turn, at(to, 6 * linear * ROW), x)
            for n in range(m + 1):
                slope = at(t, (b[SLOPE] + n * vectors) * ROW)
                second = at(t, (b[SECOND] + n * vectors * bends) * ROW)
                _products(
                    call[PRODUCTS], vectors, bends, count, points, coordinates, slots_, 6 * size, slope, second,
                    at(director, n), z, own,
                )  # fmt: skip
                to = at(k, (rows * m + n) * coordinates * ROW)
                _store(call[STORE], size, turned, turning, coordinates, count, rows, at(transform, n * gathered * ROW), own, to)
        _mirror(call[MIRROR], rows, count, k)
    else:
        _clear(call[CLEAR], rows * rows, count, k)
    if factors[2] != 0.0:
        convective = at(e, b[CONVECTIVE] * ROW)
        if turned != 0:
            for n in range(nodes):
                to = at(convective, n * gathered * ROW)
                _add_scaled(call[ADD_SCALED], turned * turning, count, factors[2], at(transform, n * gathered * ROW), to)
        _add_mass(
            call[ADD_MASS], nodes, vectors, turned, turning, count, gathered, factors[2], at(t, b[MASS] * ROW), transform,
            convective, k,
        )  # fmt: skip


@routine("iiiir")
def add_matrices(group, system, first, count, k):
    """Add the reduced matrices k of a batch of elements to that of the model."""
    b, s = wholes(group), wholes(system)
    call, nodes, coordinates, half = wholes(b[ROUTINES]), b[NODES_PER_ELEMENT], b[COORDINATES], b[HALF_WIDTH]
    matrix = reals(s[MATRIX])
    if half >= 0:
        number = at(wholes(b[NUMBER]), first)
        _add_to_band(call[ADD_TO_BAND], nodes, coordinates, coordinates, count, b[ELEMENTS], number, half, k, matrix)
    else:
        own = at(wholes(b[COUNTED]), first)
        _add_to_sparse(call[ADD_TO_SPARSE], nodes, coordinates, coordinates, count, own, slots(b[SLOT]), k, matrix)


@routine("iiiir")
def reduce_and_add(group, system, first, count, x):
    """Reduce the matrices of a batch of loads (columns, rows, ROW) in its work space x, and add them to the model's."""
    b, s = wholes(group), wholes(system)
    call = wholes(b[ROUTINES])
    nodes, vectors, turned, turning, gathered = b[NODES_PER_ELEMENT], b[VECTORS], b[TURNED], b[TURNING], b[CURVATURE]
    size, coordinates, half, matrix = 2 * vectors, b[COORDINATES], b[HALF_WIDTH], reals(s[MATRIX])
    _, e, _, _, _, _, _, _, _, k, _ = rows_of(nodes, vectors, b[POINTS], gathered, b[TABLE_ROWS])
    transform, k = at(x, (e + b[TRANSFORM]) * ROW), at(x, k * ROW)
    if turned != 0:
        _reduce(call[REDUCE_COLUMNS], nodes, size, turned, turning, count, gathered, transform, k, x)
        _reduce(call[REDUCE_ROWS], nodes, size, turned, turning, count, gathered, transform, k, x)
    if half >= 0:
        number = at(wholes(b[LOAD_NUMBER]), first)
        _add_to_band(call[ADD_TO_BAND], nodes, size, coordinates, count, b[LOADS], number, half, k, matrix)
    else:
        own = at(wholes(b[LOAD_ELEMENT]), first)
        _add_to_sparse(call[ADD_TO_SPARSE], nodes, size, coordinates, count, own, slots(b[SLOT]), k, matrix)
