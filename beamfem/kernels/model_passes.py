"""Residual and tangent of a whole model, and prediction of the resultants after a step."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import LANES, ROW, Group, System
from beamfem.kernels.point import RATE, RATE_CHANGE, RESULTANT, STRAIN, VELOCITY
from beamfem.kernels.pointers import at, given, small_code


@inlined
def clear(system):
    """Set the residual and, if the tangent is needed, the entries of the matrix to zero."""
    residual, matrix = system.residual, system.matrix
    for i in range(system.size):
        residual[i] = 0.0
    if system.tangent != 0:
        for i in range(system.entries):
            matrix[i] = 0.0


@inlined
def add_group(group, system):
    """Add the forces of a group to the residual and, if needed, its tangent to the matrix."""
    call = group.routines
    call.place_nodes(group, system, system.moving)
    call.add_elements(group, system)
    if group.stations > 0:
        call.add_stations(group, system)
    call.finish_nodes(group, system)


@inlined
def add_parts_at_points(system):
    """Add the forces of masses, springs and the like, and their tangents."""
    for kind in range(system.part_kinds):
        parts = system.parts[kind]
        parts.add(parts, system)


@routine()
def balance(system: System) -> None:
    """Fill the residual (n,) and, if the tangent is needed, the matrix of a model."""
    small_code()
    clear(system)
    for group in range(system.group_count):
        add_group(system.groups[group], system)
    add_parts_at_points(system)


@inlined
def _add_product(group, first, count, chunk, matrix, rates, change):
    """Add B, or B', times a change (n,) of the coordinates to the vectors of nodes that depend on them.

    matrix, rates: first rows in the chunk of B (dependent, parameters, ROW) and of all vectors of the nodes.
    """
    linear, parameters = 2 * group.vectors - group.dependent, group.parameters
    for part in range(group.dependent):
        to = at(chunk, (rates + linear + part) * ROW)
        for column in range(parameters):
            dofs = at(group.dof, (linear + column) * group.nodes + first)
            factor = at(chunk, (matrix + part * parameters + column) * ROW)
            for i in range(count):
                if dofs[i] >= 0:
                    to[i] += factor[i] * change[dofs[i]]


@routine(fastmath=FAST)
def rate_nodes(group: Group, system: System, row: int) -> None:
    """Fill e' = B p' of all nodes of a group into the rows of its chunks from `row` on; p': `system.v`."""
    chunks, step, first, size = group.chunks, system.v, 0, 2 * group.vectors
    while first < group.nodes:
        count, chunk = min(LANES, group.nodes - first), at(chunks, first // LANES * group.node_rows * ROW)
        for vector in range(size):
            dofs, to = at(group.dof, vector * group.nodes + first), at(chunk, (row + vector) * ROW)
            for i in range(count):
                to[i] = step[dofs[i]] if vector < size - group.dependent else 0.0
        _add_product(group, first, count, chunk, group.transform, row, step)
        first += count


@routine()
def turn_nodes(group: Group, system: System) -> None:
    """Add B' dp, by which e' changes at constant p', to the rates of all nodes of a group; dp: `system.v`."""
    chunks, first = group.chunks, 0
    while first < group.nodes:
        count, chunk = min(LANES, group.nodes - first), at(chunks, first // LANES * group.node_rows * ROW)
        _add_product(group, first, count, chunk, group.turning, group.velocity, system.v)
        first += count


@routine()
def predict_resultants(group: Group, system: System, placed: int) -> None:
    """Fill `STRESS` with the resultants at the strains eps + (d eps / de) B dp, minus imposed strains, after a step dp.

    eps and B are those at p, and `COORDINATES_V` holds dp instead of p'. They are the independent stresses of Magisano,
    Leonetti and Garcea 2017 for the geometric part of the tangent. If strain rates matter, `COORDINATES_A` holds p'
    instead of p'', and t C (d eps / de) B (p' + cv dp) is added, with the retardation time t, and its change with p if
    the nodes are placed. placed: whether they were placed at p by a tangent before.
    """
    call, x, director, elements = group.routines, group.space, group.director, group.elements
    nodes, vectors, bends, measures = group.nodes_per_element, group.vectors, group.bends, group.measures
    size, slots, stress = 2 * vectors, nodes * vectors, group.stress
    damped = group.damped != 0 and system.rated != 0
    cv = system.weight_v if damped else 0.0
    rows = group.curvature if damped else 2 * size
    if placed == 0:
        call.place_nodes(group, system, 0)
    call.rate_nodes(group, system, group.acceleration)
    if damped:
        step = system.v
        system.v = system.a
        call.rate_nodes(group, system, group.velocity)
        system.v = step
        if placed != 0:
            call.turn_nodes(group, system)
    _, e, _, _, tables, q, unit, _, _, _, _ = rows_of(nodes, vectors, group.points, group.curvature, group.table_rows)
    e, t, q, unit = at(x, e * ROW), at(x, tables * ROW), at(x, q * ROW), at(x, unit * ROW)
    pairs, chunks, place = measures * (measures + 1) // 2, group.chunks, group.place
    first = 0
    while first < elements:
        count = min(group.batch, elements - first)
        for i in range(count):
            unit[i] = 1.0
        apart = call.collect(group, None, first, count, rows, 0)
        nodal = e if apart == 0 else at(chunks, place[first])
        stride = rows * ROW if apart == 0 else apart
        for number in range(group.points):
            slope, factor = at(t, (group.slope + number * slots) * ROW), at(director, number * nodes)
            second = at(t, (group.second + number * slots * bends) * ROW)
            rate, time = at(q, RATE * ROW), at(t, group.damping * ROW)
            call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
            call.strains(count, q)
            change = at(nodal, group.acceleration * ROW)
            call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, change, rate)
            if damped and placed != 0:
                moving = at(nodal, group.velocity * ROW)
                velocity = at(q, VELOCITY * ROW)
                call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, moving, velocity)
                call.rate_changes(count, q)
                for row in range(measures):
                    strain, rate_row = at(q, (STRAIN + row) * ROW), at(q, (RATE_CHANGE + row) * ROW)
                    for i in range(count):
                        strain[i] += time[i] * rate_row[i]
            call.rates(count, q)
            for row in range(measures):
                strain, rate_row = at(q, (STRAIN + row) * ROW), at(rate, row * ROW)
                for i in range(count):
                    strain[i] += rate_row[i]
                if damped:
                    for i in range(count):
                        strain[i] += time[i] * cv * rate_row[i]
            if damped:
                moving = at(nodal, group.velocity * ROW)
                call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, moving, rate)
                call.rates(count, q)
                for row in range(measures):
                    strain, rate_row = at(q, (STRAIN + row) * ROW), at(rate, row * ROW)
                    for i in range(count):
                        strain[i] += time[i] * rate_row[i]
            if given(group.natural):
                call.release(first, count, group.points, number, measures, group.natural, q)
            c = at(t, (group.stiffness + number * pairs) * ROW)
            call.law(
                group, system, first, number, count, 0, unit, c, at(t, (group.reference + number * measures) * ROW), q
            )
            for i in range(count):
                to = at(stress, ((first + i) * group.points + number) * measures)
                for row in range(measures):
                    to[row] = q[(RESULTANT + row) * ROW + i]
        first += count


@routine()
def smallest_jacobian(group: Group) -> float:
    """Return the smallest r0' x d of all quadrature points, at most 1; it is negative where an element is inverted.

    The nodal vectors are taken from the chunks.
    """
    call, x, director = group.routines, group.space, group.director
    nodes, vectors, bends, elements = group.nodes_per_element, group.vectors, group.bends, group.elements
    size, slots = 2 * vectors, nodes * vectors
    _, e, _, _, tables, q, _, _, _, _, _ = rows_of(nodes, vectors, group.points, group.curvature, group.table_rows)
    e, t, q = at(x, e * ROW), at(x, tables * ROW), at(x, q * ROW)
    chunks, place = group.chunks, group.place
    smallest, first = 1.0, 0
    while first < elements:
        count = min(group.batch, elements - first)
        apart = call.collect(group, None, first, count, size, 0)
        nodal = e if apart == 0 else at(chunks, place[first])
        stride = size * ROW if apart == 0 else apart
        for number in range(group.points):
            slope, factor = at(t, (group.slope + number * slots) * ROW), at(director, number * nodes)
            second = at(t, (group.second + number * slots * bends) * ROW)
            call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
            for i in range(count):
                smallest = min(smallest, q[i] * q[3 * ROW + i] - q[ROW + i] * q[2 * ROW + i])
        first += count
    return smallest
