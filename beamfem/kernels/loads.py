"""Residual and tangent of forces, moments and springs at points of elements."""

import math

from beamfem.kernels.compiling import kernel
from beamfem.kernels.coordinates import add_node_force
from beamfem.kernels.reduce import add_matrix, add_turning, reduce_matrix


@kernel()
def assemble_point_loads(block, loads, layout, work, values, ck, residual, matrix):
    """Subtract the generalized forces of point loads from `residual`, their tangent from `matrix`.

    work: holds the nodal vectors. values (nl, 3): fx, fy [N], moment [N m]. The moment acts on the vector g that gives
    the section its direction: virtual work M (g x delta g) / |g|^2. A force that follows turns with g, a pressure grows
    with |g| as well. Loads of one element that stand in a row are added up before they go to the model.
    """
    count = loads.element.shape[0]
    if count == 0:
        return
    nv, nn = block.scale.shape[1], block.node.shape[1]
    vpn = nv // nn
    e, force, k, rows = work.nodes[0], work.nodes[3], work.matrix, work.rows
    stiff = matrix.shape[0] > 0 and ck != 0.0
    coupled = False
    for load in range(count):
        element = loads.element[load]
        if load == 0 or loads.element[load - 1] != element:
            coupled = False
            for n in range(nn):
                for i in range(2 * vpn):
                    force[n, i] = 0.0
        position, direction = loads.position[load], loads.direction[load]
        gx, gy, rx, ry = 0.0, 0.0, 0.0, 0.0
        for i in range(nv):
            x, y = e[block.node[element, i // vpn], 2 * (i % vpn)], e[block.node[element, i // vpn], 2 * (i % vpn) + 1]
            gx += direction[i] * x
            gy += direction[i] * y
            rx += position[i] * x
            ry += position[i] * y
        square = gx * gx + gy * gy
        # gradient of the angle of g, and its derivatives
        ax, ay = -gy / square, gx / square
        hxx = 2.0 * gx * gy / square**2
        hxy = (gy * gy - gx * gx) / square**2
        fx, fy, moment = values[load, 0], values[load, 1], values[load, 2]
        ux, uy = loads.follows[load, 0], loads.follows[load, 1]
        follows = ux != 0.0 or uy != 0.0
        # derivatives of the force by g
        fxx, fxy, fyx, fyy = 0.0, 0.0, 0.0, 0.0
        if follows:
            if loads.stretches[load]:
                co, si = gx * ux + gy * uy, gy * ux - gx * uy
                fxx, fxy = ux * fx + uy * fy, uy * fx - ux * fy
                fyx, fyy = -fxy, fxx
                fx, fy = co * fx - si * fy, si * fx + co * fy
            else:
                long = math.sqrt(square)
                co, si = (gx * ux + gy * uy) / long, (gy * ux - gx * uy) / long
                fx, fy = co * fx - si * fy, si * fx + co * fy
                fxx, fxy, fyx, fyy = -fy * ax, -fy * ay, fx * ax, fx * ay
        kx, ky = loads.spring[load, 0], loads.spring[load, 1]
        sx = fx - kx * (rx - loads.anchor[load, 0])
        sy = fy - ky * (ry - loads.anchor[load, 1])
        for i in range(nv):
            force[i // vpn, 2 * (i % vpn)] -= position[i] * sx + direction[i] * moment * ax
            force[i // vpn, 2 * (i % vpn) + 1] -= position[i] * sy + direction[i] * moment * ay
        if stiff and (moment != 0.0 or follows or kx != 0.0 or ky != 0.0):
            if not coupled:
                coupled = True
                for i in range(2 * nv):
                    for j in range(2 * nv):
                        k[i, j] = 0.0
            for i in range(nv):
                for j in range(nv):
                    both = direction[i] * direction[j] * moment
                    spring = position[i] * position[j]
                    turned = position[i] * direction[j]
                    k[2 * i, 2 * j] += ck * (-both * hxx + spring * kx - turned * fxx)
                    k[2 * i + 1, 2 * j + 1] += ck * (both * hxx + spring * ky - turned * fyy)
                    k[2 * i, 2 * j + 1] -= ck * (both * hxy + turned * fxy)
                    k[2 * i + 1, 2 * j] -= ck * (both * hxy + turned * fyx)
        if load + 1 < count and loads.element[load + 1] == element:
            continue
        for n in range(nn):
            add_node_force(block, block.node[element, n], n, e, force, residual)
        if not stiff:
            continue
        for n in range(nn):
            add_turning(block, layout, block.node[element, n], n, e, force, ck, matrix)
        if coupled:
            reduce_matrix(nn, vpn, block, element, block.kind[element], e, k[0], k[0], (ck, 0.0, 0.0), k)
            add_matrix(nn, vpn, block, layout, element, rows, k, matrix)
