"""Forces, moments and springs at points of elements; each load is a lane of a batch, whatever element it acts on."""

import math

from beamfem.kernels import record as r
from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import routine
from beamfem.kernels.gathering import gather
from beamfem.kernels.pointers import at, caller, reals, wholes
from beamfem.kernels.record import ROW

_scatter, _clear = caller("iiiiiniirr"), caller("iir")
_reduced, _forces = caller("iiiir"), caller("iiidrrrr", "i")


@routine("iii")
def add_loads(group, system, values):
    """Subtract the generalized forces of all loads of a group from its nodal forces, their tangents from the matrix.

    values: address of forces and moments (loads, 3) [N, N, N m].
    """
    b, s = wholes(group), wholes(system)
    call, x, chunks = wholes(b[r.ROUTINES]), reals(b[r.SPACE]), reals(b[r.CHUNKS])
    nodes, vectors, loads, place = (
        b[r.NODES_PER_ELEMENT],
        b[r.VECTORS],
        b[r.LOADS],
        wholes(b[r.LOAD_PLACE]),
    )
    size, tangent = 2 * vectors, s[r.TANGENT]
    ck = reals(s[r.FACTORS])[r.WEIGHT_P]
    rows = b[r.CURVATURE] if tangent != 0 else size
    _, e, f, _, _, _, _, _, _, k, _ = rows_of(nodes, vectors, b[r.POINTS], b[r.CURVATURE], b[r.TABLE_ROWS])
    e, f, k = at(x, e * ROW), at(x, f * ROW), at(x, k * ROW)
    stiff = 1 if tangent != 0 and ck != 0.0 else 0
    first = 0
    while first < loads:
        count = min(b[r.BATCH], loads - first)
        gather(nodes, count, first, loads, 0, place, rows, chunks, e)
        if stiff != 0:
            _clear(call[r.CLEAR], nodes * size * nodes * size, count, k)
        coupled = 0
        for lane in range(count):
            load_values = at(reals(values), 3 * (first + lane))
            done = _forces(
                call[r.LOAD_FORCES],
                group,
                first + lane,
                rows,
                ck * stiff,
                load_values,
                at(e, lane),
                at(f, lane),
                at(k, lane),
            )
            coupled = max(coupled, done)
        _scatter(call[r.SCATTER], nodes, count, first, loads, 0, place, size, b[r.FORCE], f, chunks)
        if s[r.PREDICTED] != 0:
            _scatter(call[r.SCATTER], nodes, count, first, loads, 0, place, size, b[r.PREDICTED_FORCE], f, chunks)
        if stiff != 0 and coupled != 0:
            _reduced(call[r.REDUCE], group, system, first, count, x)
        first += count


@routine("iiidrrrr", "i")
def load_forces(group, load, stride, ck, values, e, f, k):
    """Fill f with the negative nodal forces of a load and, unless zero, k with ck df/de; return 1 if it did, else 0.

    e (nodes, stride, ROW), f, k: pointers to the lane of the load in the first row of each. The moment acts on the
    vector g that defines the direction of the section, with virtual work M (g x delta g) / |g|^2. A follower force
    rotates with g, and a pressure is also proportional to |g|.
    """
    b = wholes(group)
    nodes, vectors, loads = b[r.NODES_PER_ELEMENT], b[r.VECTORS], b[r.LOADS]
    position, direction, follow = (
        at(reals(b[r.POSITION]), load),
        at(reals(b[r.DIRECTION]), load),
        at(reals(b[r.FOLLOWS]), load),
    )
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
        if reals(b[r.STRETCHES])[load] != 0.0:
            co, si = gx * ux + gy * uy, gy * ux - gx * uy
            fxx, fxy = ux * fx + uy * fy, uy * fx - ux * fy
            fyx, fyy = -fxy, fxx
            fx, fy = co * fx - si * fy, si * fx + co * fy
        else:
            long = math.sqrt(square)
            co, si = (gx * ux + gy * uy) / long, (gy * ux - gx * uy) / long
            fx, fy = co * fx - si * fy, si * fx + co * fy
            fxx, fxy, fyx, fyy = -fy * ax, -fy * ay, fx * ax, fx * ay
    spring, anchor = at(reals(b[r.SPRING]), load), at(reals(b[r.ANCHOR]), load)
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
