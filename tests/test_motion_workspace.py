"""The matrix that one motion leaves for the next of the same model: nothing that it holds counts."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.assembly import tiles
from beamfem.assembly.system import system_of
from beamfem.kernels import record

STEEL = bf.Material(2e11, 0.3, 7800.0)


def swinging(elements, element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.01, 0.02), STEEL)
    return bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])


@pytest.mark.parametrize("element", [bf.BilinearCRBF(), bf.CRBF(2), bf.ANCF()], ids=lambda element: element.name)
@pytest.mark.parametrize("long", [False, True])
def test_what_the_matrix_holds_does_not_count(element, long, monkeypatch):
    if long:  # eliminated tile by tile, in two halves
        monkeypatch.setattr(tiles, "LONG", 100)
        monkeypatch.setattr(tiles, "_NODES", 32)
    model = swinging(300 if long else 8, element)
    expected = bf.simulate(model, 0.01, 5e-4).p
    (space,) = system_of(model, static=False).spare_motions
    assert space.in_two == long
    space.arrays[record.ROWS][:] = np.nan
    np.testing.assert_array_equal(bf.simulate(model, 0.01, 5e-4).p, expected)
    assert system_of(model, static=False).spare_motions == [space]
