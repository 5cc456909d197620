"""From the coordinates p of a node to its absolute nodal coordinates e, with all derivatives a solver needs.

e = e(p), e' = B p', e'' = B p'' + B' p'. For an unknown increment dp that changes p by ck dp, p' by cv dp and p'' by
ca dp, the change of e'' is C dp. Columns j of B and C are zero outside [column_start[j], column_stop[j]).
"""

import math

import numpy as np
from numba import njit

from beamfem.kernels.block import GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH, TURNED_GRADIENTS


@njit(cache=True, error_model="numpy")
def node_map(carrier, p, v, a, frame, coefficients, e, acceleration, b, c):
    """Fill e, acceleration (ne,), b and c (npn, ne) of one node; rows of b and c are columns of B and C.

    frame: cosine and sine of the section's angle in the reference, and |r_x| there.
    GRADIENTS: e = p. TURNED_GRADIENTS: the same, but r_y is a stored vector turned by the frame's angle.
    ROTATION: r_y = (-sin t, cos t), t from the reference; paper, eqs. (5) to (7), (11), (12).
    STRETCH: r_x = s (cos t, sin t) as well, paper, section 1.5. SHEAR_RIGID: s = |r_x|, paper, section 3.5.
    """
    size = e.shape[0]
    if carrier == GRADIENTS:
        _linear(0, size, p, a, coefficients, e, acceleration, b, c)
    elif carrier == ROTATION:
        _linear(0, size - 2, p, a, coefficients, e, acceleration, b, c)
        j = size - 2
        ct, st = _cos_sin(p[j], frame[0], frame[1])
        _turning(j, j, -st, ct, v[j], a[j], coefficients, e, acceleration, b, c)
    elif carrier in (STRETCH, SHEAR_RIGID):
        _linear(0, 2, p, a, coefficients, e, acceleration, b, c)
        j = 3 if carrier == STRETCH else 2
        ct, st = _cos_sin(p[j], frame[0], frame[1])
        s, rate, second = frame[2], 0.0, 0.0
        if carrier == STRETCH:
            s, rate, second = p[2], v[2], a[2]
        _turning(j, size - 2, -st, ct, v[j], a[j], coefficients, e, acceleration, b, c)
        _turning(j, 2, s * ct, s * st, v[j], a[j], coefficients, e, acceleration, b, c)
        if carrier == STRETCH:
            ck, cv, ca = coefficients[0], coefficients[1], coefficients[2]
            spin, turn = v[j], a[j]
            acceleration[2] += second * ct - 2.0 * rate * spin * st
            acceleration[3] += second * st + 2.0 * rate * spin * ct
            b[2, 2], b[2, 3] = ct, st
            radial, across = ca - ck * spin * spin, 2.0 * cv * spin + ck * turn
            c[2, 2] = radial * ct - across * st
            c[2, 3] = radial * st + across * ct
            radial = -2.0 * (ck * rate * spin)
            across = ck * second + 2.0 * cv * rate
            c[j, 2] += radial * ct - across * st
            c[j, 3] += radial * st + across * ct
    elif carrier == TURNED_GRADIENTS:
        _linear(0, size - 2, p, a, coefficients, e, acceleration, b, c)
        j, co, si, ca = size - 2, frame[0], frame[1], coefficients[2]
        e[j], e[j + 1] = co * p[j] - si * p[j + 1], si * p[j] + co * p[j + 1]
        acceleration[j] = co * a[j] - si * a[j + 1]
        acceleration[j + 1] = si * a[j] + co * a[j + 1]
        b[j, j], b[j, j + 1], b[j + 1, j], b[j + 1, j + 1] = co, si, -si, co
        c[j, j], c[j, j + 1], c[j + 1, j], c[j + 1, j + 1] = ca * co, ca * si, -ca * si, ca * co


@njit(cache=True, inline="always", error_model="numpy")
def _linear(first, stop, p, a, coefficients, e, acceleration, b, c):
    for j in range(first, stop):
        e[j] = p[j]
        acceleration[j] = a[j]
        b[j, j] = 1.0
        c[j, j] = coefficients[2]


@njit(cache=True, inline="always", error_model="numpy")
def _turning(j, i, x, y, spin, turn, coefficients, e, acceleration, b, c):
    """A vector (x, y) at components i, i + 1 of e that turns with the angle p[j]."""
    ck, cv, ca = coefficients[0], coefficients[1], coefficients[2]
    e[i], e[i + 1] = x, y
    square = spin * spin
    acceleration[i] = -y * turn - x * square
    acceleration[i + 1] = x * turn - y * square
    b[j, i], b[j, i + 1] = -y, x
    across = ca - ck * square
    along = -ck * turn - 2.0 * cv * spin
    c[j, i] = -y * across + x * along
    c[j, i + 1] = x * across + y * along


@njit(cache=True, error_model="numpy")
def element_map(block, element, p, e, b):
    """Fill e (2 nv,) and the columns of B, b (npe, ne of a node), of an element at rest; p (n,) of the whole model."""
    nn, npe = block.frame.shape[1], block.dof.shape[1]
    npn, per_node = npe // nn, e.shape[0] // nn
    here, zero = np.zeros(npn), np.zeros(npn)
    unused, c = np.empty(per_node), np.zeros((npn, per_node))
    coefficients = np.array([1.0, 0.0, 0.0])
    for node in range(nn):
        lo, hi = node * npn, (node + 1) * npn
        for i in range(npn):
            dof = block.dof[element, lo + i]
            if dof >= 0:
                here[i] = p[dof]
        local = e[node * per_node : (node + 1) * per_node]
        carrier, frame = block.carrier[element, node], block.frame[element, node]
        node_map(carrier, here, zero, zero, frame, coefficients, local, unused, b[lo:hi], c)


@njit(cache=True, inline="always", error_model="numpy")
def _cos_sin(angle, cosine, sine):
    from_reference_c, from_reference_s = math.cos(angle), math.sin(angle)
    return from_reference_c * cosine - from_reference_s * sine, from_reference_s * cosine + from_reference_c * sine
