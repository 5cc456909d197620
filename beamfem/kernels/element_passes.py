"""Loop over the elements of a group in batches: elastic, inertia and body forces, and their tangents."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import FORCE as POINT_FORCE
from beamfem.kernels.point import HESSIAN as POINT_HESSIAN
from beamfem.kernels.point import RATE, RESULTANT
from beamfem.kernels.pointers import at, given, small_code


@routine()
def add_elements(group: Group, system: System) -> None:
    """Add the forces of all elements of a group to the nodal forces in its chunks, and tangents to the matrix.

    If `predicted`, also add the forces for the resultants in `stress`, on which the geometric tangent is based.
    """
    small_code()
    call, x = group.routines, group.space
    nodes, vectors, bends, elements = group.nodes_per_element, group.vectors, group.bends, group.elements
    size, slots_ = 2 * vectors, nodes * vectors
    measures, moving, tangent, predicted = group.measures, system.moving, system.tangent, system.predicted
    gathered, damped = group.curvature, group.damped != 0 and system.rated != 0
    ck, cv = system.weight_p, system.weight_v if damped else 0.0
    stiff = tangent != 0 and (ck != 0.0 or cv != 0.0)
    changed = 1 if tangent != 0 and moving != 0 else 0  # what the mass adds, the chunks must not keep
    if damped:
        call.rate_nodes(group, system, group.velocity)
    rows = gathered if tangent != 0 or damped else (2 * size if moving != 0 else size)
    body, e, f, g, table, point, h, _, _, k, _ = rows_of(nodes, vectors, group.points, gathered, group.table_rows)
    chunks, director, place, ordered = group.chunks, group.director, group.place, group.ordered
    copied, f, g, t = at(x, e * ROW), at(x, f * ROW), at(x, g * ROW), at(x, table * ROW)
    q, k, body = at(x, point * ROW), at(x, k * ROW), at(x, body * ROW)
    mass, weights, lengths = at(t, group.mass * ROW), at(t, group.gravity * ROW), at(t, group.length * ROW)
    pairs = measures * (measures + 1) // 2
    first = 0
    while first < elements:
        count = min(group.batch, elements - first)
        apart = call.collect(group, system, first, count, rows, changed)
        nodal = copied if apart == 0 else at(chunks, place[first])
        stride = rows * ROW if apart == 0 else apart
        loaded, uncoupled = system.loaded, group.apart
        call.add_inertia(
            nodes, vectors, count, stride, loaded, moving, uncoupled, mass, weights, lengths, body, nodal, f
        )
        if predicted != 0:
            call.copy_rows(nodes * size, count, f, g)
        for number in range(group.points):
            slope = at(t, (group.slope + number * slots_) * ROW)
            second = at(t, (group.second + number * slots_ * bends) * ROW)
            factor = at(director, number * nodes)
            weight = at(t, (group.weight + number) * ROW)
            call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
            call.strains(count, q)
            if given(group.natural):
                call.release(first, count, group.points, number, measures, group.natural, q)
            c = at(t, (group.stiffness + number * pairs) * ROW)
            reference = at(t, (group.reference + number * measures) * ROW)
            call.law(group, system, first, number, count, 1 if stiff else 0, weight, c, reference, q)
            if damped:
                rate, velocity = at(q, RATE * ROW), at(nodal, group.velocity * ROW)
                call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, velocity, rate)
                call.rates(count, q)
                stiffness_factor, rate_factor = ck if stiff else 0.0, cv if stiff else 0.0
                time = at(t, group.damping * ROW)
                call.add_viscous(count, measures, stiffness_factor, rate_factor, weight, c, time, q)
            call.forces(count, q)
            call.distribute(nodes, vectors, bends, count, slope, second, factor, at(q, POINT_FORCE * ROW), f)
            if predicted != 0:
                stress = group.stress
                for i in range(count):
                    resultants = at(stress, ((first + i) * group.points + number) * measures)
                    for measure in range(measures):
                        q[(RESULTANT + measure) * ROW + i] = weight[i] * resultants[measure]
                call.forces(count, q)
                call.distribute(nodes, vectors, bends, count, slope, second, factor, at(q, POINT_FORCE * ROW), g)
            if stiff and damped:
                for row in range(measures):
                    resultant = at(q, (RESULTANT + row) * ROW)
                    for i in range(count):
                        resultant[i] *= ck
            if stiff:
                call.hessian(count, q)
            if stiff and group.points > 1:
                call.copy_rows(21, count, at(q, POINT_HESSIAN * ROW), at(x, (h + 21 * number) * ROW))
        call.scatter(nodes, count, first, elements, ordered, place, size, group.force, f, chunks)
        if predicted != 0:
            call.scatter(nodes, count, first, elements, ordered, place, size, group.predicted_force, g, chunks)
        if tangent != 0:
            call.form_matrices(group, system, count, x, nodal, stride)
            call.add_matrices(group, system, first, count, k)
        first += count
