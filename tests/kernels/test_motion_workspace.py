"""The matrix that one motion leaves for the next of the same model: nothing that it holds counts."""

import warnings

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


FIRST = (bf.GeneralizedAlpha(), bf.Bathe(), bf.Gauss(2), bf.EnergyMomentum(), bf.CentralDifferences())
THEN = (
    bf.GeneralizedAlpha(),
    bf.Midpoint(),
    bf.Bathe(),
    bf.Gauss(2),
    bf.Radau(3),
    bf.EnergyMomentum(),
    bf.DormandPrince(),
)


@pytest.mark.parametrize("then", THEN, ids=repr)
@pytest.mark.parametrize("first", FIRST, ids=repr)
def test_a_motion_does_not_depend_on_the_one_before(first, then):
    """The stresses that generalized-alpha predicts for its tangents made stages take 4 times the iterations."""

    def fresh():
        rubber, thin = bf.Material(0.7e6, 0.3, 5540.0), bf.Section(1.6e-3, 8.533e-9)
        beam = bf.Beam(bf.Line((0.0, 0.0), (1.2, 0.0)), 6, bf.CRBF(2), thin, rubber)
        return bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])

    def falling(model, method):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", bf.LargeStrainWarning)
            return bf.simulate(model, 0.3, 0.01, method)

    used = fresh()
    falling(used, first)
    found, expected = falling(used, then), falling(fresh(), then)
    np.testing.assert_array_equal(found.p, expected.p)
    assert found.statistics == expected.statistics
