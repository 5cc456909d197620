"""Residual and tangent of forces, moments and springs at points of elements."""

import numpy as np
from numba import njit

from beamfem.kernels.coordinates import element_map
from beamfem.kernels.reduce import add_force, add_matrix


@njit(cache=True, error_model="numpy")
def assemble_point_loads(block, loads, layout, p, values, ck, residual, matrix):
    """Subtract the generalized forces of point loads from `residual`, their tangent from `matrix`.

    values (nl, 3): fx, fy [N], moment [N m]. The moment acts on the vector g that gives the section its direction:
    virtual work M (g x delta g) / |g|^2. A force that follows turns with g.
    """
    nv, npe = block.scale.shape[1], block.dof.shape[1]
    size = 2 * nv
    e, force, k = np.zeros(size), np.empty(size), np.empty((size, size))
    b = np.zeros((npe, size // block.carrier.shape[1]))
    kc = np.empty((size, npe))
    stiff = matrix.shape[0] > 0 and ck != 0.0
    for load in range(loads.element.shape[0]):
        element = loads.element[load]
        element_map(block, element, p, e, b)
        position, direction = loads.position[load], loads.direction[load]
        gx, gy, rx, ry = 0.0, 0.0, 0.0, 0.0
        for i in range(nv):
            gx += direction[i] * e[2 * i]
            gy += direction[i] * e[2 * i + 1]
            rx += position[i] * e[2 * i]
            ry += position[i] * e[2 * i + 1]
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
            force[2 * i] = -position[i] * sx - direction[i] * moment * ax
            force[2 * i + 1] = -position[i] * sy - direction[i] * moment * ay
        add_force(block, element, b, force, residual)
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
        add_matrix(block, layout, element, k, b, b, e, force, ck, 0.0, kc, matrix)
