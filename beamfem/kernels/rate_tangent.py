"""Damping in the matrices of a batch: the change of strain rates with the coordinates at constant rates.

With the derivatives G of the strains by p, the viscous resultants are t C eps' = t C G p'. At constant p' they change
with p by t C G', as the sections turn; the product of this with G^T is not symmetric.
"""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import FAST, routine
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import RATE, RATE_CHANGE, RESULTANT, VELOCITY
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Reals
from beamfem.kernels.simd import WIDTH, zeros


@routine("iiiivvdvv", fastmath=FAST)
def add_component(component, vectors, bends, count, slope, second, director, factor, q):
    """Add to q (6, ROW) what a component of the nodal vectors of a node contributes, times a row of factors."""
    vector, axis = component // 2, component % 2
    w, u = at(slope, vector * ROW), at(second, vector * bends * ROW)
    for i in range(0, count, WIDTH):
        own = at(q, axis * ROW + i)
        if vector < vectors - 1:
            own[0] += w[i] * factor[i]
            if bends != 0:
                own[4 * ROW] += u[i] * factor[i]
        else:
            own[2 * ROW] += director * factor[i]
            if bends == 0:
                own[4 * ROW] += w[i] * factor[i]


@routine("iiidvvvvvvv", fastmath=FAST)
def add_products(measures, columns, count, ck, weight, time, c, change, stress, g, k):
    """Add ck t G^T C times a change of strain rates (measures, ROW) to a column of k (columns, ROW).

    time: row of retardation times t [s]; c: upper triangle of C; g (columns, measures, ROW): transpose of G; stress
    (measures, ROW): workspace.
    """
    for row in range(measures):
        for i in range(0, count, WIDTH):
            stress[row * ROW + i] = zeros()
    pair = 0
    for row in range(measures):
        for column in range(row, measures):
            entry = at(c, pair * ROW)
            for i in range(0, count, WIDTH):
                factor = ck * weight[i] * time[i] * entry[i]
                stress[row * ROW + i] += factor * change[column * ROW + i]
                if column != row:
                    stress[column * ROW + i] += factor * change[row * ROW + i]
            pair += 1
    for n in range(columns):
        for i in range(0, count, WIDTH):
            total = k[n * ROW + i]
            for row in range(measures):
                total += g[(n * measures + row) * ROW + i] * stress[row * ROW + i]
            k[n * ROW + i] = total


@routine()
def add_rate_tangent(group: Group, system: System, count: int, x: Reals, nodal: Reals, stride: int, k: Reals) -> None:
    """Add ck times the integral of t G^T C G' to the reduced matrices k (columns, rows, ROW) of a batch.

    nodal, stride: see `form_matrices`. G takes the place of second derivatives, which are no longer needed.
    """
    call, measures, coordinates = group.routines, group.measures, group.coordinates
    nodes, vectors, bends = group.nodes_per_element, group.vectors, group.bends
    dependent, parameters, slots = group.dependent, group.parameters, nodes * vectors
    linear, columns, pairs = 2 * vectors - dependent, nodes * coordinates, measures * (measures + 1) // 2
    _, _, _, _, t, q, g, _, _, _, _ = rows_of(nodes, vectors, group.points, group.curvature, group.table_rows)
    one, t, q, g = at(x, 0), at(x, t * ROW), at(x, q * ROW), at(x, g * ROW)
    rate, change, director = at(q, RATE * ROW), at(q, RATE_CHANGE * ROW), group.director
    for i in range(ROW):
        one[i] = 1.0
    for number in range(group.points):
        slope, shapes = at(t, (group.slope + number * slots) * ROW), at(director, number * nodes)
        second = at(t, (group.second + number * slots * bends) * ROW)
        call.interpolate(nodes, vectors, bends, count, stride, slope, second, shapes, nodal, q)
        velocity = at(nodal, group.velocity * ROW)
        call.interpolate(nodes, vectors, bends, count, stride, slope, second, shapes, velocity, at(q, VELOCITY * ROW))
        weight, time = at(t, (group.weight + number) * ROW), at(t, group.damping * ROW)
        stress, c = at(q, RESULTANT * ROW), at(t, (group.stiffness + number * pairs) * ROW)
        for turn in range(2):  # first G of all coordinates, then G' of one after the other
            for node in range(nodes):
                w, u = at(slope, node * vectors * ROW), at(second, node * vectors * bends * ROW)
                for own_column in range(coordinates):
                    column = node * coordinates + own_column
                    call.clear(6, count, rate)
                    if own_column < linear:
                        call.add_component(own_column, vectors, bends, count, w, u, shapes[node], one, rate)
                    for part in range(dependent if own_column >= linear else 0):
                        b = at(nodal, (group.transform + part * parameters + own_column - linear) * ROW + node * stride)
                        call.add_component(linear + part, vectors, bends, count, w, u, shapes[node], b, rate)
                    if turn == 0:
                        call.rates(count, q)
                        call.copy_rows(measures, count, rate, at(g, column * measures * ROW))
                    else:
                        call.rate_changes(count, q)
                        if own_column >= linear:
                            call.clear(6, count, rate)
                            for part in range(dependent):
                                b = at(
                                    nodal,
                                    (group.turning + part * parameters + own_column - linear) * ROW + node * stride,
                                )
                                call.add_component(linear + part, vectors, bends, count, w, u, shapes[node], b, rate)
                            call.rates(count, q)
                            call.add_scaled(measures, count, 1.0, rate, change)
                        own = at(k, column * columns * ROW)
                        call.add_products(
                            measures, columns, count, system.weight_p, weight, time, c, change, stress, g, own
                        )
