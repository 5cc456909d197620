"""From the coordinates p of a node to its absolute nodal coordinates e, with all derivatives a solver needs.

e = e(p), e' = B p', e'' = B p'' + B' p'. For an unknown increment dp that changes p by ck dp, p' by cv dp and p'' by
ca dp, the change of e'' is C dp. What B and C do to element matrices is in `reduce`.

GRADIENTS: e = p. TURNED_GRADIENTS: the same, but r_y is a stored vector turned by the frame's angle.
ROTATION: r_y = (-sin t, cos t), t from the reference; paper, eqs. (5) to (7), (11), (12).
STRETCH: r_x = s (cos t, sin t) as well, paper, section 1.5. SHEAR_RIGID: s = |r_x| of the reference, section 3.5.
A frame holds cosine and sine of the section's angle in the reference, and |r_x| there.
"""

import math

from beamfem.kernels.block import GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH, TURNED_GRADIENTS
from beamfem.kernels.compiling import kernel


@kernel(forceinline=True)
def linear(carrier, size):
    """Return how many of the first coordinates of a node are nodal vectors themselves."""
    return size if carrier == GRADIENTS else (2 if carrier in (STRETCH, SHEAR_RIGID) else size - 2)


@kernel(forceinline=True)
def node_vectors(block, node, p, v, a, e, acceleration):
    """Fill a node's rows of e and e'' (N, per_node) from p, p', p'' (n,)."""
    carrier, dof, frame, size = block.carrier[node], block.dof, block.frame, e.shape[1]
    for j in range(linear(carrier, size)):
        e[node, j], acceleration[node, j] = p[dof[node, j]], a[dof[node, j]]
    if carrier == GRADIENTS:
        return
    if carrier == TURNED_GRADIENTS:
        x, y = dof[node, size - 2], dof[node, size - 1]
        co, si = frame[node, 0], frame[node, 1]
        e[node, size - 2], e[node, size - 1] = co * p[x] - si * p[y], si * p[x] + co * p[y]
        acceleration[node, size - 2], acceleration[node, size - 1] = co * a[x] - si * a[y], si * a[x] + co * a[y]
        return
    angle = dof[node, size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)]
    spin, turn = v[angle], a[angle]
    ca, sa = math.cos(p[angle]), math.sin(p[angle])
    ct, st = ca * frame[node, 0] - sa * frame[node, 1], sa * frame[node, 0] + ca * frame[node, 1]
    square = spin * spin
    e[node, size - 2], e[node, size - 1] = -st, ct
    acceleration[node, size - 2] = -ct * turn + st * square
    acceleration[node, size - 1] = -st * turn - ct * square
    if carrier != ROTATION:
        s, rate, second = frame[node, 2], 0.0, 0.0
        if carrier == STRETCH:
            s, rate, second = p[dof[node, 2]], v[dof[node, 2]], a[dof[node, 2]]
        e[node, 2], e[node, 3] = s * ct, s * st
        radial, across = second - s * square, s * turn + 2.0 * rate * spin
        acceleration[node, 2], acceleration[node, 3] = radial * ct - across * st, radial * st + across * ct


@kernel(forceinline=True)
def node_rates(block, node, e, v, rates):
    """Fill a node's row of e' = B p' (N, per_node) from p' (n,)."""
    carrier, dof, frame, size = block.carrier[node], block.dof, block.frame, e.shape[1]
    for j in range(linear(carrier, size)):
        rates[node, j] = v[dof[node, j]]
    if carrier == GRADIENTS:
        return
    if carrier == TURNED_GRADIENTS:
        x, y = v[dof[node, size - 2]], v[dof[node, size - 1]]
        rates[node, size - 2] = frame[node, 0] * x - frame[node, 1] * y
        rates[node, size - 1] = frame[node, 1] * x + frame[node, 0] * y
        return
    spin = v[dof[node, size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)]]
    rates[node, size - 2], rates[node, size - 1] = -spin * e[node, size - 1], spin * e[node, size - 2]
    if carrier != ROTATION:
        rate = v[dof[node, 2]] if carrier == STRETCH else 0.0
        rates[node, 2] = -spin * e[node, 3] + rate * e[node, size - 1]
        rates[node, 3] = spin * e[node, 2] - rate * e[node, size - 2]


@kernel(forceinline=True)
def add_node_force(block, node, row, e, force, residual):
    """Add B^T f of a node to the residual (n,); its e (N, per_node) and f a row of force (rows, per_node)."""
    carrier, dof, frame, size = block.carrier[node], block.dof, block.frame, e.shape[1]
    for j in range(linear(carrier, size)):
        residual[dof[node, j]] += force[row, j]
    if carrier == GRADIENTS:
        return
    x, y = force[row, size - 2], force[row, size - 1]
    if carrier == TURNED_GRADIENTS:
        residual[dof[node, size - 2]] += frame[node, 0] * x + frame[node, 1] * y
        residual[dof[node, size - 1]] += -frame[node, 1] * x + frame[node, 0] * y
        return
    moment = e[node, size - 2] * y - e[node, size - 1] * x
    if carrier != ROTATION:
        moment += e[node, 2] * force[row, 3] - e[node, 3] * force[row, 2]
    if carrier == STRETCH:
        residual[dof[node, 2]] += e[node, size - 1] * force[row, 2] - e[node, size - 2] * force[row, 3]
    residual[dof[node, size - 2 if carrier == ROTATION else (3 if carrier == STRETCH else 2)]] += moment
