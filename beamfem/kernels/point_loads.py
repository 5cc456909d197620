"""Forces, moments and springs at points of elements; each load is a lane of a batch, whatever element it acts on."""

import math

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.gathering import gather
from beamfem.kernels.pointers import at
from beamfem.kernels.record import ROW, Group, System
from beamfem.kernels.records import Reals


@routine()
def add_loads(group: Group, system: System) -> None:
    """Subtract the generalized forces of all loads of a group from its nodal forces, their tangents from the matrix."""
    call, x, chunks = group.routines, group.space, group.chunks
    nodes, vectors, loads, place = group.nodes_per_element, group.vectors, group.loads, group.load_place
    size, tangent = 2 * vectors, system.tangent
    ck = system.weight_p
    rows = group.curvature if tangent != 0 else size
    _, e, f, _, _, _, _, _, _, k, _ = rows_of(nodes, vectors, group.points, group.curvature, group.table_rows)
    e, f, k = at(x, e * ROW), at(x, f * ROW), at(x, k * ROW)
    stiff = 1 if tangent != 0 and ck != 0.0 else 0
    first = 0
    while first < loads:
        count = min(group.batch, loads - first)
        gather(nodes, count, first, loads, 0, place, rows, chunks, e)
        if stiff != 0:
            call.clear(nodes * size * nodes * size, count, k)
        coupled = 0
        for lane in range(count):
            load_values = at(group.values, 3 * (first + lane))
            done = call.load_forces(
                group, first + lane, rows, ck * stiff, load_values, at(e, lane), at(f, lane), at(k, lane)
            )
            coupled = max(coupled, done)
        call.scatter(nodes, count, first, loads, 0, place, size, group.force, f, chunks)
        if system.predicted != 0:
            call.scatter(nodes, count, first, loads, 0, place, size, group.predicted_force, f, chunks)
        if stiff != 0 and coupled != 0:
            call.reduce_and_add(group, system, first, count, x)
        first += count


@routine()
def load_forces(group: Group, load: int, stride: int, ck: float, values: Reals, e: Reals, f: Reals, k: Reals) -> int:
    """Fill f with the negative nodal forces of a load and, unless zero, k with ck df/de; return 1 if it did, else 0.

    e (nodes, stride, ROW), f, k: pointers to the lane of the load in the first row of each. The moment acts on the
    vector g that defines the direction of the section, with virtual work M (g x delta g) / |g|^2. A follower force
    rotates with g, and a pressure is also proportional to |g|.
    """
    nodes, vectors, loads = group.nodes_per_element, group.vectors, group.loads
    position, direction, follow = at(group.position, load), at(group.direction, load), at(group.follows, load)
    gx, gy, rx, ry = 0.0, 0.0, 0.0, 0.0
    for n in range(nodes):
        for s in range(vectors):
            row, slot = (n * stride + 2 * s) * ROW, (n * vectors + s) * loads
            gx += direction[slot] * e[row]
            gy += direction[slot] * e[row + ROW]
            rx += position[slot] * e[row]
            ry += position[slot] * e[row + ROW]
    square = gx * gx + gy * gy
    # gradient of the angle of g, and its derivatives
    ax, ay = -gy / square, gx / square
    hxx = 2.0 * gx * gy / (square * square)
    hxy = (gy * gy - gx * gx) / (square * square)
    fx, fy, moment = values[0], values[1], values[2]
    ux, uy = follow[0], follow[loads]
    follows = ux != 0.0 or uy != 0.0
    # derivatives of the force with respect to g
    fxx, fxy, fyx, fyy = 0.0, 0.0, 0.0, 0.0
    if follows:
        if group.stretches[load] != 0.0:
            co, si = gx * ux + gy * uy, gy * ux - gx * uy
            fxx, fxy = ux * fx + uy * fy, uy * fx - ux * fy
            fyx, fyy = -fxy, fxx
            fx, fy = co * fx - si * fy, si * fx + co * fy
        else:
            long = math.sqrt(square)
            co, si = (gx * ux + gy * uy) / long, (gy * ux - gx * uy) / long
            fx, fy = co * fx - si * fy, si * fx + co * fy
            fxx, fxy, fyx, fyy = -fy * ax, -fy * ay, fx * ax, fx * ay
    spring, anchor = at(group.spring, load), at(group.anchor, load)
    kx, ky = spring[0], spring[loads]
    sx, sy = fx - kx * (rx - anchor[0]), fy - ky * (ry - anchor[loads])
    slots = nodes * vectors
    for slot in range(slots):
        f[2 * slot * ROW] = -position[slot * loads] * sx - direction[slot * loads] * moment * ax
        f[(2 * slot + 1) * ROW] = -position[slot * loads] * sy - direction[slot * loads] * moment * ay
    if ck == 0.0 or not (moment != 0.0 or follows or kx != 0.0 or ky != 0.0):
        return 0
    for j in range(slots):
        for i in range(slots):
            to = at(k, (4 * slots * j + 2 * i) * ROW)
            both = direction[i * loads] * direction[j * loads] * moment
            stiff = position[i * loads] * position[j * loads]
            turned = position[i * loads] * direction[j * loads]
            to[0] = ck * (-both * hxx + stiff * kx - turned * fxx)
            to[ROW] = -ck * (both * hxy + turned * fyx)
            to[2 * slots * ROW] = -ck * (both * hxy + turned * fxy)
            to[(2 * slots + 1) * ROW] = ck * (both * hxx + stiff * ky - turned * fyy)
    return 1
