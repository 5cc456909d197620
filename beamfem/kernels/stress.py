"""Stress resultants at the quadrature points that a linearised step predicts."""

import numpy as np
from numba import njit

from beamfem.kernels.assemble import gather, interpolate
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.coordinates import node_rates
from beamfem.kernels.measures import measure
from beamfem.kernels.reduce import place_nodes


@njit(cache=True, error_model="numpy")
def predict_stress(block, p, step, stress):
    """Fill stress (ne, nq, ns) with C (eps + (d eps / de) B dp), B and eps at p, dp = step.

    The independent stresses of Magisano, Leonetti and Garcea 2017 for the geometric part of the tangent.
    """
    nn, nv = block.node.shape[1], block.scale.shape[1]
    nq, ns = block.jacobian.shape[1], block.stiffness.shape[2]
    m = 8 if block.measures == ELASTIC_LINE else 6
    shape = (block.dof.shape[0], 2 * nv // nn)
    e, de = np.empty(shape), np.empty(shape)
    place_nodes(block, p, step, step, e, de)
    for node in range(shape[0]):
        node_rates(block.carrier[node], block.dof[node], block.frame[node], e[node], step, de[node])
    local, change = np.empty((nv, 2)), np.empty((nv, 2))
    slopes, second, director = np.empty(nv), np.empty(nv), np.empty(nn)
    q, dq, eps, grad = np.empty(m), np.empty(m), np.empty(ns), np.empty((ns, m))
    for element in range(block.node.shape[0]):
        kind = block.kind[element]
        gather(block, element, e, local)
        gather(block, element, de, change)
        for point in range(nq):
            interpolate(block, kind, point, change, slopes, second, director, dq)
            interpolate(block, kind, point, local, slopes, second, director, q)
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
