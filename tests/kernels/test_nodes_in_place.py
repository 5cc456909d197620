"""Nodes of a batch are read where they are stored if they are in a row there: the same values as from copies."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.assembler import Assembler
from beamfem.equations.equations import linearise, predicted_stresses, residual
from beamfem.equations.system import System

KINDS = (bf.BilinearCRBF(), bf.BilinearANCF(), bf.CRBF(3), bf.CRBF(2), bf.ANCF(), bf.ANCFCRBF(), bf.ShearRigid())
WEIGHTS = {"statics": (1.0, 0.0, 0.0), "motion": (1.0, 30.0, 900.0)}


def system(element, elements, damped):
    steel = bf.Material(2e11, 0.3, 7800.0, retardation_time=1e-3 if damped else 0.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.01, 0.02), steel)
    loads = [bf.Gravity((1.0, -9.81)), bf.PointForce(beam.at(0.5), (3.0, 4.0), follower=True)]
    return System(bf.Model([beam], [bf.Clamp(beam.start)], loads), static=not damped)


@pytest.mark.parametrize("elements", [2, 62, 64, 66, 130])
@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("element", KINDS, ids=lambda element: element.name)
def test_values_are_those_of_copied_nodes(element, damped, weights, elements):
    found = []
    for in_a_row in (True, False):
        own = system(element, elements, damped)
        (group,) = own.equations.groups
        assert group.record.ordered == 1
        group.record.ordered = in_a_row
        rng = np.random.default_rng(elements)
        p = own.reference + 1e-3 * rng.standard_normal(len(own.reference))
        v, a, step = 1e-2 * rng.standard_normal((3, len(p)))
        stresses = predicted_stresses(own, p, step, 1.0)
        force, tangent = linearise(own, p, v, a, 1.0, WEIGHTS[weights], stresses)
        jacobian = Assembler(own.equations).smallest_jacobian(p)
        found.append([residual(own, p, v, a, 1.0), force, tangent.rows, *stresses, jacobian])
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)
