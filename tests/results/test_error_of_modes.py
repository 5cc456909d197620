"""Estimated errors of buckling loads and frequencies against finer meshes of the same elements."""

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.02, 0.01)
EI = 2e11 * SECTION.second_moment
KINDS = [(bf.CRBF(1), 8), (bf.CRBF(2), 3), (bf.CRBF(3), 1), (bf.ANCF(bf.Structural()), 4), (bf.ShearRigid(), 4)]
kinds = pytest.mark.parametrize(("element", "elements"), KINDS, ids=lambda value: getattr(value, "name", None))


def column(element, elements):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SECTION, STEEL)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-EI, 0.0))])


@mostly_slow(("element", "elements"), KINDS, quick=(0, 3), ids=lambda value: getattr(value, "name", None))
def test_buckling_loads(element, elements):
    _, model = column(element, elements)
    found, fine = bf.solve_buckling(model, 2), bf.solve_buckling(column(element, 32 * elements)[1], 2)
    for mode in (0, 1):
        assert 0.5 < found.error(mode) / (fine.load_factors - found.load_factors)[mode] < 2.0


@kinds
def test_frequencies(element, elements):
    _, model = column(element, elements)
    found, fine = (bf.solve_modes(each, 3) for each in (model, column(element, 32 * elements)[1]))
    for mode in (0, 1, 2):
        assert 0.5 < found.error(mode) / (fine.frequencies - found.frequencies)[mode] < 2.0


def test_about_a_loaded_state_with_other_supports():
    def made(elements):
        beam, model = column(bf.CRBF(2), elements)
        about = bf.solve_static(model, at=[0.5])
        return about, model.with_(supports=[bf.Clamp(beam.start), bf.Roller(beam.end)])

    (about, model), (fine_about, fine_model) = made(3), made(48)
    found, fine = bf.solve_modes(model, 1, about=about), bf.solve_modes(fine_model, 1, about=fine_about)
    assert 0.5 < found.error() / (fine.frequencies[0] - found.frequencies[0]) < 2.0
    found, fine = bf.solve_buckling(model, 1, about=about), bf.solve_buckling(fine_model, 1, about=fine_about)
    assert 0.5 < found.error() / (fine.load_factors[0] - found.load_factors[0]) < 2.0


def test_rigid_modes_of_a_free_beam_have_no_error():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(2), SECTION, STEEL)
    modes = bf.solve_modes(bf.Model([beam]), 4)
    assert [modes.error(mode) for mode in range(3)] == [0.0, 0.0, 0.0]
    exact = 4.7300407**2 / (2.0 * np.pi) * np.sqrt(EI / (7800.0 * 2e-4))  # Euler-Bernoulli, free ends
    assert abs(modes.frequencies[3] + modes.error(3) - exact) < 0.1 * abs(modes.frequencies[3] - exact)


def test_a_mode_that_was_not_found_is_refused():
    _, model = column(bf.CRBF(2), 3)
    with pytest.raises(bf.InputError, match="mode must be"):
        bf.solve_modes(model, 1).error(1)
    with pytest.raises(bf.InputError, match="mode must be"):
        bf.solve_buckling(model).error(1)
