"""Residual and tangent of a block of elements: strains, stresses, inertia, reduction e' = B p' and scatter in one pass.

Residual of the reduced equations: B^T (M e'' + F_el(e) - F_body), tangent with respect to an unknown increment that
changes p, p', p'' by ck, cv, ca times itself (see `coordinates`).
"""

import numpy as np
from numba import njit

from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.measures import measure, measure_hessian
from beamfem.kernels.reduce import add_forces, add_matrix, add_turnings, element_columns, place_nodes

FAST = {"contract", "reassoc", "nsz"}


@njit(cache=True, error_model="numpy")
def assemble(block, layout, p, v, a, body, coefficients, geometric_stress, residual, matrix):
    """Add the residual of all elements to `residual` (n,) and their tangent to `matrix` (flat).

    body: (beams, 4) acceleration of gravity [m/s^2] and load per length [N/m] of each beam.
    coefficients: (ck, cv, ca); (1, 0, 0) in statics, (0, 0, 1) gives the mass matrix; ca = 0 leaves inertia out.
    geometric_stress: (ne, nq, ns) stress resultants for the geometric part of the tangent, or ne = 0 for the true ones.
    matrix: empty where only the residual is wanted.
    """
    shape = (block.dof.shape[0], 2 * block.scale.shape[1] // block.node.shape[1])
    e, acceleration = np.empty(shape), np.empty(shape)
    force = np.zeros(shape)
    place_nodes(block, p, v, a, e, acceleration)
    if matrix.shape[0] == 0:
        add_element_forces(block, e, acceleration, body, coefficients[2] != 0.0, force)
        add_forces(block, e, force, residual)
        return
    geometric = np.zeros(shape)
    add_elements(block, layout, e, acceleration, v, a, body, coefficients, geometric_stress, force, geometric, matrix)
    add_forces(block, e, force, residual)
    add_turnings(block, layout, e, geometric, coefficients[0], matrix)


@njit(cache=True, fastmath=FAST, error_model="numpy")
def add_element_forces(block, e, acceleration, body, inertia, force):
    """Add the forces of all elements to those of their nodes (N, per_node)."""
    nn, nv = block.node.shape[1], block.scale.shape[1]
    nq, ns, vpn = block.jacobian.shape[1], block.stiffness.shape[2], nv // nn
    m = 8 if block.measures == ELASTIC_LINE else 6
    local, mine = np.empty((nv, 2)), np.empty((nv, 2))
    shape, second, director = np.empty(nv), np.empty(nv), np.empty(nn)
    q, eps, grad, sigma, f = np.empty(m), np.empty(ns), np.empty((ns, m)), np.empty(ns), np.empty(m)
    for element in range(block.node.shape[0]):
        kind = block.kind[element]
        gather(block, element, e, local)
        body_force(block, element, acceleration, body, inertia, mine)
        for point in range(nq):
            interpolate(block, kind, point, local, shape, second, director, q)
            measure(block.measures, q, eps, grad)
            stress(block, kind, point, eps, sigma)
            for x in range(m):
                total = 0.0
                for i in range(ns):
                    total += grad[i, x] * sigma[i]
                f[x] = total
            spread_force(vpn, shape, second, director, f, mine)
        scatter(block, element, mine, force)


@njit(cache=True, fastmath=FAST, error_model="numpy")
def add_elements(block, layout, e, acceleration, v, a, body, coefficients, geometric_stress, force, geometric, matrix):
    """Add the forces of all elements to those of their nodes (N, per_node), and their tangents to the matrix.

    geometric (N, per_node): forces of the stresses that the geometric part of the tangent takes.
    """
    nn, nv, npn = block.node.shape[1], block.scale.shape[1], block.dof.shape[1]
    nq, ns, vpn = block.jacobian.shape[1], block.stiffness.shape[2], nv // nn
    m = 8 if block.measures == ELASTIC_LINE else 6
    ck, ca = coefficients[0], coefficients[2]
    predicted = geometric_stress.shape[0] > 0
    local, mine, mine_geo = np.empty((nv, 2)), np.empty((nv, 2)), np.empty((nv, 2))
    shape, second, director = np.empty(nv), np.empty(nv), np.empty(nn)
    q, eps, grad, sigma, sigma_geo = np.empty(m), np.empty(ns), np.empty((ns, m)), np.empty(ns), np.empty(ns)
    cg, h, f, g, ht = np.empty((ns, m)), np.empty((m, m)), np.empty(m), np.empty(m), np.empty((m, 2))
    k, kc = np.empty((2 * nv, 2 * nv)), np.empty((2 * nv, nn * npn))
    b, c = np.zeros((nn, npn, 2 * vpn)), np.zeros((nn, npn, 2 * vpn))
    for element in range(block.node.shape[0]):
        kind = block.kind[element]
        gather(block, element, e, local)
        body_force(block, element, acceleration, body, ca != 0.0, mine)
        mine_geo[:, :] = mine
        k[:, :] = 0.0
        for point in range(nq):
            interpolate(block, kind, point, local, shape, second, director, q)
            measure(block.measures, q, eps, grad)
            stress(block, kind, point, eps, sigma)
            weight = block.weight[kind, point]
            for i in range(ns):
                sigma_geo[i] = weight * geometric_stress[element, point, i] if predicted else sigma[i]
            for x in range(m):
                total, total_geo = 0.0, 0.0
                for i in range(ns):
                    total += grad[i, x] * sigma[i]
                    total_geo += grad[i, x] * sigma_geo[i]
                f[x], g[x] = total, total_geo
            spread_force(vpn, shape, second, director, f, mine)
            spread_force(vpn, shape, second, director, g, mine_geo)
            if ck == 0.0:
                continue
            stiffness = block.stiffness[kind, point]
            for i in range(ns):
                for x in range(m):
                    total = 0.0
                    for j in range(ns):
                        total += stiffness[i, j] * grad[j, x]
                    cg[i, x] = weight * total
            for x in range(m):
                for z in range(x, m):
                    total = 0.0
                    for i in range(ns):
                        total += grad[i, x] * cg[i, z]
                    h[x, z] = total
                    h[z, x] = total
            measure_hessian(block.measures, q, sigma_geo, h)
            spread_matrix(vpn, shape, second, director, block.measures == ELASTIC_LINE, h, ht, k)
        for i in range(2 * nv):
            for j in range(i):
                k[i, j] = k[j, i]
        scatter(block, element, mine, force)
        scatter(block, element, mine_geo, geometric)
        plain = element_columns(block, element, e, v, a, coefficients, b, c)
        add_matrix(block, layout, element, plain, k, b, c, ck, ca, kc, matrix)


@njit(cache=True, inline="always", error_model="numpy")
def gather(block, element, e, local):
    """Fill the nodal vectors (nv, 2) of an element."""
    nn = block.node.shape[1]
    vpn = local.shape[0] // nn
    for n in range(nn):
        node = block.node[element, n]
        for s in range(vpn):
            local[n * vpn + s, 0], local[n * vpn + s, 1] = e[node, 2 * s], e[node, 2 * s + 1]


@njit(cache=True, inline="always", error_model="numpy")
def scatter(block, element, mine, force):
    """Add the forces (nv, 2) of an element to those of its nodes."""
    nn = block.node.shape[1]
    vpn = mine.shape[0] // nn
    for n in range(nn):
        node = block.node[element, n]
        for s in range(vpn):
            force[node, 2 * s] += mine[n * vpn + s, 0]
            force[node, 2 * s + 1] += mine[n * vpn + s, 1]


@njit(cache=True, inline="always", error_model="numpy")
def body_force(block, element, acceleration, body, inertia, mine):
    """Fill inertia less gravity and load per length (nv, 2) of an element."""
    kind, beam = block.kind[element], block.beam[element]
    nn, nv = block.node.shape[1], mine.shape[0]
    vpn = nv // nn
    gx, gy, lx, ly = body[beam, 0], body[beam, 1], body[beam, 2], body[beam, 3]
    for i in range(nv):
        x = -gx * block.gravity[kind, i] - lx * block.length[kind, i]
        y = -gy * block.gravity[kind, i] - ly * block.length[kind, i]
        if inertia:
            for n in range(nn):
                node = block.node[element, n]
                for s in range(vpn):
                    mass = block.mass[kind, i, n * vpn + s]
                    x += mass * acceleration[node, 2 * s]
                    y += mass * acceleration[node, 2 * s + 1]
        mine[i, 0], mine[i, 1] = x, y


@njit(cache=True, inline="always", error_model="numpy")
def interpolate(block, kind, point, local, shape, second, director, q):
    """Fill q = (r0', d, d'[, r0'']) at a quadrature point, and the tables that give it."""
    nv, nn = local.shape[0], director.shape[0]
    vpn = nv // nn
    inverse = 1.0 / block.jacobian[kind, point]
    rx, ry, dx, dy, ex, ey = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(nn):
        for s in range(vpn - 1):
            i = n * vpn + s
            shape[i] = block.slope[point, i] * block.scale[kind, i] * inverse
            rx += shape[i] * local[i, 0]
            ry += shape[i] * local[i, 1]
        i = n * vpn + vpn - 1
        shape[i], director[n] = block.slope[point, i] * inverse, block.director[point, n]
        dx += director[n] * local[i, 0]
        dy += director[n] * local[i, 1]
        ex += shape[i] * local[i, 0]
        ey += shape[i] * local[i, 1]
    q[0], q[1], q[2], q[3], q[4], q[5] = rx, ry, dx, dy, ex, ey
    if block.measures == ELASTIC_LINE:
        bend = block.jacobian_xi[kind, point] * inverse
        rx, ry = 0.0, 0.0
        for n in range(nn):
            for s in range(vpn - 1):
                i = n * vpn + s
                curved = block.second[point, i] - bend * block.slope[point, i]
                second[i] = curved * block.scale[kind, i] * inverse * inverse
                rx += second[i] * local[i, 0]
                ry += second[i] * local[i, 1]
        q[6], q[7] = rx, ry


@njit(cache=True, inline="always", error_model="numpy")
def stress(block, kind, point, eps, sigma):
    """Take the reference from eps (ns,) and fill the stress resultants (ns,) times the quadrature weight."""
    ns = eps.shape[0]
    weight = block.weight[kind, point]
    for i in range(ns):
        eps[i] -= block.reference[kind, point, i]
    for i in range(ns):
        total = 0.0
        for j in range(ns):
            total += block.stiffness[kind, point, i, j] * eps[j]
        sigma[i] = weight * total


@njit(cache=True, inline="always", error_model="numpy")
def spread_force(vpn, shape, second, director, f, mine):
    """Add the forces (nv, 2) that f (6 or 8,) on q gives."""
    for n in range(director.shape[0]):
        for s in range(vpn - 1):
            i = n * vpn + s
            mine[i, 0] += shape[i] * f[0]
            mine[i, 1] += shape[i] * f[1]
            if f.shape[0] == 8:
                mine[i, 0] += second[i] * f[6]
                mine[i, 1] += second[i] * f[7]
        i = n * vpn + vpn - 1
        mine[i, 0] += director[n] * f[2] + shape[i] * f[4]
        mine[i, 1] += director[n] * f[3] + shape[i] * f[5]


@njit(cache=True, inline="always", error_model="numpy")
def spread_matrix(vpn, shape, second, director, bends, h, ht, k):
    """Add the upper half of T^T h T to the element matrix k (2 nv, 2 nv), T the tables of r0', d, d' and r0''."""
    nv, m = shape.shape[0], h.shape[0]
    for j in range(nv):
        other = j // vpn
        if j % vpn == vpn - 1:
            for x in range(m):
                ht[x, 0] = director[other] * h[x, 2] + shape[j] * h[x, 4]
                ht[x, 1] = director[other] * h[x, 3] + shape[j] * h[x, 5]
        else:
            for x in range(m):
                ht[x, 0] = shape[j] * h[x, 0]
                ht[x, 1] = shape[j] * h[x, 1]
                if bends:
                    ht[x, 0] += second[j] * h[x, 6]
                    ht[x, 1] += second[j] * h[x, 7]
        for i in range(j + 1):
            own = i // vpn
            for x in range(2):
                for z in range(2):
                    if i % vpn == vpn - 1:
                        value = director[own] * ht[2 + x, z] + shape[i] * ht[4 + x, z]
                    else:
                        value = shape[i] * ht[x, z]
                        if bends:
                            value += second[i] * ht[6 + x, z]
                    k[2 * i + x, 2 * j + z] += value
