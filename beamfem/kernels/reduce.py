"""The reduction e' = B p' of element matrices and nodal forces, and their addition to those of the model."""

from beamfem.kernels.block import GRADIENTS, ROTATION, STRETCH, TURNED_GRADIENTS
from beamfem.kernels.compiling import kernel
from beamfem.kernels.coordinates import add_node_force, node_vectors

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True)
def place_nodes(block, p, v, a, e, acceleration):
    """Fill e and e'' (N, per_node) of all nodes of a block from p, p', p'' (n,) of the whole model."""
    for node in range(block.dof.shape[0]):
        node_vectors(block, node, p, v, a, e, acceleration)


@kernel(forceinline=True)
def add_forces(block, e, force, residual):
    """Add B^T f of all nodes to the residual (n,); e and f (N, per_node)."""
    for node in range(block.dof.shape[0]):
        add_node_force(block, node, node, e, force, residual)


@kernel()
def add_turnings(block, layout, e, force, ck, matrix):
    """Add ck (dB^T/dp) f of all nodes to the matrix; e and f (N, per_node)."""
    for node in range(block.dof.shape[0]):
        add_turning(block, layout, node, node, e, force, ck, matrix)


@kernel(forceinline=True)
def add_turning(block, layout, node, row, e, force, ck, matrix):
    """Add ck (dB^T/dp) f of a node to the matrix; its e (N, per_node), f a row of force."""
    carrier = block.carrier[node]
    if carrier in (GRADIENTS, TURNED_GRADIENTS):
        return
    size, npn = e.shape[1], block.dof.shape[1]
    last = size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)
    # a vector of fixed length that turns: d2 e / dt2 = -e
    turned = -ck * (e[node, size - 2] * force[row, size - 2] + e[node, size - 1] * force[row, size - 1])
    if carrier != ROTATION:
        turned -= ck * (e[node, 2] * force[row, 2] + e[node, 3] * force[row, 3])
    element, place = block.home[node, 0], block.home[node, 1] * npn
    angle = block.dof[node, last]
    _add(layout, element, angle, angle, place + last, place + last, turned, matrix)
    if carrier == STRETCH:
        # r_x = s (cos t, sin t): d2 r_x / ds dt is the unit vector across, which is r_y
        mixed = ck * (e[node, 4] * force[row, 2] + e[node, 5] * force[row, 3])
        s = block.dof[node, 2]
        _add(layout, element, angle, s, place + last, place + 2, mixed, matrix)
        _add(layout, element, s, angle, place + 2, place + last, mixed, matrix)


@kernel(forceinline=True, fastmath=FAST)
def reduce_matrix(nn, vpn, block, element, kind, e, v, a, coefficients, k):
    """Replace k = ck K + ca M (2 nv, 2 nv) by B^T (ck K B + M C); a node's coordinates take its first places."""
    ck, cv, ca = coefficients
    size, per = 2 * nn * vpn, 2 * vpn
    for n in range(nn):
        node = block.node[element, n]
        carrier = block.carrier[node]
        if carrier == GRADIENTS:
            continue
        d = n * per + per - 2
        if carrier == TURNED_GRADIENTS:
            co, si = block.frame[node, 0], block.frame[node, 1]
            for x in range(size):
                left, right = k[x, d], k[x, d + 1]
                k[x, d], k[x, d + 1] = co * left + si * right, co * right - si * left
            continue
        dx, dy = e[node, per - 2], e[node, per - 1]
        first = n * per + 2
        to = d if carrier == ROTATION else (first + 1 if carrier == STRETCH else first)
        if carrier == ROTATION:
            for x in range(size):
                k[x, to] = dx * k[x, d + 1] - dy * k[x, d]
        else:
            rx, ry = e[node, 2], e[node, 3]
            for x in range(size):
                left, right = k[x, first], k[x, first + 1]
                if carrier == STRETCH:
                    k[x, first] = dy * left - dx * right
                k[x, to] = rx * right - ry * left + dx * k[x, d + 1] - dy * k[x, d]
        if ca != 0.0:
            _add_convective(nn, vpn, block, n, node, kind, carrier, to, e, v, a, ck, cv, k)
    for n in range(nn):
        node = block.node[element, n]
        carrier = block.carrier[node]
        if carrier == GRADIENTS:
            continue
        d = n * per + per - 2
        if carrier == TURNED_GRADIENTS:
            co, si = block.frame[node, 0], block.frame[node, 1]
            for x in range(size):
                left, right = k[d, x], k[d + 1, x]
                k[d, x], k[d + 1, x] = co * left + si * right, co * right - si * left
            continue
        dx, dy = e[node, per - 2], e[node, per - 1]
        first = n * per + 2
        if carrier == ROTATION:
            for x in range(size):
                k[d, x] = dx * k[d + 1, x] - dy * k[d, x]
        else:
            to = first + 1 if carrier == STRETCH else first
            rx, ry = e[node, 2], e[node, 3]
            for x in range(size):
                left, right = k[first, x], k[first + 1, x]
                if carrier == STRETCH:
                    k[first, x] = dy * left - dx * right
                k[to, x] = rx * right - ry * left + dx * k[d + 1, x] - dy * k[d, x]


@kernel(forceinline=True, fastmath=FAST)
def _add_convective(nn, vpn, block, n, node, kind, carrier, to, e, v, a, ck, cv, k):
    """Add M (C - ca B) of a node that turns: what the change of e'' with p and p' adds to that with p''."""
    per = 2 * vpn
    angle = block.dof[node, to - n * per]
    spin, turn = v[angle], a[angle]
    across, along = -ck * spin * spin, -ck * turn - 2.0 * cv * spin
    dx, dy = e[node, per - 2], e[node, per - 1]
    _add_mass(nn, vpn, block, kind, n * vpn + vpn - 1, to, across * -dy + along * dx, across * dx + along * dy, k)
    if carrier != ROTATION:
        rx, ry = e[node, 2], e[node, 3]
        x, y = across * -ry + along * rx, across * rx + along * ry
        if carrier == STRETCH:
            s = block.dof[node, 2]
            rate, second = v[s], a[s]
            ct, st = dy, -dx
            radial, swing = -2.0 * ck * rate * spin, ck * second + 2.0 * cv * rate
            x += radial * ct - swing * st
            y += radial * st + swing * ct
            swing = 2.0 * cv * spin + ck * turn
            sx, sy = across * ct - swing * st, across * st + swing * ct
            _add_mass(nn, vpn, block, kind, n * vpn + 1, n * per + 2, sx, sy, k)
        _add_mass(nn, vpn, block, kind, n * vpn + 1, to, x, y, k)


@kernel(forceinline=True, fastmath=FAST)
def _add_mass(nn, vpn, block, kind, slot, column, x, y, k):
    """Add the mass of a nodal vector times (x, y) to a column of k."""
    for i in range(nn * vpn):
        k[2 * i, column] += block.mass[kind, i, slot] * x
        k[2 * i + 1, column] += block.mass[kind, i, slot] * y


@kernel(forceinline=True)
def add_matrix(nn, vpn, block, layout, element, rows, k, matrix):
    """Add a reduced element matrix to that of the model; rows: work space (nn npn,)."""
    npn, per = block.dof.shape[1], 2 * vpn
    for n in range(nn):
        node = block.node[element, n]
        for own in range(npn):
            dof = block.dof[node, own]
            rows[n * npn + own] = layout.free[dof] if dof >= 0 else -1
    half = layout.half_width
    for n in range(nn):
        for own in range(npn):
            row = rows[n * npn + own]
            if row < 0:
                continue
            start = 2 * half * row + half
            for m in range(nn):
                for its in range(npn):
                    column = rows[m * npn + its]
                    if column < 0:
                        continue
                    value = k[n * per + own, m * per + its]
                    if half >= 0:
                        matrix[start + column] += value
                    else:
                        matrix[layout.slot[element, n * npn + own, m * npn + its]] += value


@kernel(forceinline=True)
def _add(layout, element, dof_i, dof_j, i, j, value, matrix):
    row, column = layout.free[dof_i], layout.free[dof_j]
    if row >= 0 and column >= 0:
        if layout.half_width >= 0:
            matrix[row * (2 * layout.half_width + 1) + layout.half_width + column - row] += value
        else:
            matrix[layout.slot[element, i, j]] += value
