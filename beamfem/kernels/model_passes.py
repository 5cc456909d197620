"""Residual and tangent of a whole model, and what a step does to the resultants of its points."""

from numba import types

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.point import AXIS, RATE, RESULTANT, STRAIN
from beamfem.kernels.pointers import at, caller, reals, wholes
from beamfem.kernels.record import (
    ACCELERATION, ADD_ELEMENTS, CLEAR_FORCES, ADD_LOADS, BATCH, BENDS, CHUNKS, CLASS, COORDINATES_V, CURVATURE, DIRECTOR, DOF, ELEMENTS, ENTRIES,
    FACTORS, FILL_TABLES, FINISH_NODES, FORCE, FRAME, GATHER, GROUP_RECORDS, GROUPS, INTERPOLATE, LANES, LAW, LOADS, MATRIX, MEASURES,
    MOVING, NODE_RATES, NODE_ROWS, NODES, NODES_PER_ELEMENT, PLACE, PLACE_NODES, POINTS, PREDICTED, PREDICTED_FORCE, RATES, REFERENCE, RESIDUAL,
    ROTATE, ROUTINES, ROW, RUN_COUNT, RUNS, SECOND, SIZE, SLOPE, SPACE, SPRING_DOF, SPRING_PLACE, SPRING_REST, SPRING_STIFFNESS,
    SPRINGS, STIFFNESS, STRAINS, STRESS, TABLE_ROWS, TABLES, TAKE, TANGENT, TRANSFORM, TURNED, TURNING, VALUES, VECTORS, WEIGHT,
    COORDINATES_P,
)  # fmt: skip

_one, _two, _three = caller("i"), caller("ii"), caller("iii")
_take, _rotate = caller("iiiinrr"), caller("irrr")
_gather, _fill_tables = caller("iiiinirr"), caller("iinirr")
_interpolate, _measure, _law = caller("iiiiirrrrr"), caller("ir"), caller("iirrrr")
_node_rates = caller("iiiiiinrrr")


@routine("i")
def clear_forces(group):
    """Set the forces on all nodes of a group to zero."""
    b = wholes(group)
    chunks, last = reals(b[CHUNKS]), (b[NODES] - 1) // LANES
    for chunk in range(last + 1):
        count = LANES if chunk < last else b[NODES] - last * LANES
        for row in range(b[FORCE], b[PREDICTED_FORCE] + 2 * b[VECTORS]):
            own = at(chunks, (chunk * b[NODE_ROWS] + row) * ROW)
            for i in range(count):
                own[i] = 0.0


@routine("i")
def balance(system):
    """Fill the residual (n,) and, where wanted, the matrix of a model."""
    s = wholes(system)
    residual, matrix, groups, values = reals(s[RESIDUAL]), reals(s[MATRIX]), wholes(s[GROUP_RECORDS]), wholes(s[VALUES])
    for i in range(s[SIZE]):
        residual[i] = 0.0
    if s[TANGENT] != 0:
        for i in range(s[ENTRIES]):
            matrix[i] = 0.0
    for group in range(s[GROUPS]):
        b = wholes(groups[group])
        call = wholes(b[ROUTINES])
        _one(call[CLEAR_FORCES], groups[group])
        _three(call[PLACE_NODES], groups[group], system, s[MOVING])
        _two(call[ADD_ELEMENTS], groups[group], system)
        if b[LOADS] > 0:
            _three(call[ADD_LOADS], groups[group], system, values[group])
        _two(call[FINISH_NODES], groups[group], system)
    p, dof, factor = reals(s[COORDINATES_P]), wholes(s[SPRING_DOF]), reals(s[FACTORS])[0]
    stiffness, rest, place = reals(s[SPRING_STIFFNESS]), reals(s[SPRING_REST]), wholes(s[SPRING_PLACE])
    for i in range(s[SPRINGS]):
        residual[dof[i]] += stiffness[i] * (p[dof[i]] - rest[i])
        if s[TANGENT] != 0 and place[i] >= 0:
            matrix[place[i]] += factor * stiffness[i]



@routine("iiiiiinrrr", fastmath={"contract", "reassoc", "nsz"})
def add_node_rates(first, count, linear, turned, turning, stride, dof, step, transform, rates):
    """Fill rates (linear + turned, ROW) of nodal vectors: those of the coordinates, and B times those that turn."""
    for row in range(linear):
        own, to = at(dof, row * stride + first), at(rates, row * ROW)
        for i in range(count):
            to[i] = step[own[i]]
    for part in range(turned):
        to = at(rates, (linear + part) * ROW)
        for i in range(count):
            to[i] = 0.0
        for column in range(turning):
            own, factor = at(dof, (linear + column) * stride + first), at(transform, (part * turning + column) * ROW)
            for i in range(count):
                if own[i] >= 0:
                    to[i] += factor[i] * step[own[i]]


@routine("ii")
def predict_resultants(group, system):
    """Fill `STRESS` with C (eps + (d eps / de) B dp), B and eps at p, dp in the place of p'.

    The independent stresses of Magisano, Leonetti and Garcea 2017 for the geometric part of the tangent.
    """
    b, s = wholes(group), wholes(system)
    call, x, chunks, director = wholes(b[ROUTINES]), reals(b[SPACE]), reals(b[CHUNKS]), reals(b[DIRECTOR])
    nodes, vectors, bends, elements, measures = b[NODES_PER_ELEMENT], b[VECTORS], b[BENDS], b[ELEMENTS], b[MEASURES]
    size, slots, stress = 2 * vectors, nodes * vectors, reals(b[STRESS])
    _three(call[PLACE_NODES], group, system, 0)
    first = 0
    while first < b[NODES]:
        count, chunk = min(LANES, b[NODES] - first), at(chunks, first // LANES * b[NODE_ROWS] * ROW)
        _node_rates(
            call[NODE_RATES], first, count, size - b[TURNED], b[TURNED], b[TURNING], b[NODES], wholes(b[DOF]),
            reals(s[COORDINATES_V]), at(chunk, b[TRANSFORM] * ROW), at(chunk, b[ACCELERATION] * ROW),
        )  # fmt: skip
        first += count
    _, e, _, _, t, q, unit, _, _, _, _ = rows_of(nodes, vectors, b[POINTS], b[CURVATURE], b[TABLE_ROWS])
    e, t, q, unit = at(x, e * ROW), at(x, t * ROW), at(x, q * ROW), at(x, unit * ROW)
    pairs = measures * (measures + 1) // 2
    first = 0
    while first < elements:
        count = min(b[BATCH], elements - first)
        for i in range(count):
            unit[i] = 1.0
        _fill_tables(call[FILL_TABLES], count, b[TABLE_ROWS], at(wholes(b[CLASS]), first), 0, reals(b[TABLES]), t)
        _gather(call[GATHER], nodes, count, first, elements, wholes(b[PLACE]), 2 * size, chunks, e)
        for number in range(b[POINTS]):
            slope, factor = at(t, (b[SLOPE] + number * slots) * ROW), at(director, number * nodes)
            second = at(t, (b[SECOND] + number * slots * bends) * ROW)
            _interpolate(call[INTERPOLATE], nodes, vectors, bends, count, 2 * size, slope, second, factor, e, q)
            _measure(call[STRAINS], count, q)
            rate = at(q, RATE * ROW)
            _interpolate(
                call[INTERPOLATE], nodes, vectors, bends, count, 2 * size, slope, second, factor, at(e, size * ROW), rate
            )
            _measure(call[RATES], count, q)
            for row in range(measures):
                strain, change = at(q, (STRAIN + row) * ROW), at(rate, row * ROW)
                for i in range(count):
                    strain[i] += change[i]
            _law(
                call[LAW], count, 0, unit, at(t, (b[STIFFNESS] + number * pairs) * ROW),
                at(t, (b[REFERENCE] + number * measures) * ROW), q,
            )  # fmt: skip
            for i in range(count):
                to = at(stress, ((first + i) * b[POINTS] + number) * measures)
                for row in range(measures):
                    to[row] = q[(RESULTANT + row) * ROW + i]
        first += count


@routine("i", types.float64)
def smallest_jacobian(group):
    """Return the smallest r0' x d of all quadrature points, at the nodal vectors in the chunks; negative inside out."""
    b = wholes(group)
    call, x, chunks, director = wholes(b[ROUTINES]), reals(b[SPACE]), reals(b[CHUNKS]), reals(b[DIRECTOR])
    nodes, vectors, bends, elements = b[NODES_PER_ELEMENT], b[VECTORS], b[BENDS], b[ELEMENTS]
    size, slots = 2 * vectors, nodes * vectors
    _, e, _, _, t, q, _, _, _, _, _ = rows_of(nodes, vectors, b[POINTS], b[CURVATURE], b[TABLE_ROWS])
    e, t, q = at(x, e * ROW), at(x, t * ROW), at(x, q * ROW)
    smallest, first = 1.0, 0
    while first < elements:
        count = min(b[BATCH], elements - first)
        _fill_tables(call[FILL_TABLES], count, b[TABLE_ROWS], at(wholes(b[CLASS]), first), 0, reals(b[TABLES]), t)
        _gather(call[GATHER], nodes, count, first, elements, wholes(b[PLACE]), size, chunks, e)
        for number in range(b[POINTS]):
            slope, factor = at(t, (b[SLOPE] + number * slots) * ROW), at(director, number * nodes)
            second = at(t, (b[SECOND] + number * slots * bends) * ROW)
            _interpolate(call[INTERPOLATE], nodes, vectors, bends, count, size, slope, second, factor, e, q)
            for i in range(count):
                smallest = min(smallest, q[i] * q[3 * ROW + i] - q[ROW + i] * q[2 * ROW + i])
        first += count
    return smallest
