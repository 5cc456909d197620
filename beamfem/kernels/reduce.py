"""The reduction e' = B p' of an element's force and matrix, and their addition to those of the model."""

from numba import njit

from beamfem.kernels.block import GRADIENTS, STRETCH, TURNED_GRADIENTS


@njit(cache=True, error_model="numpy")
def add_force(block, element, b, force, residual):
    """Add B^T f to the residual (n,); force (2 nv,)."""
    nn, npe = block.carrier.shape[1], block.dof.shape[1]
    npn, per_node = npe // nn, force.shape[0] // nn
    for node in range(nn):
        carrier, base = block.carrier[element, node], node * per_node
        for j in range(npn):
            i = node * npn + j
            dof = block.dof[element, i]
            if dof < 0:
                continue
            total = 0.0
            for x in range(block.column_start[carrier, j], block.column_stop[carrier, j]):
                total += b[i, x] * force[base + x]
            residual[dof] += total


@njit(cache=True, error_model="numpy")
def add_matrix(block, layout, element, k, b, c, e, geometric, ck, ca, kc, matrix):
    """Add B^T (ck K B + M C) + ck (dB^T/dp) f to the matrix; k (2 nv, 2 nv), geometric f (2 nv,), kc work space."""
    nn, npe = block.carrier.shape[1], block.dof.shape[1]
    npn, per_node = npe // nn, e.shape[0] // nn
    _columns(block, element, k, b, c, ck, ca, kc)
    for node in range(nn):
        carrier, base = block.carrier[element, node], node * per_node
        for own in range(npn):
            i = node * npn + own
            dof = block.dof[element, i]
            row = layout.free[dof] if dof >= 0 else -1
            if row < 0:
                continue
            lo, hi = block.column_start[carrier, own], block.column_stop[carrier, own]
            for j in range(npe):
                column = layout.free[block.dof[element, j]] if block.dof[element, j] >= 0 else -1
                if column < 0:
                    continue
                total = 0.0
                for x in range(lo, hi):
                    total += b[i, x] * kc[base + x, j]
                if layout.half_width >= 0:
                    matrix[row * (2 * layout.half_width + 1) + layout.half_width + column - row] += total
                else:
                    matrix[layout.slot[element, i, j]] += total
        if ck != 0.0 and carrier != GRADIENTS and carrier != TURNED_GRADIENTS:
            _add_turning(block, layout, element, node, carrier, e, geometric, ck, matrix)


@njit(cache=True, inline="always", error_model="numpy")
def _columns(block, element, k, b, c, ck, ca, kc):
    """Fill kc = ck K B + M C; the change of the element's force with each coordinate, e components in rows."""
    size, npe = kc.shape
    nn = block.carrier.shape[1]
    npn, per_node = npe // nn, size // nn
    kind = block.kind[element]
    kc[:, :] = 0.0
    for j in range(npe):
        if block.dof[element, j] < 0:
            continue
        node, own = j // npn, j % npn
        carrier, first = block.carrier[element, node], node * per_node
        for y in range(block.column_start[carrier, own], block.column_stop[carrier, own]):
            if ck != 0.0:
                factor = ck * b[j, y]
                for x in range(size):
                    kc[x, j] += k[x, first + y] * factor
            if ca != 0.0:
                slot, component = (first + y) // 2, (first + y) % 2
                for i in range(size // 2):
                    kc[2 * i + component, j] += block.mass[kind, i, slot] * c[j, y]


@njit(cache=True, error_model="numpy")
def _add_turning(block, layout, element, node, carrier, e, geometric, ck, matrix):
    """Second derivatives of e with respect to a node's angle, and with its stretch, times the force."""
    nn, npe = block.carrier.shape[1], block.dof.shape[1]
    npn, base = npe // nn, node * (e.shape[0] // nn)
    last = npn - 1
    while block.dof[element, node * npn + last] < 0:
        last -= 1
    turned = 0.0
    for x in range(block.column_start[carrier, last], block.column_stop[carrier, last]):
        # a vector of fixed length that turns: d2 e / dt2 = -e
        turned -= ck * e[base + x] * geometric[base + x]
    i = node * npn + last
    _add(layout, element, block.dof[element, i], block.dof[element, i], i, i, turned, matrix)
    if carrier == STRETCH:
        # r_x = s (cos t, sin t): d2 r_x / ds dt is the unit vector across, which is r_y
        mixed = ck * (e[base + 4] * geometric[base + 2] + e[base + 5] * geometric[base + 3])
        s = node * npn + 2
        _add(layout, element, block.dof[element, i], block.dof[element, s], i, s, mixed, matrix)
        _add(layout, element, block.dof[element, s], block.dof[element, i], s, i, mixed, matrix)


@njit(cache=True, inline="always", error_model="numpy")
def _add(layout, element, dof_i, dof_j, i, j, value, matrix):
    row, column = layout.free[dof_i], layout.free[dof_j]
    if row >= 0 and column >= 0:
        if layout.half_width >= 0:
            matrix[row * (2 * layout.half_width + 1) + layout.half_width + column - row] += value
        else:
            matrix[layout.slot[element, i, j]] += value
