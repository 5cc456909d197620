"""Trial of a part to come: how a result changes with where the nodes of a frame are, by one adjoint solve.

The derivative of the residual by the nodes is taken at a fixed state, from residuals of models whose nodes are moved,
so that no model is solved twice; against differences of whole solves.
"""

from itertools import pairwise

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import system_of

SECTION, MATERIAL = bf.Rectangle(0.02, 0.04), bf.Material(2e9, 0.3, 1000.0)
NODES = np.array([[0.0, 0.0], [0.5, 0.2], [1.1, 0.3], [1.6, 0.1]])
STEP = 1e-6


def frame(nodes, element):
    """Return a polygon of beams that a force bends far, clamped where it begins."""
    beams = [bf.Beam(bf.Line(a, b), 2, element, SECTION, MATERIAL) for a, b in pairwise(nodes)]
    joints = [bf.Rigid(one.end, other.start) for one, other in pairwise(beams)]
    return bf.Model(beams, [bf.Clamp(beams[0].start)], [bf.PointForce(beams[-1].end, (30.0, 90.0))], joints=joints)


def differences(function, nodes, step=STEP):
    """Return the derivative (..., nodes, 2) of a function of the nodes."""
    columns = []
    for place in np.ndindex(*nodes.shape):
        moved = np.zeros_like(nodes)
        moved[place] = step
        columns.append((function(nodes + moved) - function(nodes - moved)) / (2.0 * step))
    return np.stack(columns, axis=-1).reshape(*np.shape(columns[0]), *nodes.shape)


def height_of_tip(nodes, element):
    model = frame(nodes, element)
    return bf.solve_static(model).position(model.beams[-1].end)[-1, 1]


def adjoint_derivative(nodes, element):
    """Return how the height of the tip changes with the nodes (nodes, 2): -lambda^T dr/dX, K^T lambda = dq/dp."""
    model = frame(nodes, element)
    system, p = system_of(model, True), bf.solve_static(model).p[-1]
    free, held, zeros = system.free_dofs, system.prescribed_dofs, np.zeros_like(p)
    mesh = model.meshes[-1]
    tip = mesh.coordinates_of(mesh.node[-1, -1])["r^y"]
    tangent = linearise(system, p, zeros, zeros, 1.0, STATICS)[1]
    weight = zeros.copy()
    weight[tip] = 1.0
    adjoint = tangent.solve(weight[free], system.rotated)  # symmetric: the load is dead

    def unbalanced(moved):
        other, state = system_of(frame(moved, element), True), p.copy()
        state[held] = other.reference[held]  # the clamp goes with its node
        return residual(other, state, zeros, zeros, 1.0)[free]

    return -np.tensordot(adjoint, differences(unbalanced, nodes), axes=1)


@pytest.mark.parametrize("element", [bf.BilinearCRBF(), bf.CRBF(2), bf.CRBF(3), bf.ShearRigid()], ids=lambda e: e.name)
def test_the_adjoint_derivative_is_that_of_whole_solves(element):
    """Coordinates are positions and turns from the reference, so that a state of one model is one of a moved model."""
    found = adjoint_derivative(NODES, element)
    wanted = differences(lambda nodes: height_of_tip(nodes, element), NODES, 1e-4)
    assert np.abs(wanted).max() > 0.5
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=3e-7)
    # a frame that is moved as a whole takes its tip along
    np.testing.assert_allclose(found.sum(axis=0), [0.0, 1.0], atol=1e-8)
