"""Residual and tangent of a block of elements: strains, stresses, inertia, reduction e' = B p' and scatter in one pass.

Residual of the reduced equations: B^T (M e'' + F_el(e) - F_body), tangent with respect to an unknown increment that
changes p, p', p'' by ck, cv, ca times itself (see `coordinates`).
"""

from beamfem.kernels.axis import interpolate, spread, spread_matrix
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.compiling import kernel
from beamfem.kernels.form import sizes
from beamfem.kernels.measures import forces, hessian, resultants, strains
from beamfem.kernels.reduce import add_forces, add_matrix, add_turnings, place_nodes, reduce_matrix

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True)
def assemble(form, block, layout, work, p, v, a, body, coefficients, geometric_stress, residual, matrix):
    """Add the residual of all elements to `residual` (n,) and their tangent to `matrix` (flat).

    body: (beams, 4) acceleration of gravity [m/s^2] and load per length [N/m] of a beam.
    coefficients: (ck, cv, ca); (1, 0, 0) in statics, (0, 0, 1) gives the mass matrix; ca = 0 leaves inertia out.
    geometric_stress: (ne, nq, ns) stress resultants for the geometric part of the tangent, or ne = 0 for the true ones.
    matrix: empty where only the residual is wanted.
    """
    nodes = work.nodes
    e, acceleration, force, geometric = nodes[0], nodes[1], nodes[2], nodes[3]
    place_nodes(block, p, v, a, e, acceleration)
    clear(force)
    add_element_forces(form, block, e, acceleration, body, coefficients[2] != 0.0, force)
    add_forces(block, e, force, residual)
    if matrix.shape[0] == 0:
        return
    clear(geometric)
    add_tangents(form, block, layout, work, e, v, a, coefficients, geometric_stress, geometric, matrix)
    add_turnings(block, layout, e, force, coefficients[0], matrix)
    if geometric_stress.shape[0] > 0:
        add_turnings(block, layout, e, geometric, coefficients[0], matrix)


@kernel(forceinline=True)
def clear(values):
    """Set a table to zero; a slice assignment would compile the words of its error message as well."""
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            values[i, j] = 0.0


@kernel(forceinline=True, fastmath=FAST)
def add_element_forces(form, block, e, acceleration, body, inertia, force):
    """Add elastic forces and inertia less body forces of all elements to those of their nodes (N, per_node)."""
    nn, vpn, measures = sizes(form, block)
    bends = measures == ELASTIC_LINE
    node, mass, gravity, length = block.node, block.mass, block.gravity, block.length
    stiffness, reference, weight = block.stiffness, block.reference, block.weight
    for element in range(node.shape[0]):
        kind, beam = block.kind[element], block.beam[element]
        gx, gy, lx, ly = body[beam, 0], body[beam, 1], body[beam, 2], body[beam, 3]
        for n in range(nn):
            own = node[element, n]
            for s in range(vpn):
                i = n * vpn + s
                x = -gx * gravity[kind, i] - lx * length[kind, i]
                y = -gy * gravity[kind, i] - ly * length[kind, i]
                if inertia:
                    for m in range(nn):
                        other = node[element, m]
                        for t in range(vpn):
                            x += mass[kind, i, m * vpn + t] * acceleration[other, 2 * t]
                            y += mass[kind, i, m * vpn + t] * acceleration[other, 2 * t + 1]
                force[own, 2 * s] += x
                force[own, 2 * s + 1] += y
        for point in range(weight.shape[1]):
            q = interpolate(nn, vpn, bends, block, element, kind, point, e)
            s = resultants(measures, weight[kind, point], stiffness, reference, kind, point, strains(measures, q))
            spread(nn, vpn, bends, block, element, kind, point, forces(measures, q, s), force)


@kernel(fastmath=FAST)
def add_tangents(form, block, layout, work, e, v, a, coefficients, geometric_stress, geometric, matrix):
    """Add the tangents of all elements to the matrix.

    geometric (N, per_node): what other stresses in the geometric part than the true ones change in the nodal forces is
    added to it.
    """
    nn, vpn, measures = sizes(form, block)
    bends = measures == ELASTIC_LINE
    nv, ns = nn * vpn, block.stiffness.shape[2]
    stiffness, reference, weight = block.stiffness, block.reference, block.weight
    ck, cv, ca = coefficients[0], coefficients[1], coefficients[2]
    predicted = geometric_stress.shape[0] > 0
    k, rows = work.matrix, work.rows
    for element in range(block.node.shape[0]):
        kind = block.kind[element]
        for i in range(2 * nv):
            for j in range(2 * nv):
                k[i, j] = 0.0
        if ck != 0.0:
            for point in range(weight.shape[1]):
                w = weight[kind, point]
                q = interpolate(nn, vpn, bends, block, element, kind, point, e)
                s = resultants(measures, w, stiffness, reference, kind, point, strains(measures, q))
                if predicted:
                    true, g = s, geometric_stress
                    s = (
                        w * g[element, point, 0],
                        w * g[element, point, 1],
                        w * g[element, point, 2],
                        w * g[element, point, 3],
                        w * g[element, point, 4] if ns > 4 else 0.0,
                        w * g[element, point, 5] if ns > 4 else 0.0,
                    )
                    more = (
                        s[0] - true[0],
                        s[1] - true[1],
                        s[2] - true[2],
                        s[3] - true[3],
                        s[4] - true[4],
                        s[5] - true[5],
                    )
                    spread(nn, vpn, bends, block, element, kind, point, forces(measures, q, more), geometric)
                h = hessian(measures, q, stiffness, kind, point, w, s)
                spread_matrix(nn, vpn, bends, block, kind, point, h, k)
            for i in range(2 * nv):
                k[i, i] *= ck
                for j in range(i):
                    k[j, i] *= ck
                    k[i, j] = k[j, i]
        if ca != 0.0:
            for i in range(nv):
                for j in range(nv):
                    k[2 * i, 2 * j] += ca * block.mass[kind, i, j]
                    k[2 * i + 1, 2 * j + 1] += ca * block.mass[kind, i, j]
        reduce_matrix(nn, vpn, block, element, kind, e, v, a, (ck, cv, ca), k)
        add_matrix(nn, vpn, block, layout, element, rows, k, matrix)
