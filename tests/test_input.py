"""Bad input gets an error that names it, before anything is solved."""

import math

import numpy as np
import pytest

import beamfem as bf

LINE = bf.Line((0, 0), (1, 0))
SECTION = bf.Rectangle(0.01, 0.01)
STEEL = bf.Material(2e11, 0.3, 7800.0)


def a_beam(**changes):
    arguments = {"curve": LINE, "elements": 2, "element": bf.ANCF(), "section": SECTION, "material": STEEL}
    return bf.Beam(**{**arguments, **changes})


BEAM = a_beam()
BAD = {
    "line without length": (lambda: bf.Line((1, 1), (1, 1)), "two different points"),
    "line with nan": (lambda: bf.Line((0, math.nan), (1, 1)), "start"),
    "line with three numbers": (lambda: bf.Line((0, 0, 0), (1, 1)), "start"),
    "negative width": (lambda: bf.Rectangle(-1.0, 1.0), "width"),
    "zero height": (lambda: bf.Rectangle(1.0, 0.0), "height"),
    "infinite area": (lambda: bf.Section(math.inf, 1.0), "area"),
    "negative second moment": (lambda: bf.Section(1.0, -1.0), "second_moment"),
    "negative fourth moment": (lambda: bf.Section(1.0, 1.0, fourth_moment=-1.0), "fourth_moment"),
    "zero modulus": (lambda: bf.Material(0.0, 0.3, 1.0), "youngs_modulus"),
    "modulus of words": (lambda: bf.Material("steel", 0.3, 1.0), "youngs_modulus"),
    "incompressible": (lambda: bf.Material(1.0, 0.5, 1.0), "poisson_ratio"),
    "poisson of minus one": (lambda: bf.Material(1.0, -1.0, 1.0), "poisson_ratio"),
    "no density": (lambda: bf.Material(1.0, 0.3, 0.0), "density"),
    "zero elements": (lambda: a_beam(elements=0), "elements"),
    "half an element": (lambda: a_beam(elements=2.5), "elements"),
    "element by name": (lambda: a_beam(element="ANCF"), "element"),
    "section by number": (lambda: a_beam(section=0.01), "section"),
    "unknown integration": (lambda: bf.ANCF(integration="ful"), r"full.*reduced"),
    "point beyond the end": (lambda: BEAM.at(1.5), "between 0 and 1"),
    "force of nan": (lambda: bf.PointForce(BEAM.end, (0, math.nan)), "PointForce"),
    "amplitude as a number": (lambda: bf.PointForce(BEAM.end, (0, 1), amplitude=2.0), "amplitude"),
    "moment of words": (lambda: bf.PointMoment(BEAM.end, "much"), "moment"),
    "gravity without direction": (lambda: bf.Gravity(9.81), "Gravity"),
    "nothing prescribed": (lambda: bf.Prescribed(BEAM.end), "at least one"),
    "roller without normal": (lambda: bf.Roller(BEAM.end, (0, 0)), "normal"),
    "model without beams": (lambda: bf.Model([]), "at least one beam"),
    "load as a support": (lambda: bf.Model([BEAM], [bf.Gravity((0, -9.81))]), "supports"),
    "rho beyond one": (lambda: bf.GeneralizedAlpha(1.1), "rho_inf"),
    "negative duration": (lambda: bf.simulate(bf.Model([BEAM]), -1.0, 1e-3), "duration"),
    "zero step": (lambda: bf.simulate(bf.Model([BEAM]), 1.0, 0.0), "step"),
    "step beyond duration": (lambda: bf.simulate(bf.Model([BEAM]), 1.0, 2.0), "must not exceed"),
    "moment as text": (lambda: bf.PointMoment(BEAM.end, "3"), "moment"),
    "force as text": (lambda: bf.PointForce(BEAM.end, (0, "1")), "PointForce"),
    "modulus as text": (lambda: bf.Material("1", 0.3, 1.0), "youngs_modulus"),
    "the same beam twice": (lambda: bf.Model([BEAM, BEAM]), "twice"),
    "a beam for a list": (lambda: bf.Model(BEAM), "list"),
    "a clamp of a beam": (lambda: bf.Model([BEAM], [bf.Clamp(BEAM)]), "point of Clamp"),
    "a load on a point": (lambda: bf.Model([BEAM], loads=[bf.DistributedLoad(BEAM.end, (0, 1))]), "must be a Beam"),
    "no load steps": (lambda: bf.solve_static(bf.Model([BEAM]), steps=0), "steps"),
    "start from a solution": (lambda: bf.simulate(bf.Model([BEAM]), 1.0, 0.1, start="a"), "start"),
    "velocity of numbers": (lambda: bf.simulate(bf.Model([BEAM]), 1.0, 0.1, velocity=(1, 0)), "velocity"),
    "save every half step": (lambda: bf.simulate(bf.Model([BEAM]), 1.0, 0.1, save_every=0.5), "save_every"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_named(case):
    make, words = BAD[case]
    with pytest.raises(bf.InputError, match=words):
        make()


def test_a_support_on_no_beam_of_the_model_is_refused():
    with pytest.raises(bf.UnknownPointError, match=r"Clamp at .* not in this model"):
        bf.Model([BEAM], [bf.Clamp(a_beam().start)])


def test_a_question_about_a_foreign_point_is_refused():
    solution = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))
    with pytest.raises(bf.UnknownPointError):
        solution.position(a_beam().end)


def test_a_reaction_where_no_support_is_is_refused():
    solution = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))
    with pytest.raises(bf.InputError, match="no support"):
        solution.reaction(BEAM.end)


def test_two_supports_of_one_coordinate_are_refused():
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start), bf.Pin(BEAM.start)])
    with pytest.raises(bf.InputError, match="already holds"):
        bf.solve_static(model)


def test_an_inclined_roller_at_a_pin_is_refused():
    model = bf.Model([BEAM], [bf.Pin(BEAM.start), bf.Roller(BEAM.start, (1, 1))])
    with pytest.raises(bf.InputError, match="Roller"):
        bf.solve_static(model)


def test_an_amplitude_that_is_not_finite_is_named():
    loads = [bf.PointForce(BEAM.end, (0, 1), amplitude=lambda t: math.nan)]
    with pytest.raises(bf.InputError, match="amplitude"):
        bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)], loads))


def test_a_static_solution_has_no_time_and_a_motion_no_load_factor():
    clamped = bf.Model([BEAM], [bf.Clamp(BEAM.start)])
    with pytest.raises(bf.InputError, match="load_factor"):
        _ = bf.solve_static(clamped).time
    with pytest.raises(bf.InputError, match="time"):
        _ = bf.simulate(clamped, 1e-3, 1e-3).load_factor


def test_a_start_of_another_model_is_refused():
    other = bf.Model([a_beam(elements=3)], [bf.Clamp(BEAM.start)][:0])
    state = bf.simulate(other, 1e-3, 1e-3)[-1]
    with pytest.raises(bf.InputError, match="4 nodes of ANCF on beam 0"):
        bf.simulate(bf.Model([BEAM]), 1e-3, 1e-3, start=state)


def test_moments_of_a_rectangle():
    section = bf.Rectangle(0.2, 0.3)
    assert section.second_moment == pytest.approx(0.2 * 0.3**3 / 12)
    assert section.fourth_moment == pytest.approx(0.2 * 0.3**5 / 80)
    assert (section.width, section.height) == pytest.approx((0.2, 0.3))
    assert np.isclose(bf.Section(1.0, 1.0, fourth_moment=7.0).fourth_moment, 7.0)
