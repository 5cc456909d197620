"""Element matrices of a batch, from second derivatives at quadrature points to assembly into the model's matrix."""

from beamfem.kernels import record as r
from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.point import HESSIAN
from beamfem.kernels.pointers import at, caller, reals, slots, wholes
from beamfem.kernels.record import ROW

_columns, _combine, _products = caller("iiidrrrrr"), caller("iiiirrr"), caller("iiiiiiiiiirrrrrrr", "i")
_store, _mirror, _clear = caller("iiiiiirrr"), caller("iir"), caller("iir")
_add_scaled, _add_mass = caller("iidrr"), caller("iiiiiidrrrr")
_reduce, _add_to_band, _add_to_sparse = caller("iiiiiirrr"), caller("iiiiinirr"), caller("iiiinsrr")


@routine("iiirri")
def form_matrices(group, system, count, x, nodal, stride):
    """Fill the reduced matrices B^T (ck K B + M C) of a batch of elements.

    C = ca B + ck de''/dp + cv de''/dp'; ck, cv, ca: weights of the derivatives with respect to p, p' and p''; x:
    workspace; nodal: rows of the first nodes, those of the next ones `stride` numbers on.
    """
    b, s = wholes(group), wholes(system)
    call, factors = wholes(b[r.ROUTINES]), reals(s[r.FACTORS])
    nodes, vectors, dependent, parameters, gathered = (
        b[r.NODES_PER_ELEMENT],
        b[r.VECTORS],
        b[r.DEPENDENT],
        b[r.PARAMETERS],
        b[r.CURVATURE],
    )
    points, bends, coordinates = b[r.POINTS], b[r.BENDS], b[r.COORDINATES]
    size, slots_, rows = 2 * vectors, nodes * vectors, nodes * coordinates
    _, _, _, _, t, q, h, z, pair, k, _ = rows_of(nodes, vectors, points, gathered, b[r.TABLE_ROWS])
    if points == 1:
        h = q + HESSIAN
    t, h, z, pair, k = (
        at(x, t * ROW),
        at(x, h * ROW),
        at(x, z * ROW),
        at(x, pair * ROW),
        at(x, k * ROW),
    )
    ck, linear = factors[r.WEIGHT_P], size - dependent
    if b[r.DAMPED] != 0 and s[r.RATED] != 0:  # `linear_law.add_viscous` has applied ck and cv at the points
        ck = 1.0 if ck != 0.0 or factors[r.WEIGHT_V] != 0.0 else 0.0
    transform, director = at(nodal, b[r.TRANSFORM] * ROW), reals(b[r.DIRECTOR])
    if ck != 0.0:
        for m in range(nodes):
            for point in range(points):
                slope = at(t, (b[r.SLOPE] + point * slots_ + m * vectors) * ROW)
                second = at(t, (b[r.SECOND] + (point * slots_ + m * vectors) * bends) * ROW)
                to = at(z, 6 * point * size * ROW)
                _columns(
                    call[r.COLUMNS],
                    vectors,
                    bends,
                    count,
                    ck,
                    slope,
                    second,
                    at(director, point * nodes + m),
                    at(h, 21 * point * ROW),
                    to,
                )
                if dependent != 0:
                    b_node = at(transform, m * stride)
                    _combine(call[r.COMBINE], 6, dependent, parameters, count, b_node, at(to, 6 * linear * ROW), x)
            for n in range(m + 1):
                slope = at(t, (b[r.SLOPE] + n * vectors) * ROW)
                second = at(t, (b[r.SECOND] + n * vectors * bends) * ROW)
                b_node, to = at(transform, n * stride), at(k, (rows * m + n) * coordinates * ROW)
                done = _products(
                    call[r.PRODUCTS],
                    vectors,
                    bends,
                    count,
                    points,
                    coordinates,
                    slots_,
                    6 * size,
                    dependent,
                    parameters,
                    rows,
                    slope,
                    second,
                    at(director, n),
                    b_node,
                    z,
                    pair,
                    to,
                )
                if done == 0:
                    _store(call[r.STORE], size, dependent, parameters, coordinates, count, rows, b_node, pair, to)
        _mirror(call[r.MIRROR], rows, count, k)
    else:
        _clear(call[r.CLEAR], rows * rows, count, k)
    if s[r.MOVING] != 0:
        convective = at(nodal, b[r.CONVECTIVE] * ROW)  # a copy
        if dependent != 0:
            for n in range(nodes):
                to = at(convective, n * gathered * ROW)
                _add_scaled(
                    call[r.ADD_SCALED],
                    dependent * parameters,
                    count,
                    factors[r.WEIGHT_A],
                    at(transform, n * gathered * ROW),
                    to,
                )
        _add_mass(
            call[r.ADD_MASS],
            nodes,
            vectors,
            dependent,
            parameters,
            count,
            gathered,
            factors[r.WEIGHT_A],
            at(t, b[r.MASS] * ROW),
            transform,
            convective,
            k,
        )


@routine("iiiir")
def add_matrices(group, system, first, count, k):
    """Add the reduced matrices k of a batch of elements to the matrix of the model."""
    b, s = wholes(group), wholes(system)
    call, nodes, coordinates, half = (
        wholes(b[r.ROUTINES]),
        b[r.NODES_PER_ELEMENT],
        b[r.COORDINATES],
        b[r.HALF_WIDTH],
    )
    matrix = reals(s[r.MATRIX])
    if half >= 0:
        number = at(wholes(b[r.NUMBER]), first)
        _add_to_band(
            call[r.ADD_TO_BAND],
            nodes,
            coordinates,
            coordinates,
            count,
            b[r.ELEMENTS],
            number,
            half,
            k,
            matrix,
        )
    else:
        elements = at(wholes(b[r.COUNTED]), first)
        _add_to_sparse(
            call[r.ADD_TO_SPARSE], nodes, coordinates, coordinates, count, elements, slots(b[r.SLOT]), k, matrix
        )


@routine("iiiir")
def reduce_and_add(group, system, first, count, x):
    """Reduce the matrices (columns, rows, ROW) of a batch of loads in its workspace x, and add them to the model's."""
    b, s = wholes(group), wholes(system)
    call = wholes(b[r.ROUTINES])
    nodes, vectors, dependent, parameters, gathered = (
        b[r.NODES_PER_ELEMENT],
        b[r.VECTORS],
        b[r.DEPENDENT],
        b[r.PARAMETERS],
        b[r.CURVATURE],
    )
    size, coordinates, half = 2 * vectors, b[r.COORDINATES], b[r.HALF_WIDTH]
    matrix = reals(s[r.MATRIX])
    _, e, _, _, _, _, _, _, _, k, _ = rows_of(nodes, vectors, b[r.POINTS], gathered, b[r.TABLE_ROWS])
    transform, k = at(x, (e + b[r.TRANSFORM]) * ROW), at(x, k * ROW)
    if dependent != 0:
        _reduce(call[r.REDUCE_COLUMNS], nodes, size, dependent, parameters, count, gathered, transform, k, x)
        _reduce(call[r.REDUCE_ROWS], nodes, size, dependent, parameters, count, gathered, transform, k, x)
    if half >= 0:
        number = at(wholes(b[r.LOAD_NUMBER]), first)
        _add_to_band(call[r.ADD_TO_BAND], nodes, size, coordinates, count, b[r.LOADS], number, half, k, matrix)
    else:
        elements = at(wholes(b[r.LOAD_ELEMENT]), first)
        _add_to_sparse(call[r.ADD_TO_SPARSE], nodes, size, coordinates, count, elements, slots(b[r.SLOT]), k, matrix)
