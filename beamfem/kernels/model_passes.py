"""Residual and tangent of a whole model, and prediction of the resultants after a step."""

from beamfem.kernels import record as r
from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.point import RATE, RESULTANT, STRAIN
from beamfem.kernels.pointers import at, caller, reals, small_code, wholes
from beamfem.kernels.record import LANES, ROW

_two, _three, _collect = caller("ii"), caller("iii"), caller("iiiiii", "i")
_interpolate, _measure, _law = caller("iiiiirrrrr"), caller("ir"), caller("iiiiiirrrr")
_node_rates, _release = caller("iiiiiinrrr"), caller("iiiiirr")


@inlined
def clear(s):
    """Set the residual and, if the tangent is needed, the entries of the matrix to zero."""
    residual, matrix = reals(s[r.RESIDUAL]), reals(s[r.MATRIX])
    for i in range(s[r.SIZE]):
        residual[i] = 0.0
    if s[r.TANGENT] != 0:
        for i in range(s[r.ENTRIES]):
            matrix[i] = 0.0


@inlined
def add_group(s, system, number):
    """Add the forces of a group to the residual and, if needed, its tangent to the matrix."""
    group, values = wholes(s[r.GROUP_RECORDS])[number], wholes(s[r.VALUES])
    b = wholes(group)
    call = wholes(b[r.ROUTINES])
    _three(call[r.PLACE_NODES], group, system, s[r.MOVING])
    _two(call[r.ADD_ELEMENTS], group, system)
    if b[r.LOADS] > 0:
        _three(call[r.ADD_LOADS], group, system, values[number])
    _two(call[r.FINISH_NODES], group, system)


@inlined
def add_springs(s):
    """Add the forces of springs to the ground to the residual and, if needed, their stiffness to the matrix."""
    p, dof, factor = reals(s[r.COORDINATES_P]), wholes(s[r.SPRING_DOF]), reals(s[r.FACTORS])[r.WEIGHT_P]
    residual, matrix, stiffness, rest, place = (
        reals(s[r.RESIDUAL]),
        reals(s[r.MATRIX]),
        reals(s[r.SPRING_STIFFNESS]),
        reals(s[r.SPRING_REST]),
        wholes(s[r.SPRING_PLACE]),
    )
    for i in range(s[r.SPRINGS]):
        residual[dof[i]] += stiffness[i] * (p[dof[i]] - rest[i])
        if s[r.TANGENT] != 0 and place[i] >= 0:
            matrix[place[i]] += factor * stiffness[i]


@inlined
def add_parts_at_points(s, system):
    """Add the forces of masses, springs and the like, see `connection_passes`, and their tangents."""
    if s[r.CONNECTIONS] > 0:
        _three(s[r.ADD_CONNECTIONS], s[r.CONNECTIONS], s[r.CONNECTION_TABLES], system)


@routine("i")
def balance(system):
    """Fill the residual (n,) and, if the tangent is needed, the matrix of a model."""
    small_code()
    s = wholes(system)
    clear(s)
    for group in range(s[r.GROUPS]):
        add_group(s, system, group)
    add_springs(s)
    add_parts_at_points(s, system)


@routine("iiiiiinrrr", fastmath={"contract", "reassoc", "nsz"})
def add_node_rates(first, count, linear, dependent, parameters, stride, dof, step, transform, rates):
    """Fill rates (linear + dependent, ROW) of nodal vectors: those of coordinates, then b times those of the last ones.

    step (n,): rates p'; transform (dependent, parameters, ROW): b, see `reduction`; dof (coordinates, stride).
    """
    for row in range(linear):
        dofs, to = at(dof, row * stride + first), at(rates, row * ROW)
        for i in range(count):
            to[i] = step[dofs[i]]
    for part in range(dependent):
        to = at(rates, (linear + part) * ROW)
        for i in range(count):
            to[i] = 0.0
        for column in range(parameters):
            dofs, factor = (
                at(dof, (linear + column) * stride + first),
                at(transform, (part * parameters + column) * ROW),
            )
            for i in range(count):
                if dofs[i] >= 0:
                    to[i] += factor[i] * step[dofs[i]]


@routine("iii")
def rate_nodes(group, system, row):
    """Fill e' = B p' of all nodes of a group into the rows of its chunks from `row` on; p': `COORDINATES_V`."""
    b, s = wholes(group), wholes(system)
    call, chunks, first = wholes(b[r.ROUTINES]), reals(b[r.CHUNKS]), 0
    while first < b[r.NODES]:
        count, chunk = min(LANES, b[r.NODES] - first), at(chunks, first // LANES * b[r.NODE_ROWS] * ROW)
        _node_rates(
            call[r.NODE_RATES],
            first,
            count,
            2 * b[r.VECTORS] - b[r.DEPENDENT],
            b[r.DEPENDENT],
            b[r.PARAMETERS],
            b[r.NODES],
            wholes(b[r.DOF]),
            reals(s[r.COORDINATES_V]),
            at(chunk, b[r.TRANSFORM] * ROW),
            at(chunk, row * ROW),
        )
        first += count


@routine("iii")
def predict_resultants(group, system, placed):
    """Fill `STRESS` with the resultants at the strains eps + (d eps / de) B dp, minus imposed strains, after a step dp.

    eps and B are those at p, and `COORDINATES_V` holds dp instead of p'. They are the independent stresses of Magisano,
    Leonetti and Garcea 2017 for the geometric part of the tangent. If strain rates matter, `COORDINATES_A` holds p'
    instead of p'', and t C (d eps / de) B (p' + cv dp) is added, with the retardation time t. placed: whether the nodes
    were placed at p by the residual or tangent before.
    """
    b = wholes(group)
    call, x, director = wholes(b[r.ROUTINES]), reals(b[r.SPACE]), reals(b[r.DIRECTOR])
    nodes, vectors, bends, elements, measures = (
        b[r.NODES_PER_ELEMENT],
        b[r.VECTORS],
        b[r.BENDS],
        b[r.ELEMENTS],
        b[r.MEASURES],
    )
    s, size, slots, stress = wholes(system), 2 * vectors, nodes * vectors, reals(b[r.STRESS])
    damped = b[r.DAMPED] != 0 and s[r.RATED] != 0
    cv = reals(s[r.FACTORS])[r.WEIGHT_V] if damped else 0.0
    rows = b[r.CURVATURE] if damped else 2 * size
    if placed == 0:
        _three(call[r.PLACE_NODES], group, system, 0)
    _three(call[r.RATE_NODES], group, system, b[r.ACCELERATION])
    if damped:
        step = s[r.COORDINATES_V]
        s[r.COORDINATES_V] = s[r.COORDINATES_A]
        _three(call[r.RATE_NODES], group, system, b[r.VELOCITY])
        s[r.COORDINATES_V] = step
    _, e, _, _, tables, q, unit, _, _, _, _ = rows_of(nodes, vectors, b[r.POINTS], b[r.CURVATURE], b[r.TABLE_ROWS])
    e, t, q, unit = at(x, e * ROW), at(x, tables * ROW), at(x, q * ROW), at(x, unit * ROW)
    pairs, chunks, place = measures * (measures + 1) // 2, reals(b[r.CHUNKS]), wholes(b[r.PLACE])
    first = 0
    while first < elements:
        count = min(b[r.BATCH], elements - first)
        for i in range(count):
            unit[i] = 1.0
        apart = _collect(call[r.COLLECT], group, 0, first, count, rows, 0)
        nodal = e if apart == 0 else at(chunks, place[first])
        stride = rows * ROW if apart == 0 else apart
        for number in range(b[r.POINTS]):
            slope, factor = at(t, (b[r.SLOPE] + number * slots) * ROW), at(director, number * nodes)
            second = at(t, (b[r.SECOND] + number * slots * bends) * ROW)
            rate, time = at(q, RATE * ROW), at(t, b[r.DAMPING] * ROW)
            _interpolate(call[r.INTERPOLATE], nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
            _measure(call[r.STRAINS], count, q)
            change = at(nodal, b[r.ACCELERATION] * ROW)
            _interpolate(call[r.INTERPOLATE], nodes, vectors, bends, count, stride, slope, second, factor, change, rate)
            _measure(call[r.RATES], count, q)
            for row in range(measures):
                strain, rate_row = at(q, (STRAIN + row) * ROW), at(rate, row * ROW)
                for i in range(count):
                    strain[i] += rate_row[i]
                if damped:
                    for i in range(count):
                        strain[i] += time[i] * cv * rate_row[i]
            if damped:
                moving = at(nodal, b[r.VELOCITY] * ROW)
                _interpolate(
                    call[r.INTERPOLATE], nodes, vectors, bends, count, stride, slope, second, factor, moving, rate
                )
                _measure(call[r.RATES], count, q)
                for row in range(measures):
                    strain, rate_row = at(q, (STRAIN + row) * ROW), at(rate, row * ROW)
                    for i in range(count):
                        strain[i] += time[i] * rate_row[i]
            if b[r.NATURAL] != 0:
                _release(call[r.RELEASE], first, count, b[r.POINTS], number, measures, reals(b[r.NATURAL]), q)
            _law(
                call[r.LAW],
                group,
                system,
                first,
                number,
                count,
                0,
                unit,
                at(t, (b[r.STIFFNESS] + number * pairs) * ROW),
                at(t, (b[r.REFERENCE] + number * measures) * ROW),
                q,
            )
            for i in range(count):
                to = at(stress, ((first + i) * b[r.POINTS] + number) * measures)
                for row in range(measures):
                    to[row] = q[(RESULTANT + row) * ROW + i]
        first += count


@routine("i", "d")
def smallest_jacobian(group):
    """Return the smallest r0' x d of all quadrature points, at most 1; it is negative where an element is inverted.

    The nodal vectors are taken from the chunks.
    """
    b = wholes(group)
    call, x, director = wholes(b[r.ROUTINES]), reals(b[r.SPACE]), reals(b[r.DIRECTOR])
    nodes, vectors, bends, elements = (
        b[r.NODES_PER_ELEMENT],
        b[r.VECTORS],
        b[r.BENDS],
        b[r.ELEMENTS],
    )
    size, slots = 2 * vectors, nodes * vectors
    _, e, _, _, tables, q, _, _, _, _, _ = rows_of(nodes, vectors, b[r.POINTS], b[r.CURVATURE], b[r.TABLE_ROWS])
    e, t, q = at(x, e * ROW), at(x, tables * ROW), at(x, q * ROW)
    chunks, place = reals(b[r.CHUNKS]), wholes(b[r.PLACE])
    smallest, first = 1.0, 0
    while first < elements:
        count = min(b[r.BATCH], elements - first)
        apart = _collect(call[r.COLLECT], group, 0, first, count, size, 0)
        nodal = e if apart == 0 else at(chunks, place[first])
        stride = size * ROW if apart == 0 else apart
        for number in range(b[r.POINTS]):
            slope, factor = at(t, (b[r.SLOPE] + number * slots) * ROW), at(director, number * nodes)
            second = at(t, (b[r.SECOND] + number * slots * bends) * ROW)
            _interpolate(call[r.INTERPOLATE], nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
            for i in range(count):
                smallest = min(smallest, q[i] * q[3 * ROW + i] - q[ROW + i] * q[2 * ROW + i])
        first += count
    return smallest
