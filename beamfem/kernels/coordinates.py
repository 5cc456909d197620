"""From the coordinates p of a node to its absolute nodal coordinates e, with all derivatives a solver needs.

e = e(p), e' = B p', e'' = B p'' + B' p'. For an unknown increment dp that changes p by ck dp, p' by cv dp and p'' by
ca dp, the change of e'' is C dp. Columns j of B and C are zero outside [column_start[j], column_stop[j]).
"""

import math

import numpy as np
from numba import njit

from beamfem.kernels.block import ROTATION


@njit(cache=True, error_model="numpy")
def node_map(coordinates, p, v, a, cosine, sine, coefficients, e, acceleration, b, c):
    """Fill e, acceleration (ne,), b and c (npn, ne) of one node; rows of b and c are columns of B and C.

    ROTATION: r_y = (-sin t, cos t) turned by the section's angle in the reference; paper, eqs. (5) to (7), (11), (12).
    """
    ck, cv, ca = coefficients[0], coefficients[1], coefficients[2]
    n = p.shape[0]
    linear = n - 1 if coordinates == ROTATION else n
    for j in range(linear):
        e[j] = p[j]
        acceleration[j] = a[j]
        b[j, j] = 1.0
        c[j, j] = ca
    if coordinates == ROTATION:
        j = n - 1
        ct, st = _cos_sin(p[j], cosine, sine)
        dx, dy = -st, ct
        ax, ay = -ct, -st
        e[j], e[j + 1] = dx, dy
        w2 = v[j] * v[j]
        acceleration[j] = ax * a[j] - dx * w2
        acceleration[j + 1] = ay * a[j] - dy * w2
        b[j, j], b[j, j + 1] = ax, ay
        along_a = ca - ck * w2
        along_d = -ck * a[j] - 2.0 * cv * v[j]
        c[j, j] = ax * along_a + dx * along_d
        c[j, j + 1] = ay * along_a + dy * along_d


@njit(cache=True, error_model="numpy")
def element_map(block, element, p, e, b):
    """Fill e (2 nv,) and the columns of B, b (npe, ne of a node), of an element at rest; p (n,) of the whole model."""
    nn, npe = block.frame.shape[1], block.dof.shape[1]
    npn, per_node = npe // nn, e.shape[0] // nn
    here, zero = np.empty(npn), np.zeros(npn)
    unused, c = np.empty(per_node), np.zeros((npn, per_node))
    coefficients = np.array([1.0, 0.0, 0.0])
    for node in range(nn):
        lo, hi = node * npn, (node + 1) * npn
        for i in range(npn):
            here[i] = p[block.dof[element, lo + i]]
        cosine, sine = block.frame[element, node, 0], block.frame[element, node, 1]
        local = e[node * per_node : (node + 1) * per_node]
        node_map(block.coordinates, here, zero, zero, cosine, sine, coefficients, local, unused, b[lo:hi], c)


@njit(cache=True, inline="always", error_model="numpy")
def _cos_sin(angle, cosine, sine):
    from_reference_c, from_reference_s = math.cos(angle), math.sin(angle)
    return from_reference_c * cosine - from_reference_s * sine, from_reference_s * cosine + from_reference_c * sine
