"""All elements of a group, in batches: elastic, inertia and body forces, and their tangents."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.point import FORCE as POINT_FORCE, HESSIAN as POINT_HESSIAN, RESULTANT
from beamfem.kernels.pointers import at, caller, reals, wholes
from beamfem.kernels.record import (
    ADD_INERTIA, ADD_MATRICES, BATCH, BEAM, BENDS, BODY, CHUNKS, CLASS, COPY, CURVATURE, DIRECTOR, ELEMENTS, FACTORS, FILL_BODY, FILL_TABLES, FORCE, FORCES, FORM_MATRICES, GATHER, GRAVITY, HESSIAN, INTERPOLATE, LAW, LENGTH, LOADED, MASS, MEASURES, MOVING, NODES_PER_ELEMENT, PLACE, POINTS, PREDICTED, PREDICTED_FORCE, REFERENCE, ROUTINES, ROW, SCATTER, SECOND, SLOPE, SPACE, SPREAD, STIFFNESS, STRAINS, STRESS, TABLE_ROWS, TABLES, TANGENT, VECTORS, WEIGHT,
)  # fmt: skip

_gather, _scatter = caller("iiiinirr"), caller("iiiiniirr")
_fill_tables, _fill_body = caller("iinirr"), caller("iinrr")
_interpolate, _spread = caller("iiiiirrrrr"), caller("iiiirrrrr")
_measure, _law = caller("ir"), caller("iirrrr")
_add_inertia = caller("iiiiiirrrrrr")
_form, _add, _copy = caller("iiir"), caller("iiiir"), caller("iirr")


@routine("ii")
def add_elements(group, system):
    """Add the forces of all elements of a group to those of their nodes, their tangents to the matrix."""
    b, s = wholes(group), wholes(system)
    call, x = wholes(b[ROUTINES]), reals(b[SPACE])
    nodes, vectors, bends, elements = b[NODES_PER_ELEMENT], b[VECTORS], b[BENDS], b[ELEMENTS]
    size, slots_ = 2 * vectors, nodes * vectors
    measures, moving, tangent, predicted = b[MEASURES], s[MOVING], s[TANGENT], s[PREDICTED]
    stiff = tangent != 0 and reals(s[FACTORS])[0] != 0.0
    gathered = b[CURVATURE]
    rows = gathered if tangent != 0 else (2 * size if moving != 0 else size)
    body, e, f, g, t, point, h, _, _, k, _ = rows_of(nodes, vectors, b[POINTS], gathered, b[TABLE_ROWS])
    tables, chunks, director = reals(b[TABLES]), reals(b[CHUNKS]), reals(b[DIRECTOR])
    classes, beams, place = wholes(b[CLASS]), wholes(b[BEAM]), wholes(b[PLACE])
    e, f, g, t, q, k = at(x, e * ROW), at(x, f * ROW), at(x, g * ROW), at(x, t * ROW), at(x, point * ROW), at(x, k * ROW)
    body = at(x, body * ROW)
    pairs = measures * (measures + 1) // 2
    filled, filled_class = 0, -1
    first = 0
    while first < elements:
        count = min(b[BATCH], elements - first)
        own = at(classes, first)
        uniform = 1
        for i in range(1, count):
            if own[i] != own[0]:
                uniform = 0
        if uniform == 0 or own[0] != filled_class or filled < count:
            _fill_tables(call[FILL_TABLES], count, b[TABLE_ROWS], own, uniform, tables, t)
            filled, filled_class = count, (own[0] if uniform != 0 else -1)
        _gather(call[GATHER], nodes, count, first, elements, place, rows, chunks, e)
        if s[LOADED] != 0:
            _fill_body(call[FILL_BODY], count, 0, at(beams, first), reals(s[BODY]), body)
        _add_inertia(
            call[ADD_INERTIA], nodes, vectors, count, rows, s[LOADED], moving, at(t, b[MASS] * ROW), at(t, b[GRAVITY] * ROW),
            at(t, b[LENGTH] * ROW), body, e, f,
        )  # fmt: skip
        if predicted != 0:
            _copy(call[COPY], nodes * size, count, f, g)
        for number in range(b[POINTS]):
            slope = at(t, (b[SLOPE] + number * slots_) * ROW)
            second = at(t, (b[SECOND] + number * slots_ * bends) * ROW)
            factor = at(director, number * nodes)
            weight = at(t, (b[WEIGHT] + number) * ROW)
            _interpolate(call[INTERPOLATE], nodes, vectors, bends, count, rows, slope, second, factor, e, q)
            _measure(call[STRAINS], count, q)
            _law(
                call[LAW], count, 1 if stiff else 0, weight, at(t, (b[STIFFNESS] + number * pairs) * ROW),
                at(t, (b[REFERENCE] + number * measures) * ROW), q,
            )  # fmt: skip
            _measure(call[FORCES], count, q)
            _spread(call[SPREAD], nodes, vectors, bends, count, slope, second, factor, at(q, POINT_FORCE * ROW), f)
            if predicted != 0:
                stress = reals(b[STRESS])
                for i in range(count):
                    known = at(stress, ((first + i) * b[POINTS] + number) * measures)
                    for measure in range(measures):
                        q[(RESULTANT + measure) * ROW + i] = weight[i] * known[measure]
                _measure(call[FORCES], count, q)
                _spread(call[SPREAD], nodes, vectors, bends, count, slope, second, factor, at(q, POINT_FORCE * ROW), g)
            if stiff:
                _measure(call[HESSIAN], count, q)
                _copy(call[COPY], 21, count, at(q, POINT_HESSIAN * ROW), at(x, (h + 21 * number) * ROW))
        _scatter(call[SCATTER], nodes, count, first, elements, place, size, b[FORCE], f, chunks)
        if predicted != 0:
            _scatter(call[SCATTER], nodes, count, first, elements, place, size, b[PREDICTED_FORCE], g, chunks)
        if tangent != 0:
            _form(call[FORM_MATRICES], group, system, count, x)
            _add(call[ADD_MATRICES], group, system, first, count, k)
        first += count
