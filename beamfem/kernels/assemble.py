"""Residual and tangent of a block of elements: strains, stresses, inertia, reduction e' = B p' and scatter in one pass.

Residual of the reduced equations: B^T (M e'' + F_el(e) - F_body), tangent with respect to an unknown increment that
changes p, p', p'' by ck, cv, ca times itself (see `coordinates`).
"""

import numpy as np
from numba import njit

from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.coordinates import node_map
from beamfem.kernels.measures import measure, measure_hessian
from beamfem.kernels.reduce import add_force, add_matrix


@njit(cache=True, error_model="numpy")
def assemble(block, layout, p, v, a, body, coefficients, geometric_stress, residual, matrix):
    """Add the residual of all elements to `residual` (n,) and their tangent to `matrix` (flat).

    body: (beams, 4) acceleration of gravity [m/s^2] and load per length [N/m] of each beam.
    coefficients: (ck, cv, ca); (1, 0, 0) in statics, (0, 0, 1) gives the mass matrix; ca = 0 leaves inertia out.
    geometric_stress: (ne, nq, ns) stress resultants for the geometric part of the tangent, or ne = 0 for the true ones.
    matrix: empty where only the residual is wanted.
    """
    ne, nn = block.carrier.shape[0], block.carrier.shape[1]
    nv = block.scale.shape[1]
    nr, nd, nq = block.r_slots.shape[0], block.d_slots.shape[0], block.jacobian.shape[1]
    ns = block.stiffness.shape[2]
    npe = block.dof.shape[1]
    npn = npe // nn
    size = 2 * nv
    per_node = size // nn
    wanted = matrix.shape[0] > 0
    predicted = geometric_stress.shape[0] > 0
    ck, ca = coefficients[0], coefficients[2]
    inertia = ca != 0.0
    stiff = wanted and ck != 0.0
    second = block.measures == ELASTIC_LINE
    m = 8 if second else 6

    pe, ve, ae = np.zeros(npe), np.zeros(npe), np.zeros(npe)
    e, acc = np.empty((nv, 2)), np.empty((nv, 2))
    b, c = np.zeros((npe, per_node)), np.zeros((npe, per_node))
    force, force_geo = np.empty((nv, 2)), np.empty((nv, 2))
    k = np.empty((size, size))
    kc = np.empty((size, npe))
    q, eps, grad = np.empty(m), np.empty(ns), np.empty((ns, m))
    sigma, sigma_geo = np.empty(ns), np.empty(ns)
    cg, h = np.empty((ns, m)), np.empty((m, m))
    f6, g6 = np.empty(m), np.empty(m)
    phi_r, phi_rr, phi_d, phi_x = np.empty(nr), np.empty(nr), np.empty(nd), np.empty(nd)
    flat_e, flat_acc = e.reshape(size), acc.reshape(size)
    flat_force, flat_geo = force.reshape(size), force_geo.reshape(size)

    for element in range(ne):
        kind = block.kind[element]
        for i in range(npe):
            dof = block.dof[element, i]
            if dof >= 0:
                pe[i], ve[i], ae[i] = p[dof], v[dof], a[dof]
        for node in range(nn):
            lo, hi = node * npn, (node + 1) * npn
            elo, ehi = node * per_node, (node + 1) * per_node
            node_map(
                block.carrier[element, node],
                pe[lo:hi],
                ve[lo:hi],
                ae[lo:hi],
                block.frame[element, node],
                coefficients,
                flat_e[elo:ehi],
                flat_acc[elo:ehi],
                b[lo:hi],
                c[lo:hi],
            )

        beam = block.beam[element]
        for i in range(nv):
            for x in range(2):
                force[i, x] = -body[beam, x] * block.gravity[kind, i] - body[beam, 2 + x] * block.length[kind, i]
            if inertia:
                for j in range(nv):
                    mass = block.mass[kind, i, j]
                    force[i, 0] += mass * acc[j, 0]
                    force[i, 1] += mass * acc[j, 1]
            force_geo[i, 0], force_geo[i, 1] = force[i, 0], force[i, 1]
        if stiff:
            k[:, :] = 0.0

        for point in range(nq):
            inverse = 1.0 / block.jacobian[kind, point]
            bend = block.jacobian_xi[kind, point] * inverse
            w = block.weight[kind, point]
            q[:] = 0.0
            for i in range(nr):
                slot = block.r_slots[i]
                phi_r[i] = block.r_xi[point, i] * block.scale[kind, slot] * inverse
                q[0] += phi_r[i] * e[slot, 0]
                q[1] += phi_r[i] * e[slot, 1]
            if second:
                for i in range(nr):
                    slot = block.r_slots[i]
                    curved = block.r_xixi[point, i] - bend * block.r_xi[point, i]
                    phi_rr[i] = curved * block.scale[kind, slot] * inverse * inverse
                    q[6] += phi_rr[i] * e[slot, 0]
                    q[7] += phi_rr[i] * e[slot, 1]
            for i in range(nd):
                slot = block.d_slots[i]
                phi_d[i] = block.d[point, i]
                phi_x[i] = block.d_xi[point, i] * inverse
                q[2] += phi_d[i] * e[slot, 0]
                q[3] += phi_d[i] * e[slot, 1]
                q[4] += phi_x[i] * e[slot, 0]
                q[5] += phi_x[i] * e[slot, 1]
            measure(block.measures, q, eps, grad)
            stiffness = block.stiffness[kind, point]
            for i in range(ns):
                eps[i] -= block.reference[kind, point, i]
            for i in range(ns):
                total = 0.0
                for j in range(ns):
                    total += stiffness[i, j] * eps[j]
                sigma[i] = w * total
                sigma_geo[i] = w * geometric_stress[element, point, i] if predicted else sigma[i]
            for x in range(m):
                total, total_geo = 0.0, 0.0
                for i in range(ns):
                    total += grad[i, x] * sigma[i]
                    total_geo += grad[i, x] * sigma_geo[i]
                f6[x], g6[x] = total, total_geo
            for i in range(nr):
                slot = block.r_slots[i]
                for x in range(2):
                    force[slot, x] += phi_r[i] * f6[x]
                    force_geo[slot, x] += phi_r[i] * g6[x]
                    if second:
                        force[slot, x] += phi_rr[i] * f6[6 + x]
                        force_geo[slot, x] += phi_rr[i] * g6[6 + x]
            for i in range(nd):
                slot = block.d_slots[i]
                for x in range(2):
                    force[slot, x] += phi_d[i] * f6[2 + x] + phi_x[i] * f6[4 + x]
                    force_geo[slot, x] += phi_d[i] * g6[2 + x] + phi_x[i] * g6[4 + x]
            if not stiff:
                continue
            for i in range(ns):
                for x in range(m):
                    total = 0.0
                    for j in range(ns):
                        total += stiffness[i, j] * grad[j, x]
                    cg[i, x] = w * total
            for x in range(m):
                for z in range(x, m):
                    total = 0.0
                    for i in range(ns):
                        total += grad[i, x] * cg[i, z]
                    h[x, z] = total
                    h[z, x] = total
            measure_hessian(block.measures, q, sigma_geo, h)
            _spread(block, phi_r, phi_d, phi_x, h, k)
            if second:
                _spread_second(block, phi_r, phi_rr, h, k)

        add_force(block, element, b, flat_force, residual)
        if wanted:
            add_matrix(block, layout, element, k, b, c, flat_e, flat_geo, ck, ca, kc, matrix)


@njit(cache=True, inline="always", error_model="numpy")
def _spread(block, phi_r, phi_d, phi_x, h, k):
    """Add T^T h T to the element matrix k, T the tables of r0', d and d'."""
    nr, nd = phi_r.shape[0], phi_d.shape[0]
    for x in range(2):
        for z in range(2):
            hrr, hrd, hrx = h[x, z], h[x, 2 + z], h[x, 4 + z]
            hdd, hdx, hxd, hxx = h[2 + x, 2 + z], h[2 + x, 4 + z], h[4 + x, 2 + z], h[4 + x, 4 + z]
            for i in range(nr):
                row = 2 * block.r_slots[i] + x
                for j in range(nr):
                    k[row, 2 * block.r_slots[j] + z] += phi_r[i] * hrr * phi_r[j]
                for j in range(nd):
                    value = phi_r[i] * (hrd * phi_d[j] + hrx * phi_x[j])
                    column = 2 * block.d_slots[j] + z
                    k[row, column] += value
                    k[column, row] += value
            for i in range(nd):
                row = 2 * block.d_slots[i] + x
                left, right = phi_d[i] * hdd + phi_x[i] * hxd, phi_d[i] * hdx + phi_x[i] * hxx
                for j in range(nd):
                    k[row, 2 * block.d_slots[j] + z] += left * phi_d[j] + right * phi_x[j]


@njit(cache=True, inline="always", error_model="numpy")
def _spread_second(block, phi_r, phi_rr, h, k):
    """Add what r0'' gives to the element matrix; nothing couples it with d or d'."""
    nr = phi_r.shape[0]
    for x in range(2):
        for z in range(2):
            mixed, both = h[x, 6 + z], h[6 + x, 6 + z]
            for i in range(nr):
                row = 2 * block.r_slots[i] + x
                for j in range(nr):
                    column = 2 * block.r_slots[j] + z
                    k[row, column] += phi_rr[i] * both * phi_rr[j] + phi_r[i] * mixed * phi_rr[j]
                    k[column, row] += phi_r[i] * mixed * phi_rr[j]
