"""Residual and tangent of forces, moments and springs at points of elements."""

import numpy as np
from numba import njit

from beamfem.kernels.block import GRADIENTS, TURNED_GRADIENTS
from beamfem.kernels.coordinates import add_node_force, node_columns, node_vectors
from beamfem.kernels.reduce import add_matrix, add_turning


@njit(cache=True, error_model="numpy")
def assemble_point_loads(block, loads, layout, p, values, ck, residual, matrix):
    """Subtract the generalized forces of point loads from `residual`, their tangent from `matrix`.

    values (nl, 3): fx, fy [N], moment [N m]. The moment acts on the vector g that gives the section its direction:
    virtual work M (g x delta g) / |g|^2. A force that follows turns with g.
    """
    nv, nn, npn = block.scale.shape[1], block.node.shape[1], block.dof.shape[1]
    size = 2 * nv
    per_node = size // nn
    e, force = np.zeros((nn, per_node)), np.empty((nn, per_node))
    unused, coefficients = np.empty(per_node), np.array([1.0, 0.0, 0.0])
    k, kc = np.empty((size, size)), np.empty((size, nn * npn))
    b, c = np.zeros((nn, npn, per_node)), np.zeros((nn, npn, per_node))
    vectors, forces = e.reshape(nv, 2), force.reshape(nv, 2)
    stiff = matrix.shape[0] > 0 and ck != 0.0
    for load in range(loads.element.shape[0]):
        element = loads.element[load]
        plain = True
        for n in range(nn):
            node = block.node[element, n]
            carrier, dof, frame = block.carrier[node], block.dof[node], block.frame[node]
            plain = plain and carrier == GRADIENTS
            node_vectors(carrier, dof, frame, p, p, p, e[n], unused)
            node_columns(carrier, dof, frame, e[n], p, p, coefficients, b[n], c[n])
        position, direction = loads.position[load], loads.direction[load]
        gx, gy, rx, ry = 0.0, 0.0, 0.0, 0.0
        for i in range(nv):
            gx += direction[i] * vectors[i, 0]
            gy += direction[i] * vectors[i, 1]
            rx += position[i] * vectors[i, 0]
            ry += position[i] * vectors[i, 1]
        square = gx * gx + gy * gy
        # gradient of the angle of g, and its derivatives
        ax, ay = -gy / square, gx / square
        hxx = 2.0 * gx * gy / square**2
        hxy = (gy * gy - gx * gx) / square**2
        fx, fy, moment = values[load, 0], values[load, 1], values[load, 2]
        ux, uy = loads.follows[load, 0], loads.follows[load, 1]
        follows = ux != 0.0 or uy != 0.0
        if follows:
            long = np.sqrt(square)
            co, si = (gx * ux + gy * uy) / long, (gy * ux - gx * uy) / long
            fx, fy = co * fx - si * fy, si * fx + co * fy
        kx, ky = loads.spring[load, 0], loads.spring[load, 1]
        sx = fx - kx * (rx - loads.anchor[load, 0])
        sy = fy - ky * (ry - loads.anchor[load, 1])
        for i in range(nv):
            forces[i, 0] = -position[i] * sx - direction[i] * moment * ax
            forces[i, 1] = -position[i] * sy - direction[i] * moment * ay
        for n in range(nn):
            node = block.node[element, n]
            add_node_force(block.carrier[node], block.dof[node], block.frame[node], e[n], force[n], residual)
        if not stiff:
            continue
        for i in range(nv):
            for j in range(nv):
                both = direction[i] * direction[j] * moment
                spring = position[i] * position[j]
                k[2 * i, 2 * j] = -both * hxx + spring * kx
                k[2 * i + 1, 2 * j + 1] = both * hxx + spring * ky
                k[2 * i, 2 * j + 1] = -both * hxy
                k[2 * i + 1, 2 * j] = -both * hxy
                if follows:
                    turned = position[i] * direction[j]
                    k[2 * i, 2 * j] += turned * fy * ax
                    k[2 * i, 2 * j + 1] += turned * fy * ay
                    k[2 * i + 1, 2 * j] -= turned * fx * ax
                    k[2 * i + 1, 2 * j + 1] -= turned * fx * ay
        add_matrix(block, layout, element, plain, k, b, c, ck, 0.0, kc, matrix)
        for n in range(nn):
            node = block.node[element, n]
            if block.carrier[node] not in (GRADIENTS, TURNED_GRADIENTS):
                add_turning(block, layout, node, e[n], force[n], ck, matrix)
