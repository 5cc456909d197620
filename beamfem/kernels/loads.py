"""Residual and tangent of forces and moments at points of elements."""

import numpy as np
from numba import njit

from beamfem.kernels.coordinates import element_map


@njit(cache=True, error_model="numpy")
def assemble_point_loads(block, loads, layout, p, values, ck, residual, matrix):
    """Subtract the generalized forces of point loads from `residual`, their tangent from `matrix`.

    values (nl, 3): fx, fy [N], moment [N m]. The moment acts on d: virtual work M (d x delta d) / |d|^2.
    """
    nn, nv = block.frame.shape[1], block.scale.shape[1]
    npe = block.dof.shape[1]
    npn, per_node = npe // nn, 2 * nv // nn
    nr, nd = block.r_slots.shape[0], block.d_slots.shape[0]
    e = np.zeros(2 * nv)
    b = np.zeros((npe, per_node))
    force = np.empty(2 * nv)
    for load in range(loads.element.shape[0]):
        element = loads.element[load]
        element_map(block, element, p, e, b)
        moment = values[load, 2]
        dx, dy = 0.0, 0.0
        for i in range(nd):
            dx += loads.d[load, i] * e[2 * block.d_slots[i]]
            dy += loads.d[load, i] * e[2 * block.d_slots[i] + 1]
        square = dx * dx + dy * dy
        gx, gy = -dy / square, dx / square
        # derivative of (-dy, dx) / |d|^2 with respect to d, symmetric
        hxx = 2.0 * dx * dy / square**2
        hxy = (dy * dy - dx * dx) / square**2
        force[:] = 0.0
        for i in range(nr):
            force[2 * block.r_slots[i]] -= loads.r[load, i] * values[load, 0]
            force[2 * block.r_slots[i] + 1] -= loads.r[load, i] * values[load, 1]
        for i in range(nd):
            force[2 * block.d_slots[i]] -= loads.d[load, i] * moment * gx
            force[2 * block.d_slots[i] + 1] -= loads.d[load, i] * moment * gy
        for i in range(npe):
            base = (i // npn) * per_node
            start, stop = block.column_start[i % npn], block.column_stop[i % npn]
            total = 0.0
            for x in range(start, stop):
                total += b[i, x] * force[base + x]
            residual[block.dof[element, i]] += total
            row = layout.free[block.dof[element, i]]
            if matrix.shape[0] == 0 or ck == 0.0 or row < 0:
                continue
            for j in range(npe):
                column = layout.free[block.dof[element, j]]
                if column < 0:
                    continue
                ni = _director(block, loads, load, i // npn, start, per_node)
                nj = _director(block, loads, load, j // npn, block.column_start[j % npn], per_node)
                value = 0.0
                if ni != 0.0 and nj != 0.0 and moment != 0.0:
                    ix, iy = _pair(b, i, start, stop, per_node)
                    jx, jy = _pair(b, j, block.column_start[j % npn], block.column_stop[j % npn], per_node)
                    value -= moment * ni * nj * (hxx * (ix * jx - iy * jy) + hxy * (ix * jy + iy * jx))
                if i == j and stop - start == 2:
                    for x in range(start, stop):
                        value -= e[base + x] * force[base + x]
                if layout.half_width >= 0:
                    matrix[row * (2 * layout.half_width + 1) + layout.half_width + column - row] += ck * value
                else:
                    matrix[layout.slot[element, i, j]] += ck * value


@njit(cache=True, inline="always", error_model="numpy")
def _director(block, loads, load, node, start, per_node):
    """N_d of the node where the coordinate moves d, else zero."""
    return loads.d[load, node] if start >= per_node - 2 else 0.0


@njit(cache=True, inline="always", error_model="numpy")
def _pair(b, i, start, stop, per_node):
    """Both components of d that coordinate i moves."""
    first = per_node - 2
    x = b[i, first] if start <= first < stop else 0.0
    y = b[i, first + 1] if start <= first + 1 < stop else 0.0
    return x, y
