"""Loops over the nodes of a group: from coordinates to nodal vectors, and from nodal forces to the residual."""

from beamfem.kernels import record as r
from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.nodes import put, take
from beamfem.kernels.pointers import at, caller, reals, slots, small_code, wholes
from beamfem.kernels.record import LANES, ROW
from beamfem.kernels.reduction import add_node_forces
from beamfem.kernels.simd import WIDTH, as_rows

_rotate_frame, _rotate = caller("irrrrr"), caller("irrr")
_clear, _place, _convect = caller("iir"), caller("ir"), caller("iddr")
_add_curvature = caller("iiiiiiiinnnisrrd")


@inlined
def _of_run(runs, run):
    """Return the kind of the nodes of a run, the first node and the end."""
    own = at(runs, r.RUN_FIELDS * run)
    return own[r.RUN_KIND], own[r.RUN_FIRST], own[r.RUN_FIRST] + own[r.RUN_LENGTH]


@routine("iii")
def place_nodes(group, system, moving):
    """Fill the chunks of a group with nodal vectors and B, and set nodal forces to zero.

    If `moving`, also fill accelerations and, for a tangent, the derivatives of e''.
    """
    small_code()
    b, s = wholes(group), wholes(system)
    call = wholes(b[r.ROUTINES])
    runs, stride, size = wholes(b[r.RUNS]), b[r.NODES], 2 * b[r.VECTORS]
    source, frame, chunks, x = (
        wholes(b[r.SOURCE]),
        reals(b[r.FRAME]),
        reals(b[r.CHUNKS]),
        reals(b[r.SPACE]),
    )
    p, v, a = (
        reals(s[r.COORDINATES_P]),
        reals(s[r.COORDINATES_V]),
        reals(s[r.COORDINATES_A]),
    )
    dependent, parameters, factors = b[r.DEPENDENT], b[r.PARAMETERS], reals(s[r.FACTORS])
    force_rows = 2 * b[r.VECTORS] if s[r.PREDICTED] == 0 else b[r.PREDICTED_FORCE] + 2 * b[r.VECTORS] - b[r.FORCE]
    for run in range(b[r.RUN_COUNT]):
        kind, first, end = _of_run(runs, run)
        linear = size
        if kind == ROTATION:
            linear = size - 2
        elif kind in (STRETCH, SHEAR_RIGID):
            linear = size - 4
        polar = 2 if kind == STRETCH else 1
        while first < end:
            lane = first % LANES
            count = min(LANES - lane, end - first)
            last = lane + count == LANES or first + count == stride
            chunk = at(chunks, first // LANES * b[r.NODE_ROWS] * ROW + lane)
            forces = as_rows(at(chunk, b[r.FORCE] * ROW))
            for i in range(0, count, WIDTH):
                for row in range(i, i + force_rows * ROW, ROW):
                    forces[row] = 0.0
            take(first, count, linear, stride, source, p, last, chunk)
            if moving != 0:
                take(first, count, linear, stride, source, a, last, at(chunk, b[r.ACCELERATION] * ROW))
            if kind == ROTATED_GRADIENTS:
                c, t = at(frame, first), at(frame, stride + first)
                _rotate(call[r.ROTATE], count, c, t, at(chunk, (size - 2) * ROW))
                if moving != 0:
                    _rotate(call[r.ROTATE], count, c, t, at(chunk, (b[r.ACCELERATION] + size - 2) * ROW))
            elif kind != GRADIENTS:
                take(first, count, polar, stride, at(source, linear * stride), p, True, x)
                if moving != 0:
                    take(first, count, polar, stride, at(source, linear * stride), v, True, at(x, polar * ROW))
                    take(first, count, polar, stride, at(source, linear * stride), a, True, at(x, 2 * polar * ROW))
                else:
                    _clear(call[r.CLEAR], 2 * polar, count, at(x, polar * ROW))
                directions = at(x, 3 * polar * ROW)
                _rotate_frame(
                    call[r.ROTATE_FRAME],
                    count,
                    at(x, (polar - 1) * ROW),
                    at(frame, first),
                    at(frame, stride + first),
                    at(frame, 2 * stride + first),
                    directions,
                )
                _place(call[r.PLACE_KIND + 3 * (kind - 1)], count, x)
                parts, result = size - linear, at(directions, 3 * ROW)
                put(parts, count, last, result, at(chunk, linear * ROW))
                if moving != 0:
                    put(
                        parts,
                        count,
                        last,
                        at(result, parts * ROW),
                        at(chunk, (b[r.ACCELERATION] + linear) * ROW),
                    )
                # where kinds of nodes are mixed, b of a node may be smaller: it takes the last rows and columns
                corner = (dependent - parts) * parameters + linear - (size - dependent)
                for part in range(parts):
                    to = at(chunk, (b[r.TRANSFORM] + corner + part * parameters) * ROW)
                    put(polar, count, last, at(result, (2 * parts + part * polar) * ROW), to)
                if moving != 0 and s[r.TANGENT] != 0:
                    _convect(
                        call[r.PLACE_KIND + 3 * (kind - 1) + 1], count, factors[r.WEIGHT_P], factors[r.WEIGHT_V], x
                    )
                    for part in range(parts):
                        to = at(chunk, (b[r.CONVECTIVE] + corner + part * parameters) * ROW)
                        put(polar, count, last, at(result, part * polar * ROW), to)
            first += count


@routine("ii")
def finish_nodes(group, system):
    """Add the nodal forces B^T f of a group to the residual, and their derivatives at constant f to the matrix."""
    small_code()
    b, s = wholes(group), wholes(system)
    call = wholes(b[r.ROUTINES])
    runs, stride, size = wholes(b[r.RUNS]), b[r.NODES], 2 * b[r.VECTORS]
    dof, source, frame, chunks, x = (
        wholes(b[r.DOF]),
        wholes(b[r.SOURCE]),
        reals(b[r.FRAME]),
        reals(b[r.CHUNKS]),
        reals(b[r.SPACE]),
    )
    p, residual, dependent, parameters = (
        reals(s[r.COORDINATES_P]),
        reals(s[r.RESIDUAL]),
        b[r.DEPENDENT],
        b[r.PARAMETERS],
    )
    forces = b[r.PREDICTED_FORCE] if s[r.PREDICTED] != 0 else b[r.FORCE]
    first = 0
    while first < stride:
        count, chunk = min(LANES, stride - first), at(chunks, first // LANES * b[r.NODE_ROWS] * ROW)
        add_node_forces(
            first,
            count,
            size,
            dependent,
            parameters,
            stride,
            dof,
            b[r.TRANSFORM],
            b[r.FORCE],
            chunk,
            x,
            residual,
        )
        first += count
    factor = reals(s[r.FACTORS])[r.WEIGHT_P]
    if s[r.TANGENT] == 0 or factor == 0.0:
        return
    for run in range(b[r.RUN_COUNT]):
        kind, first, end = _of_run(runs, run)
        if kind in (GRADIENTS, ROTATED_GRADIENTS):
            continue
        linear = size - 2 if kind == ROTATION else size - 4
        polar = 2 if kind == STRETCH else 1
        while first < end:
            lane = first % LANES
            count = min(LANES - lane, end - first)
            last = lane + count == LANES or first + count == stride
            chunk = at(chunks, first // LANES * b[r.NODE_ROWS] * ROW + lane)
            take(first, count, polar, stride, at(source, linear * stride), p, True, x)
            directions, parts = at(x, 3 * polar * ROW), size - linear
            _rotate_frame(
                call[r.ROTATE_FRAME],
                count,
                at(x, (polar - 1) * ROW),
                at(frame, first),
                at(frame, stride + first),
                at(frame, 2 * stride + first),
                directions,
            )
            put(parts, count, True, at(chunk, (forces + linear) * ROW), at(directions, 3 * ROW))
            _place(call[r.PLACE_KIND + 3 * (kind - 1) + 2], count, x)
            put(
                polar * polar,
                count,
                last,
                at(directions, (3 + parts) * ROW),
                at(chunk, b[r.CURVATURE] * ROW),
            )
            _add_curvature(
                call[r.ADD_CURVATURE],
                first,
                count,
                b[r.NODES_PER_ELEMENT],
                linear,
                polar,
                stride,
                b[r.CURVATURE],
                b[r.COORDINATES],
                dof,
                wholes(b[r.FREE]),
                wholes(b[r.HOME]),
                b[r.HALF_WIDTH],
                slots(b[r.SLOT]),
                chunk,
                reals(s[r.MATRIX]),
                factor,
            )
            first += count
