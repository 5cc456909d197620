"""Pretension of beams by a force, against closed forms."""

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
ROD = bf.Circle(0.004)


def held(*loads, element=None, section=ROD, material=STEEL):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, element or bf.CRBF(4), section, material)
    return bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [load(beam) for load in loads]), beam


@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(bf.ElasticLine()), bf.ANCFCRBF(bf.ElasticLine())])
def test_the_normal_force_between_fixed_ends_is_the_pretension_at_every_load_factor(element):
    model, beam = held(lambda beam: bf.Pretension(beam, 500.0), element=element)
    normal = bf.solve_static(model).section_forces(beam).normal
    np.testing.assert_allclose(normal, 500.0, rtol=1e-5)


def test_a_pretensioned_string_vibrates_as_theory_says():
    """f_n = n/2 sqrt((T + n^2 pi^2 EI) / m) on a length of 1 m."""
    model, _ = held(lambda beam: bf.Pretension(beam, 500.0))
    modes = bf.solve_modes(model, count=3, about=bf.solve_static(model))
    n, rigidity, mass = np.arange(1, 4), ROD.rigidity(STEEL), ROD.inertia(STEEL).mass
    theory = 0.5 * n * np.sqrt((500.0 + (n * np.pi) ** 2 * rigidity.bending) / mass)
    np.testing.assert_allclose(modes.frequencies, theory, rtol=2e-4)
    np.testing.assert_allclose(modes.angular_frequencies, 2.0 * np.pi * theory, rtol=2e-4)


def test_the_sag_of_a_pretensioned_wire_is_that_of_a_parabola():
    model, beam = held(lambda beam: bf.Pretension(beam, 2000.0), lambda beam: bf.DistributedLoad(beam, (0.0, -1.0)))
    sag = -bf.solve_static(model).displacement(beam.at(0.5))[-1, 1]
    k = np.sqrt(2000.0 / ROD.rigidity(STEEL).bending)
    tied = 1 / 8 - (1 - 1 / np.cosh(0.5 * k)) / k**2  # of w / T: a beam between pins under tension
    assert sag == pytest.approx(tied / 2000.0, rel=1e-3)


def test_it_grows_with_the_load_factor_on_request_and_varies_along_the_beam(tmp_path):
    model, beam = held(lambda beam: bf.Pretension(beam, 500.0, scale=True))
    solution = bf.solve_static(model, steps=2)
    np.testing.assert_allclose(solution.section_forces(beam).normal[:, 0], [0.0, 250.0, 500.0], atol=1e-5)
    solution.save(tmp_path / "saved.h5")
    (loaded,) = bf.load(tmp_path / "saved.h5").model.loads
    assert (loaded.force, loaded.scale) == (500.0, True)
    model.plot(tmp_path / "model.png")
    model, beam = held(lambda beam: bf.Pretension(beam, lambda s: 1000.0 * s))
    assert bf.solve_static(model).section_forces(beam).normal[-1, 0] == pytest.approx(500.0, rel=1e-5)


def test_what_cannot_be_pretensioned_is_refused():
    for wrong in ("tight", None, float("nan")):
        with pytest.raises(bf.InputError, match="force"):
            held(lambda beam, wrong=wrong: bf.Pretension(beam, wrong))
    with pytest.raises(bf.InputError, match="beam"):
        bf.Pretension(3, 5.0)


def test_poissons_ratio_beyond_a_half_is_refused_with_the_reason():
    with pytest.raises(bf.InputError, match="bulk modulus"):
        bf.Material(1e6, 0.5, 1000.0)


@pytest.mark.parametrize("scale", [True, False])
def test_stays_that_go_slack_without_the_weight_that_they_carry_name_the_remedy(scale):
    deck = bf.Beam(bf.Line((0, 0), (6, 0)), 6, bf.CRBF(3), bf.Rectangle(0.1, 0.1), STEEL)
    stays = [bf.Beam(bf.Line((0, 4), (x, 0)), 4, bf.CRBF(3), bf.Circle(0.01), STEEL) for x in (2, 4)]
    supports = [bf.Pin(deck.start), bf.Roller(deck.end), *(bf.Pin(stay.start) for stay in stays)]
    joints = [bf.Hinge(deck.at(x / 6), stay.end) for stay, x in zip(stays, (2, 4), strict=True)]
    loads = [bf.Gravity((0, -9.81), scale=scale), *(bf.Pretension(stay, 5e3) for stay in stays)]
    model = bf.Model([deck, *stays], supports, loads, joints)
    if scale:
        with pytest.raises(bf.LimitPointError, match=r"Pretension acts fully at load factor 0.*Gravity\(scale=False\)"):
            bf.solve_static(model)
        return
    solution = bf.solve_static(model)
    taut = [solution.section_forces(stay).normal[-1].mean() for stay in stays]
    assert min(taut) > 0.0
    # moments about the pin: the reaction of the roller, both stays, and the weights of deck and stays
    weight = 9.81 * deck.section.area * STEEL.density * 6.0 * 3.0
    lifted = sum(-solution.joint_force(joint)[-1, 1] * x for joint, x in zip(joints, (2.0, 4.0), strict=True))
    assert solution.reaction(deck.end)[-1, 1] * 6.0 == pytest.approx(weight - abs(lifted), rel=5e-3)
