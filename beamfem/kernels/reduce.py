"""The reduction e' = B p' of element matrices and nodal forces, and their addition to those of the model."""

from numba import njit

from beamfem.kernels.block import GRADIENTS, STRETCH, TURNED_GRADIENTS
from beamfem.kernels.coordinates import add_node_force, node_columns, node_vectors


@njit(cache=True, error_model="numpy")
def place_nodes(block, p, v, a, e, acceleration):
    """Fill e and e'' (N, per_node) of all nodes of a block from p, p', p'' (n,) of the whole model."""
    for node in range(block.dof.shape[0]):
        carrier, dof, frame = block.carrier[node], block.dof[node], block.frame[node]
        node_vectors(carrier, dof, frame, p, v, a, e[node], acceleration[node])


@njit(cache=True, error_model="numpy")
def add_forces(block, e, force, residual):
    """Add B^T f of all nodes to the residual (n,); e and f (N, per_node)."""
    for node in range(block.dof.shape[0]):
        add_node_force(block.carrier[node], block.dof[node], block.frame[node], e[node], force[node], residual)


@njit(cache=True, error_model="numpy")
def add_turnings(block, layout, e, force, ck, matrix):
    """Add ck (dB^T/dp) f of all nodes to the matrix; e and f (N, per_node)."""
    for node in range(block.dof.shape[0]):
        if block.carrier[node] not in (GRADIENTS, TURNED_GRADIENTS):
            add_turning(block, layout, node, e[node], force[node], ck, matrix)


@njit(cache=True, error_model="numpy")
def add_turning(block, layout, node, e, force, ck, matrix):
    """Add ck (dB^T/dp) f of a node: second derivatives of e (per_node,) with its angle, and with its stretch."""
    carrier, npn = block.carrier[node], block.dof.shape[1]
    last = npn - 1
    while block.dof[node, last] < 0:
        last -= 1
    turned = 0.0
    for x in range(block.column_start[carrier, last], block.column_stop[carrier, last]):
        # a vector of fixed length that turns: d2 e / dt2 = -e
        turned -= ck * e[x] * force[x]
    element, place = block.home[node, 0], block.home[node, 1] * npn
    angle = block.dof[node, last]
    _add(layout, element, angle, angle, place + last, place + last, turned, matrix)
    if carrier == STRETCH:
        # r_x = s (cos t, sin t): d2 r_x / ds dt is the unit vector across, which is r_y
        mixed = ck * (e[4] * force[2] + e[5] * force[3])
        s = block.dof[node, 2]
        _add(layout, element, angle, s, place + last, place + 2, mixed, matrix)
        _add(layout, element, s, angle, place + 2, place + last, mixed, matrix)


@njit(cache=True, error_model="numpy")
def element_columns(block, element, e, v, a, coefficients, b, c):
    """Fill the columns of B and C, b and c (nn, npn, per_node), of an element; tell whether e = p at all its nodes."""
    plain = True
    for local in range(block.node.shape[1]):
        node = block.node[element, local]
        carrier = block.carrier[node]
        plain = plain and carrier == GRADIENTS
        node_columns(carrier, block.dof[node], block.frame[node], e[node], v, a, coefficients, b[local], c[local])
    return plain


@njit(cache=True, error_model="numpy")
def add_matrix(block, layout, element, plain, k, b, c, ck, ca, kc, matrix):
    """Add B^T (ck K B + M C) of an element to the matrix; k (2 nv, 2 nv), kc (2 nv, nn npn) work space."""
    nn, npn = block.node.shape[1], block.dof.shape[1]
    kind = block.kind[element]
    size = k.shape[0]
    per_node = size // nn
    if plain:
        for i in range(size):
            for j in range(size):
                kc[i, j] = ck * k[i, j]
            if ca != 0.0:
                for j in range(i % 2, size, 2):
                    kc[i, j] += ca * block.mass[kind, i // 2, j // 2]
    else:
        kc[:, :] = 0.0
        for local in range(nn):
            node = block.node[element, local]
            carrier, first = block.carrier[node], local * per_node
            for own in range(npn):
                if block.dof[node, own] < 0:
                    continue
                j = local * npn + own
                for y in range(block.column_start[carrier, own], block.column_stop[carrier, own]):
                    if ck != 0.0:
                        factor = ck * b[local, own, y]
                        for x in range(size):
                            kc[x, j] += factor * k[first + y, x]
                    if ca != 0.0:
                        slot, component, factor = (first + y) // 2, (first + y) % 2, c[local, own, y]
                        for i in range(size // 2):
                            kc[2 * i + component, j] += factor * block.mass[kind, i, slot]
    width = 2 * layout.half_width + 1
    for local in range(nn):
        node = block.node[element, local]
        carrier, base = block.carrier[node], local * per_node
        for own in range(npn):
            dof = block.dof[node, own]
            row = layout.free[dof] if dof >= 0 else -1
            if row < 0:
                continue
            lo, hi = base + block.column_start[carrier, own], base + block.column_stop[carrier, own]
            for other in range(nn):
                neighbour = block.node[element, other]
                for its in range(npn):
                    dof = block.dof[neighbour, its]
                    column = layout.free[dof] if dof >= 0 else -1
                    if column < 0:
                        continue
                    j = other * npn + its
                    total = kc[lo, j]
                    if not plain:
                        total *= b[local, own, lo - base]
                        for x in range(lo + 1, hi):
                            total += b[local, own, x - base] * kc[x, j]
                    if layout.half_width >= 0:
                        matrix[row * width + layout.half_width + column - row] += total
                    else:
                        matrix[layout.slot[element, local * npn + own, j]] += total


@njit(cache=True, inline="always", error_model="numpy")
def _add(layout, element, dof_i, dof_j, i, j, value, matrix):
    row, column = layout.free[dof_i], layout.free[dof_j]
    if row >= 0 and column >= 0:
        if layout.half_width >= 0:
            matrix[row * (2 * layout.half_width + 1) + layout.half_width + column - row] += value
        else:
            matrix[layout.slot[element, i, j]] += value
