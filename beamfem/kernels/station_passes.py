"""Forces at stations of elements; each station is a lane of a batch, whatever element it is in."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.gathering import gather
from beamfem.kernels.model_record import CONSTANTS, ROW, Group, System
from beamfem.kernels.pointers import at, room
from beamfem.kernels.records import Reals

_DATA = 3 + CONSTANTS


@routine()
def add_stations(group: Group, system: System) -> None:
    """Add the generalized forces of all stations of a group to its nodal forces, their tangents to the matrix."""
    call, x, chunks = group.routines, group.space, group.chunks
    nodes, vectors, stations, place = group.nodes_per_element, group.vectors, group.stations, group.station_place
    size, tangent = 2 * vectors, system.tangent
    ck = system.weight_p
    rows = group.curvature if tangent != 0 else size
    _, e, f, _, _, _, _, _, _, k, _ = rows_of(nodes, vectors, group.points, group.curvature, group.table_rows)
    e, f, k = at(x, e * ROW), at(x, f * ROW), at(x, k * ROW)
    stiff = 1 if tangent != 0 and ck != 0.0 else 0
    first = 0
    while first < stations:
        count = min(group.batch, stations - first)
        gather(nodes, count, first, stations, 0, place, rows, chunks, e)
        if stiff != 0:
            call.clear(nodes * size * nodes * size, count, k)
        coupled = 0
        for lane in range(count):
            done = call.station_forces(group, first + lane, rows, ck * stiff, at(e, lane), at(f, lane), at(k, lane))
            coupled = max(coupled, done)
        call.scatter(nodes, count, first, stations, 0, place, size, group.force, f, chunks)
        if system.predicted != 0:
            call.scatter(nodes, count, first, stations, 0, place, size, group.predicted_force, f, chunks)
        if stiff != 0 and coupled != 0:
            call.reduce_and_add(group, system, first, count, x)
        first += count


@routine()
def station_forces(group: Group, station: int, stride: int, ck: float, e: Reals, f: Reals, k: Reals) -> int:
    """Fill f with the nodal forces of a station and, unless it is zero, k with ck df/de; return 1 if it did, else 0.

    e (nodes, stride, ROW), f, k: pointers to the lane of the station in the first row of each.
    """
    nodes, vectors, stations = group.nodes_per_element, group.vectors, group.stations
    position, direction = at(group.position, station), at(group.direction, station)
    values, constants, passes = at(group.values, 3 * station), at(group.constants, CONSTANTS * station), group.kinds
    q, data, out = room(4), room(_DATA), room(16)
    for i in range(4):
        q[i] = 0.0
    for n in range(nodes):
        for s in range(vectors):
            row, slot = (n * stride + 2 * s) * ROW, (n * vectors + s) * stations
            q[0] += position[slot] * e[row]
            q[1] += position[slot] * e[row + ROW]
            q[2] += direction[slot] * e[row]
            q[3] += direction[slot] * e[row + ROW]
    for i in range(3):
        data[i] = values[i]
    for i in range(CONSTANTS):
        data[3 + i] = constants[i]
    own = passes[group.station_kind[station]]
    own.force(q, q, q, q, q, data, q, out)
    slots = nodes * vectors
    for slot in range(slots):
        on_r, on_g = position[slot * stations], direction[slot * stations]
        f[2 * slot * ROW] = on_r * out[0] + on_g * out[2]
        f[(2 * slot + 1) * ROW] = on_r * out[1] + on_g * out[3]
    if ck == 0.0:
        return 0
    own.tangent(q, q, q, q, q, data, q, ck, 0.0, 0.0, out)
    size = 0.0
    for i in range(16):
        size = max(size, abs(out[i]))
    if size == 0.0:
        return 0
    for j in range(slots):
        by_r, by_g = position[j * stations], direction[j * stations]
        for axis in range(2):
            for row in range(4):
                q[row] = by_r * out[4 * row + axis] + by_g * out[4 * row + 2 + axis]
            for i in range(slots):
                on_r, on_g = position[i * stations], direction[i * stations]
                to = at(k, (2 * slots * (2 * j + axis) + 2 * i) * ROW)
                to[0] = on_r * q[0] + on_g * q[2]
                to[ROW] = on_r * q[1] + on_g * q[3]
    return 1
