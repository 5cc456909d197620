"""Element matrices of a batch, from second derivatives at quadrature points to assembly into the model's matrix."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import HESSIAN
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Reals


@routine()
def form_matrices(group: Group, system: System, count: int, x: Reals, nodal: Reals, stride: int) -> None:
    """Fill the reduced matrices B^T (ck K B + M C) of a batch of elements; see `rate_tangent` for those of damping.

    C = ca B + ck de''/dp + cv de''/dp'; ck, cv, ca: weights of the derivatives with respect to p, p' and p''; x:
    workspace; nodal: rows of the first nodes, those of the next ones `stride` numbers on.
    """
    call, director = group.routines, group.director
    nodes, vectors, points, bends = group.nodes_per_element, group.vectors, group.points, group.bends
    dependent, parameters, gathered, coordinates = group.dependent, group.parameters, group.curvature, group.coordinates
    size, slots_, rows = 2 * vectors, nodes * vectors, nodes * coordinates
    _, _, _, _, t, q, h, z, pair, k, _ = rows_of(nodes, vectors, points, gathered, group.table_rows)
    if points == 1:
        h = q + HESSIAN
    t, h, z, pair, k = at(x, t * ROW), at(x, h * ROW), at(x, z * ROW), at(x, pair * ROW), at(x, k * ROW)
    ck, linear = system.weight_p, size - dependent
    if group.damped != 0 and system.rated != 0:  # `linear_law.add_viscous` has applied ck and cv at the points
        ck = 1.0 if ck != 0.0 or system.weight_v != 0.0 else 0.0
    transform = at(nodal, group.transform * ROW)
    if ck != 0.0:
        for m in range(nodes):
            for point in range(points):
                slope = at(t, (group.slope + point * slots_ + m * vectors) * ROW)
                second = at(t, (group.second + (point * slots_ + m * vectors) * bends) * ROW)
                factor, own = at(director, point * nodes + m), at(h, 21 * point * ROW)
                to = at(z, 6 * point * size * ROW)
                call.columns(vectors, bends, count, ck, slope, second, factor, own, to)
                if dependent != 0:
                    b_node = at(transform, m * stride)
                    call.combine(6, dependent, parameters, count, b_node, at(to, 6 * linear * ROW), x)
            for n in range(m + 1):
                b_node, to = at(transform, n * stride), at(k, (rows * m + n) * coordinates * ROW)
                if call.products(vectors, bends, count, group, n, t, b_node, z, pair, to) == 0:
                    call.store(size, dependent, parameters, coordinates, count, rows, b_node, pair, to)
        call.mirror(rows, count, k)
        if group.damped != 0 and system.moving != 0 and system.weight_p != 0.0:
            call.add_rate_tangent(group, system, count, x, nodal, stride, k)
    else:
        call.clear(rows * rows, count, k)
    if system.moving != 0:
        convective = at(nodal, group.convective * ROW)  # a copy
        ca = system.weight_a + group.mass_damping * system.weight_v
        if dependent != 0:
            for n in range(nodes):
                to = at(convective, n * gathered * ROW)
                call.add_scaled(dependent * parameters, count, ca, at(transform, n * gathered * ROW), to)
        mass = at(t, group.mass * ROW)
        call.add_mass(nodes, vectors, dependent, parameters, count, gathered, ca, mass, transform, convective, k)


@routine()
def add_matrices(group: Group, system: System, first: int, count: int, k: Reals) -> None:
    """Add the reduced matrices k of a batch of elements to the matrix of the model."""
    call, nodes, coordinates, half = group.routines, group.nodes_per_element, group.coordinates, group.half_width
    matrix = system.matrix
    if half >= 0:
        number = at(group.number, first)
        call.add_to_band(nodes, coordinates, coordinates, count, group.elements, number, half, k, matrix)
    else:
        elements = at(group.counted, first)
        call.add_to_sparse(nodes, coordinates, coordinates, count, elements, group.slot, k, matrix)


@routine()
def reduce_and_add(group: Group, system: System, first: int, count: int, x: Reals) -> None:
    """Reduce the matrices (columns, rows, ROW) of a batch of stations in its workspace x; add them to the model's."""
    call = group.routines
    nodes, vectors, coordinates, half = group.nodes_per_element, group.vectors, group.coordinates, group.half_width
    dependent, parameters, gathered, size = group.dependent, group.parameters, group.curvature, 2 * vectors
    matrix = system.matrix
    _, e, _, _, _, _, _, _, _, k, _ = rows_of(nodes, vectors, group.points, gathered, group.table_rows)
    transform, k = at(x, (e + group.transform) * ROW), at(x, k * ROW)
    if dependent != 0:
        for n in range(nodes):
            of_node = at(k, nodes * size * (n * size + size - dependent) * ROW)
            call.combine(nodes * size, dependent, parameters, count, at(transform, n * gathered * ROW), of_node, x)
        call.reduce_rows(nodes, size, dependent, parameters, count, gathered, transform, k, x)
    if half >= 0:
        number = at(group.station_number, first)
        call.add_to_band(nodes, size, coordinates, count, group.stations, number, half, k, matrix)
    else:
        elements = at(group.station_element, first)
        call.add_to_sparse(nodes, size, coordinates, count, elements, group.slot, k, matrix)
