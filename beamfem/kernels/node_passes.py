"""Loops over the nodes of a group: from coordinates to nodal vectors, and from nodal forces to the residual."""

from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import LANES, ROW, Group, System
from beamfem.kernels.nodes import put, take
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.reduction import add_node_forces
from beamfem.kernels.simd import WIDTH, as_rows


@inlined
def _of_run(run, size):
    """Return the kind of the nodes of a run, first node and end, numbers of linear and of polar coordinates."""
    kind, linear, polar = run.node_kind, size, 1
    if kind == ROTATION:
        linear = size - 2
    elif kind in (STRETCH, SHEAR_RIGID):
        linear = size - 4
    if kind == STRETCH:
        polar = 2
    return kind, run.first, run.first + run.length, linear, polar


@routine()
def place_nodes(group: Group, system: System, moving: int) -> None:
    """Fill the chunks of a group with nodal vectors and B, and set nodal forces to zero.

    If `moving`, also fill accelerations and, for a tangent, the derivatives of e''. They include the damping of the
    mass: as e'' = B p'' + B' p', with p'' + c p' in place of p'' they are e'' + c e'.
    """
    small_code()
    call = group.routines
    runs, stride, size = group.runs, group.nodes, 2 * group.vectors
    source, frame, chunks, x = group.source, group.frame, group.chunks, group.space
    p, v, a = system.p, system.v, system.a
    if moving != 0 and group.mass_damping != 0.0:
        a = group.slowed
        for i in range(system.size):
            a[i] = system.a[i] + group.mass_damping * v[i]
    dependent, parameters = group.dependent, group.parameters
    force_rows = 2 * group.vectors if system.predicted == 0 else group.predicted_force + 2 * group.vectors - group.force
    for run in range(group.run_count):
        kind, first, end, linear, polar = _of_run(runs[run], size)
        while first < end:
            lane = first % LANES
            count = min(LANES - lane, end - first)
            last = lane + count == LANES or first + count == stride
            chunk = at(chunks, first // LANES * group.node_rows * ROW + lane)
            forces = as_rows(at(chunk, group.force * ROW))
            for i in range(0, count, WIDTH):
                for row in range(i, i + force_rows * ROW, ROW):
                    forces[row] = 0.0
            take(first, count, linear, stride, source, p, last, chunk)
            if moving != 0:
                take(first, count, linear, stride, source, a, last, at(chunk, group.acceleration * ROW))
            if kind == ROTATED_GRADIENTS:
                c, t = at(frame, first), at(frame, stride + first)
                call.rotate(count, c, t, at(chunk, (size - 2) * ROW))
                if moving != 0:
                    call.rotate(count, c, t, at(chunk, (group.acceleration + size - 2) * ROW))
            elif kind != GRADIENTS:
                take(first, count, polar, stride, at(source, linear * stride), p, True, x)
                if moving != 0:
                    take(first, count, polar, stride, at(source, linear * stride), v, True, at(x, polar * ROW))
                    take(first, count, polar, stride, at(source, linear * stride), a, True, at(x, 2 * polar * ROW))
                else:
                    call.clear(2 * polar, count, at(x, polar * ROW))
                directions = at(x, 3 * polar * ROW)
                call.rotate_frame(count, stride, at(x, (polar - 1) * ROW), at(frame, first), directions)
                call.nodes[kind - 1].place(count, x)
                parts, result = size - linear, at(directions, 3 * ROW)
                put(parts, count, last, result, at(chunk, linear * ROW))
                if moving != 0:
                    put(parts, count, last, at(result, parts * ROW), at(chunk, (group.acceleration + linear) * ROW))
                # where kinds of nodes are mixed, b of a node may be smaller: it takes the last rows and columns
                corner = (dependent - parts) * parameters + linear - (size - dependent)
                for part in range(parts):
                    to = at(chunk, (group.transform + corner + part * parameters) * ROW)
                    put(polar, count, last, at(result, (2 * parts + part * polar) * ROW), to)
                if moving != 0 and system.tangent != 0:
                    call.nodes[kind - 1].convect(count, system.weight_p, system.weight_v, x)
                    for part in range(parts):
                        to = at(chunk, (group.convective + corner + part * parameters) * ROW)
                        put(polar, count, last, at(result, part * polar * ROW), to)
                    if group.damped != 0:
                        call.nodes[kind - 1].convect(count, 0.0, 0.5, x)  # half of de''/dp' is B'
                        for part in range(parts):
                            to = at(chunk, (group.turning + corner + part * parameters) * ROW)
                            put(polar, count, last, at(result, part * polar * ROW), to)
            first += count


@routine()
def finish_nodes(group: Group, system: System) -> None:
    """Add the nodal forces B^T f of a group to the residual, and their derivatives at constant f to the matrix."""
    small_code()
    call = group.routines
    runs, stride, size = group.runs, group.nodes, 2 * group.vectors
    dof, source, frame, chunks, x = group.dof, group.source, group.frame, group.chunks, group.space
    p, residual, dependent, parameters = system.p, system.residual, group.dependent, group.parameters
    forces = group.predicted_force if system.predicted != 0 else group.force
    first = 0
    while first < stride:
        count, chunk = min(LANES, stride - first), at(chunks, first // LANES * group.node_rows * ROW)
        add_node_forces(
            first, count, size, dependent, parameters, stride, dof, group.transform, group.force, chunk, x, residual
        )
        first += count
    if system.tangent == 0 or system.weight_p == 0.0:
        return
    for run in range(group.run_count):
        kind, first, end, linear, polar = _of_run(runs[run], size)
        if kind in (GRADIENTS, ROTATED_GRADIENTS):
            continue
        while first < end:
            lane = first % LANES
            count = min(LANES - lane, end - first)
            last = lane + count == LANES or first + count == stride
            chunk = at(chunks, first // LANES * group.node_rows * ROW + lane)
            take(first, count, polar, stride, at(source, linear * stride), p, True, x)
            directions, parts = at(x, 3 * polar * ROW), size - linear
            call.rotate_frame(count, stride, at(x, (polar - 1) * ROW), at(frame, first), directions)
            put(parts, count, True, at(chunk, (forces + linear) * ROW), at(directions, 3 * ROW))
            call.nodes[kind - 1].curve(count, x)
            put(polar * polar, count, last, at(directions, (3 + parts) * ROW), at(chunk, group.curvature * ROW))
            call.add_curvature(group, system, first, count, linear, polar, chunk)
            first += count
