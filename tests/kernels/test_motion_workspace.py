"""The matrix that one motion leaves for the next of the same model: nothing that it holds counts."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import system_of

STEEL = bf.Material(2e11, 0.3, 7800.0)


def swinging(elements, element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.01, 0.02), STEEL)
    return bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])


@pytest.mark.parametrize("element", [bf.BilinearCRBF(), bf.CRBF(2), bf.ANCF()], ids=lambda element: element.name)
@pytest.mark.parametrize("elements", [8, 300])
def test_what_the_matrix_holds_does_not_count(element, elements):
    model = swinging(elements, element)
    expected = bf.simulate(model, 0.01, 5e-4).p
    (space,) = system_of(model, static=False).spare(MotionWorkspace)
    space.solver.rows[:] = np.nan
    np.testing.assert_array_equal(bf.simulate(model, 0.01, 5e-4).p, expected)
    assert system_of(model, static=False).spare(MotionWorkspace) == [space]
