"""From the coordinates p of a node to its absolute nodal coordinates e, with all derivatives a solver needs.

e = e(p), e' = B p', e'' = B p'' + B' p'. For an unknown increment dp that changes p by ck dp, p' by cv dp and p'' by
ca dp, the change of e'' is C dp. Columns j of B and C are zero outside [column_start[j], column_stop[j]).

GRADIENTS: e = p. TURNED_GRADIENTS: the same, but r_y is a stored vector turned by the frame's angle.
ROTATION: r_y = (-sin t, cos t), t from the reference; paper, eqs. (5) to (7), (11), (12).
STRETCH: r_x = s (cos t, sin t) as well, paper, section 1.5. SHEAR_RIGID: s = |r_x| of the reference, section 3.5.
A frame holds cosine and sine of the section's angle in the reference, and |r_x| there.
"""

import math

from numba import njit

from beamfem.kernels.block import GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH, TURNED_GRADIENTS


@njit(cache=True, error_model="numpy")
def node_vectors(carrier, dof, frame, p, v, a, e, acceleration):
    """Fill e and e'' (per_node,) of a node with coordinates dof (npn,) from p, p', p'' (n,)."""
    size = e.shape[0]
    linear = size if carrier == GRADIENTS else (2 if carrier in (STRETCH, SHEAR_RIGID) else size - 2)
    for j in range(linear):
        e[j], acceleration[j] = p[dof[j]], a[dof[j]]
    if carrier == GRADIENTS:
        return
    if carrier == TURNED_GRADIENTS:
        x, y = dof[size - 2], dof[size - 1]
        co, si = frame[0], frame[1]
        e[size - 2], e[size - 1] = co * p[x] - si * p[y], si * p[x] + co * p[y]
        acceleration[size - 2], acceleration[size - 1] = co * a[x] - si * a[y], si * a[x] + co * a[y]
        return
    angle = dof[size - 2] if carrier == ROTATION else (dof[3] if carrier == STRETCH else dof[2])
    spin, turn = v[angle], a[angle]
    ca, sa = math.cos(p[angle]), math.sin(p[angle])
    ct, st = ca * frame[0] - sa * frame[1], sa * frame[0] + ca * frame[1]
    square = spin * spin
    e[size - 2], e[size - 1] = -st, ct
    acceleration[size - 2], acceleration[size - 1] = -ct * turn + st * square, -st * turn - ct * square
    if carrier != ROTATION:
        s, rate, second = frame[2], 0.0, 0.0
        if carrier == STRETCH:
            s, rate, second = p[dof[2]], v[dof[2]], a[dof[2]]
        e[2], e[3] = s * ct, s * st
        radial, across = second - s * square, s * turn + 2.0 * rate * spin
        acceleration[2], acceleration[3] = radial * ct - across * st, radial * st + across * ct


@njit(cache=True, error_model="numpy")
def node_columns(carrier, dof, frame, e, v, a, coefficients, b, c):
    """Fill the columns of B and C, rows of b and c (npn, per_node), of a node whose nodal vectors are e (per_node,)."""
    size = e.shape[0]
    ck, cv, ca = coefficients[0], coefficients[1], coefficients[2]
    linear = size if carrier == GRADIENTS else (2 if carrier in (STRETCH, SHEAR_RIGID) else size - 2)
    for j in range(linear):
        b[j, j], c[j, j] = 1.0, ca
    if carrier == GRADIENTS:
        return
    if carrier == TURNED_GRADIENTS:
        j, co, si = size - 2, frame[0], frame[1]
        b[j, j], b[j, j + 1], b[j + 1, j], b[j + 1, j + 1] = co, si, -si, co
        c[j, j], c[j, j + 1], c[j + 1, j], c[j + 1, j + 1] = ca * co, ca * si, -ca * si, ca * co
        return
    j = size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)
    spin, turn = v[dof[j]], a[dof[j]]
    across, along = ca - ck * spin * spin, -ck * turn - 2.0 * cv * spin
    _turning(e, size - 2, j, across, along, b, c)
    if carrier != ROTATION:
        _turning(e, 2, j, across, along, b, c)
    if carrier == STRETCH:
        rate, second = v[dof[2]], a[dof[2]]
        ct, st = e[size - 1], -e[size - 2]
        b[2, 2], b[2, 3] = ct, st
        swing = 2.0 * cv * spin + ck * turn
        c[2, 2], c[2, 3] = across * ct - swing * st, across * st + swing * ct
        radial, swing = -2.0 * ck * rate * spin, ck * second + 2.0 * cv * rate
        c[j, 2] += radial * ct - swing * st
        c[j, 3] += radial * st + swing * ct


@njit(cache=True, inline="always", error_model="numpy")
def _turning(e, i, j, across, along, b, c):
    """Column j of B and C at components i, i + 1 of a vector that turns."""
    x, y = e[i], e[i + 1]
    b[j, i], b[j, i + 1] = -y, x
    c[j, i], c[j, i + 1] = -y * across + x * along, x * across + y * along


@njit(cache=True, error_model="numpy")
def node_rates(carrier, dof, frame, e, v, rates):
    """Fill e' = B p' (per_node,) of a node from p' (n,)."""
    size = e.shape[0]
    linear = size if carrier == GRADIENTS else (2 if carrier in (STRETCH, SHEAR_RIGID) else size - 2)
    for j in range(linear):
        rates[j] = v[dof[j]]
    if carrier == GRADIENTS:
        return
    if carrier == TURNED_GRADIENTS:
        x, y = v[dof[size - 2]], v[dof[size - 1]]
        rates[size - 2], rates[size - 1] = frame[0] * x - frame[1] * y, frame[1] * x + frame[0] * y
        return
    j = size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)
    spin = v[dof[j]]
    rates[size - 2], rates[size - 1] = -spin * e[size - 1], spin * e[size - 2]
    if carrier != ROTATION:
        rate = v[dof[2]] if carrier == STRETCH else 0.0
        rates[2] = -spin * e[3] + rate * e[size - 1]
        rates[3] = spin * e[2] - rate * e[size - 2]


@njit(cache=True, error_model="numpy")
def add_node_force(carrier, dof, frame, e, force, residual):
    """Add B^T f of a node to the residual (n,); f (per_node,)."""
    size = e.shape[0]
    linear = size if carrier == GRADIENTS else (2 if carrier in (STRETCH, SHEAR_RIGID) else size - 2)
    for j in range(linear):
        residual[dof[j]] += force[j]
    if carrier == GRADIENTS:
        return
    x, y = force[size - 2], force[size - 1]
    if carrier == TURNED_GRADIENTS:
        residual[dof[size - 2]] += frame[0] * x + frame[1] * y
        residual[dof[size - 1]] += -frame[1] * x + frame[0] * y
        return
    j = size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)
    moment = e[size - 2] * y - e[size - 1] * x
    if carrier != ROTATION:
        moment += e[2] * force[3] - e[3] * force[2]
    if carrier == STRETCH:
        residual[dof[2]] += e[size - 1] * force[2] - e[size - 2] * force[3]
    residual[dof[j]] += moment
