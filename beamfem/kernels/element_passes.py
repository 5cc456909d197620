"""Loop over the elements of a group in batches: elastic, inertia and body forces, and their tangents."""

from beamfem.kernels import record as r
from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.point import FORCE as POINT_FORCE
from beamfem.kernels.point import HESSIAN as POINT_HESSIAN
from beamfem.kernels.point import RATE, RESULTANT
from beamfem.kernels.pointers import at, caller, reals, small_code, wholes
from beamfem.kernels.record import ROW

_collect, _scatter = caller("iiiiii", "i"), caller("iiiiiniirr")
_interpolate, _distribute = caller("iiiiirrrrr"), caller("iiiirrrrr")
_measure, _law = caller("ir"), caller("iiiiiirrrr")
_add_inertia = caller("iiiiiiirrrrrr")
_form, _add, _copy = caller("iiirri"), caller("iiiir"), caller("iirr")
_release = caller("iiiiirr")
_rate_nodes, _viscous = caller("iii"), caller("iiddrrrr")


@routine("ii")
def add_elements(group, system):
    """Add the forces of all elements of a group to the nodal forces in its chunks, and tangents to the matrix.

    With `PREDICTED`, also add the forces for the resultants in `STRESS`, on which the geometric tangent is based.
    """
    small_code()
    b, s = wholes(group), wholes(system)
    call, x = wholes(b[r.ROUTINES]), reals(b[r.SPACE])
    nodes, vectors, bends, elements = b[r.NODES_PER_ELEMENT], b[r.VECTORS], b[r.BENDS], b[r.ELEMENTS]
    size, slots_ = 2 * vectors, nodes * vectors
    measures, moving, tangent, predicted = b[r.MEASURES], s[r.MOVING], s[r.TANGENT], s[r.PREDICTED]
    gathered, damped = b[r.CURVATURE], b[r.DAMPED] != 0 and s[r.RATED] != 0
    ck, cv = reals(s[r.FACTORS])[r.WEIGHT_P], reals(s[r.FACTORS])[r.WEIGHT_V] if damped else 0.0
    stiff = tangent != 0 and (ck != 0.0 or cv != 0.0)
    changed = 1 if tangent != 0 and moving != 0 else 0  # what the mass adds, the chunks must not keep
    if damped:
        _rate_nodes(call[r.RATE_NODES], group, system, b[r.VELOCITY])
    rows = gathered if tangent != 0 or damped else (2 * size if moving != 0 else size)
    body, e, f, g, table, point, h, _, _, k, _ = rows_of(nodes, vectors, b[r.POINTS], gathered, b[r.TABLE_ROWS])
    chunks, director = reals(b[r.CHUNKS]), reals(b[r.DIRECTOR])
    place, ordered = wholes(b[r.PLACE]), b[r.ORDERED]
    copied, f, g, t, q, k = (
        at(x, e * ROW),
        at(x, f * ROW),
        at(x, g * ROW),
        at(x, table * ROW),
        at(x, point * ROW),
        at(x, k * ROW),
    )
    body = at(x, body * ROW)
    pairs = measures * (measures + 1) // 2
    first = 0
    while first < elements:
        count = min(b[r.BATCH], elements - first)
        apart = _collect(call[r.COLLECT], group, system, first, count, rows, changed)
        nodal = copied if apart == 0 else at(chunks, place[first])
        stride = rows * ROW if apart == 0 else apart
        _add_inertia(
            call[r.ADD_INERTIA],
            nodes,
            vectors,
            count,
            stride,
            s[r.LOADED],
            moving,
            b[r.APART],
            at(t, b[r.MASS] * ROW),
            at(t, b[r.GRAVITY] * ROW),
            at(t, b[r.LENGTH] * ROW),
            body,
            nodal,
            f,
        )
        if predicted != 0:
            _copy(call[r.COPY], nodes * size, count, f, g)
        for number in range(b[r.POINTS]):
            slope = at(t, (b[r.SLOPE] + number * slots_) * ROW)
            second = at(t, (b[r.SECOND] + number * slots_ * bends) * ROW)
            factor = at(director, number * nodes)
            weight = at(t, (b[r.WEIGHT] + number) * ROW)
            _interpolate(call[r.INTERPOLATE], nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
            _measure(call[r.STRAINS], count, q)
            if b[r.NATURAL] != 0:
                _release(call[r.RELEASE], first, count, b[r.POINTS], number, measures, reals(b[r.NATURAL]), q)
            _law(
                call[r.LAW],
                group,
                system,
                first,
                number,
                count,
                1 if stiff else 0,
                weight,
                at(t, (b[r.STIFFNESS] + number * pairs) * ROW),
                at(t, (b[r.REFERENCE] + number * measures) * ROW),
                q,
            )
            if damped:
                rate, velocity = at(q, RATE * ROW), at(nodal, b[r.VELOCITY] * ROW)
                _interpolate(
                    call[r.INTERPOLATE], nodes, vectors, bends, count, stride, slope, second, factor, velocity, rate
                )
                _measure(call[r.RATES], count, q)
                _viscous(
                    call[r.VISCOUS],
                    count,
                    measures,
                    ck if stiff else 0.0,
                    cv if stiff else 0.0,
                    weight,
                    at(t, (b[r.STIFFNESS] + number * pairs) * ROW),
                    at(t, b[r.DAMPING] * ROW),
                    q,
                )
            _measure(call[r.FORCES], count, q)
            _distribute(
                call[r.DISTRIBUTE], nodes, vectors, bends, count, slope, second, factor, at(q, POINT_FORCE * ROW), f
            )
            if predicted != 0:
                stress = reals(b[r.STRESS])
                for i in range(count):
                    resultants = at(stress, ((first + i) * b[r.POINTS] + number) * measures)
                    for measure in range(measures):
                        q[(RESULTANT + measure) * ROW + i] = weight[i] * resultants[measure]
                _measure(call[r.FORCES], count, q)
                _distribute(
                    call[r.DISTRIBUTE], nodes, vectors, bends, count, slope, second, factor, at(q, POINT_FORCE * ROW), g
                )
            if stiff and damped:
                for row in range(measures):
                    resultant = at(q, (RESULTANT + row) * ROW)
                    for i in range(count):
                        resultant[i] *= ck
            if stiff:
                _measure(call[r.HESSIAN], count, q)
            if stiff and b[r.POINTS] > 1:
                _copy(call[r.COPY], 21, count, at(q, POINT_HESSIAN * ROW), at(x, (h + 21 * number) * ROW))
        _scatter(call[r.SCATTER], nodes, count, first, elements, ordered, place, size, b[r.FORCE], f, chunks)
        if predicted != 0:
            _scatter(
                call[r.SCATTER],
                nodes,
                count,
                first,
                elements,
                ordered,
                place,
                size,
                b[r.PREDICTED_FORCE],
                g,
                chunks,
            )
        if tangent != 0:
            _form(call[r.FORM_MATRICES], group, system, count, x, nodal, stride)
            _add(call[r.ADD_MATRICES], group, system, first, count, k)
        first += count
