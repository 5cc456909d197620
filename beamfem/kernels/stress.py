"""Stress resultants at the quadrature points, and those that a linearised step predicts."""

import numpy as np
from numba import njit

from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.coordinates import element_map
from beamfem.kernels.measures import measure


@njit(cache=True, error_model="numpy")
def predict_stress(block, p, step, stress):
    """Fill stress (ne, nq, ns) with C (eps + (d eps / de) B dp), B and eps at p, dp = step.

    The independent stresses of Magisano, Leonetti and Garcea 2017 for the geometric part of the tangent.
    """
    ne, nn = block.carrier.shape[0], block.carrier.shape[1]
    nv = block.scale.shape[1]
    nr, nd, nq = block.r_slots.shape[0], block.d_slots.shape[0], block.jacobian.shape[1]
    ns = block.stiffness.shape[2]
    npe = block.dof.shape[1]
    npn, per_node = npe // nn, 2 * nv // nn
    e, de = np.empty(2 * nv), np.empty(2 * nv)
    b = np.zeros((npe, per_node))
    second = block.measures == ELASTIC_LINE
    m = 8 if second else 6
    q, dq, eps, grad = np.empty(m), np.empty(m), np.empty(ns), np.empty((ns, m))
    for element in range(ne):
        kind = block.kind[element]
        de[:] = 0.0
        element_map(block, element, p, e, b)
        for node in range(nn):
            lo, hi, elo = node * npn, (node + 1) * npn, node * per_node
            carrier = block.carrier[element, node]
            for i in range(lo, hi):
                dof = block.dof[element, i]
                if dof < 0:
                    continue
                for x in range(block.column_start[carrier, i - lo], block.column_stop[carrier, i - lo]):
                    de[elo + x] += b[i, x] * step[dof]
        for point in range(nq):
            inverse = 1.0 / block.jacobian[kind, point]
            bend = block.jacobian_xi[kind, point] * inverse
            q[:] = 0.0
            dq[:] = 0.0
            for i in range(nr):
                slot = block.r_slots[i]
                scale = block.scale[kind, slot] * inverse
                phi = block.r_xi[point, i] * scale
                for x in range(2):
                    q[x] += phi * e[2 * slot + x]
                    dq[x] += phi * de[2 * slot + x]
                if second:
                    phi = (block.r_xixi[point, i] - bend * block.r_xi[point, i]) * scale * inverse
                    for x in range(2):
                        q[6 + x] += phi * e[2 * slot + x]
                        dq[6 + x] += phi * de[2 * slot + x]
            for i in range(nd):
                slot = block.d_slots[i]
                phi, slope = block.d[point, i], block.d_xi[point, i] * inverse
                for x in range(2):
                    q[2 + x] += phi * e[2 * slot + x]
                    dq[2 + x] += phi * de[2 * slot + x]
                    q[4 + x] += slope * e[2 * slot + x]
                    dq[4 + x] += slope * de[2 * slot + x]
            measure(block.measures, q, eps, grad)
            for i in range(ns):
                eps[i] -= block.reference[kind, point, i]
                for x in range(m):
                    eps[i] += grad[i, x] * dq[x]
            for i in range(ns):
                total = 0.0
                for j in range(ns):
                    total += block.stiffness[kind, point, i, j] * eps[j]
                stress[element, point, i] = total
