"""Energies and momenta of beams in many states, and what the potential of loads on them follows from."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import RESULTANT, STRAIN
from beamfem.kernels.pointers import at, given
from beamfem.kernels.records import Reals

# of a beam: kinetic and strain energy [J]; position summed over mass (2,) [kg m] and over length (2,) [m^2]; linear
# momentum (2,) [kg m/s] and angular momentum about the origin [kg m^2/s]
OF_BEAM = 9


@routine()
def add_energies(
    group: Group,
    system: System,
    rows: int,
    beams: int,
    strained: int,
    p: Reals,
    v: Reals,
    result: Reals,
    places: Reals,
) -> None:
    """Add the numbers of the elements of a group in states p and p' (rows, n) to those of beams (rows, beams, 9).

    strained: whether to add strain energy, which is that of the linear section law; places (rows, stations, 2): receive
    the positions of stations. `COORDINATES_V` holds zeros, as the accelerations of a state at rest with p' for p'' are
    its velocities.
    """
    call, x, director, unknown = group.routines, group.space, group.director, system.size
    nodes, vectors, bends, measures = group.nodes_per_element, group.vectors, group.bends, group.measures
    size, slots, pairs = 2 * vectors, nodes * vectors, measures * (measures + 1) // 2
    _, e, f, _, tables, q, h, _, _, _, _ = rows_of(nodes, vectors, group.points, group.curvature, group.table_rows)
    e, f, sums, t, q = at(x, e * ROW), at(x, f * ROW), at(x, h * ROW), at(x, tables * ROW), at(x, q * ROW)
    masses, weights, lengths = at(t, group.mass * ROW), at(t, group.gravity * ROW), at(t, group.length * ROW)
    strains, natural, body = group.elements * group.points * measures, group.natural, x
    for row in range(rows):
        system.p, system.a = at(p, row * unknown), at(v, row * unknown)
        call.place_nodes(group, system, 1)
        if given(group.natural_of_steps):
            natural = at(group.natural_of_steps, row * strains)
        for station in range(group.stations):
            to = at(places, 2 * (row * group.stations + station))
            for n in range(nodes):
                vector = at(group.chunks, group.station_place[n * group.stations + station])
                for s in range(vectors):
                    share = group.position[(n * vectors + s) * group.stations + station]
                    to[0] += share * vector[2 * s * ROW]
                    to[1] += share * vector[(2 * s + 1) * ROW]
        first = 0
        while first < group.elements:
            count = min(group.batch, group.elements - first)
            apart = call.collect(group, None, first, count, 2 * size, 0)
            nodal = e if apart == 0 else at(group.chunks, group.place[first])
            stride = 2 * size * ROW if apart == 0 else apart
            call.clear(OF_BEAM, count, sums)
            call.add_inertia(nodes, vectors, count, stride, 0, 1, group.apart, masses, weights, lengths, body, nodal, f)
            for slot in range(slots):
                vector = at(nodal, slot // vectors * stride + 2 * (slot % vectors) * ROW)
                velocity, momentum = at(vector, size * ROW), at(f, 2 * slot * ROW)
                for i in range(count):
                    sums[8 * ROW + i] += vector[i] * momentum[ROW + i] - vector[ROW + i] * momentum[i]
                    mass, length = weights[slot * ROW + i], lengths[slot * ROW + i]
                    for k in range(i, i + 2 * ROW, ROW):
                        sums[i] += 0.5 * velocity[k] * momentum[k]
                        sums[2 * ROW + k] += mass * vector[k]
                        sums[4 * ROW + k] += length * vector[k]
                        sums[6 * ROW + k] += mass * velocity[k]
            for number in range(group.points if strained != 0 else 0):
                slope, factor = at(t, (group.slope + number * slots) * ROW), at(director, number * nodes)
                second = at(t, (group.second + number * slots * bends) * ROW)
                weight, c = at(t, (group.weight + number) * ROW), at(t, (group.stiffness + number * pairs) * ROW)
                reference = at(t, (group.reference + number * measures) * ROW)
                call.interpolate(nodes, vectors, bends, count, stride, slope, second, factor, nodal, q)
                call.strains(count, q)
                if given(group.natural_of_steps):
                    call.release(first, count, group.points, number, measures, natural, q)
                call.law(group, system, first, number, count, 0, weight, c, reference, q)
                for i in range(count):
                    for k in range(measures):
                        strain = q[(STRAIN + k) * ROW + i] - reference[k * ROW + i]
                        sums[ROW + i] += 0.5 * strain * q[(RESULTANT + k) * ROW + i]
            for i in range(count):
                to = at(result, (row * beams + group.beam[first + i]) * OF_BEAM)
                for k in range(OF_BEAM):
                    to[k] += sums[k * ROW + i]
            first += count
