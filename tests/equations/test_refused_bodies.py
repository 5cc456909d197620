"""Bodies that cannot be, curves that are noise, models that do not fit the memory."""

import time

import numpy as np
import pytest

import beamfem as bf
from beamfem.installed_memory import installed_memory

STEEL = bf.Material(2e11, 0.3, 7800.0)


def an_arc(section, radius=0.04, sense=1.0):
    return bf.Beam(bf.Arc((0.0, 0.0), radius, 0.0, sense), 4, bf.CRBF(1), section, STEEL)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_section_that_reaches_the_centre_of_its_arc_is_refused(sense):
    beam = an_arc(bf.Rectangle(0.01, 0.1), sense=sense)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
    with pytest.raises(bf.InputError, match=r"radius of curvature of 0\.04 m.* reaches 0\.05 m .*overlap itself"):
        bf.solve_static(model)


def test_only_the_face_on_the_side_of_the_centre_counts():
    """The centroid 0.03 m above the lower face, 0.07 m below the upper one; the centre is on the side of +y."""
    section = bf.Section(1e-3, 5e-7, height=0.1, centroid=0.03)
    for sense, right in ((1.0, False), (-1.0, True)):
        beam = an_arc(section, sense=sense)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
        if right:
            assert np.isfinite(bf.solve_static(model).p).all()
        else:
            with pytest.raises(bf.InputError, match=r"reaches 0\.07 m"):
                bf.solve_static(model)


def test_a_taper_is_looked_at_where_it_is_highest():
    beam = bf.Beam(bf.Arc((0.0, 0.0), 1.0, 0.0, 1.0), 4, bf.CRBF(1), lambda s: bf.Rectangle(0.1, 0.1 + 2.5 * s), STEEL)
    with pytest.raises(bf.InputError, match=r"at arc length 0\.[89]"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))


def test_a_section_of_unknown_height_has_no_face():
    beam = an_arc(bf.Section.from_stiffness(1e6, 1e6, 1e6, 1.0, 1.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
    assert np.isfinite(bf.solve_static(model).p).all()


def test_continuum_forces_integrate_over_the_equivalent_rectangle_whatever_is_known():
    """0.1 m high by its moments, on an arc of 0.04 m: the energy of what lies behind the centre would be negative."""
    section = bf.Section(1e-3, 1e-3 * 0.1**2 / 12.0)
    for element, refused in ((bf.ANCF(), True), (bf.CRBF(1), False)):
        beam = bf.Beam(bf.Arc((0.0, 0.0), 0.04, 0.0, 1.0), 8, element, section, STEEL)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
        if refused:
            with pytest.raises(bf.InputError, match=r"reaches 0\.05 m"):
                bf.solve_static(model)
        else:
            assert np.isfinite(bf.solve_static(model).p).all()


def test_the_size_of_a_beam_of_knot_spans_is_that_of_its_spans():
    spline = bf.BSpline(3, (0, 0, 0, 0, 0.25, 0.5, 1, 1, 1, 1), ((0, 0), (1, 0), (2, 1), (3, 0), (4, 0), (5, 1)))
    beam = bf.Beam(spline, "knots", bf.ANCF(), bf.Rectangle(0.1, 0.1), STEEL)
    assert beam.element_count == 3
    assert bf.Beam(spline, [0.0, 0.1, 1.0], bf.ANCF(), bf.Rectangle(0.1, 0.1), STEEL).element_count == 2


def test_noise_is_refused_at_once():
    random = np.random.default_rng(0)

    def noisy(u):
        return u, u**2 + 1e-9 * random.standard_normal(np.shape(u))

    begun = time.perf_counter()
    with pytest.raises(bf.InputError, match=r"not smooth.*as noise does; fit a BSpline"):
        bf.Parametric(noisy, 0.0, 1.0)
    assert time.perf_counter() - begun < 10.0


def test_a_model_larger_than_the_memory_is_refused_before_it_is_meshed():
    if installed_memory() is None:
        pytest.skip("this system does not tell its memory")
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10**10, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL)
    with pytest.raises(bf.InputError, match=r"1e\+10 elements of this model need .* GiB .*, take fewer"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))


def test_a_section_with_less_than_its_least_fourth_moment_is_refused():
    """Cauchy and Schwarz: (integral of y^2)^2 <= A integral of y^4."""
    with pytest.raises(bf.InputError, match=r"fourth_moment \(0\.9\) must be at least .* = 1"):
        bf.Section(1.0, 1.0, fourth_moment=0.9)
    assert bf.Section(1.0, 1.0, fourth_moment=1.0).fourth_moment == 1.0


@pytest.mark.parametrize("element", [bf.ANCF(), bf.ANCFCRBF(), bf.CRBF(1), bf.BilinearCRBF()], ids=str)
@pytest.mark.parametrize("degrees", [195.0, -195.0])
def test_an_element_that_turns_by_more_than_half_a_turn_is_refused(element, degrees):
    """Found by the fuzz (seed 253): its sections point inwards in between, and a beam at rest began to move."""

    def model(elements):
        curve = bf.Arc((0.0, 0.0), 1.4, 0.0, np.radians(degrees))
        beam = bf.Beam(curve, elements, element, bf.Rectangle(1.0, 0.3), bf.Material(1e4, 0.0, 260.0))
        return bf.Model([beam], [bf.Clamp(beam.start)])

    with pytest.raises(bf.InputError, match=r"elements of .* are too long: .* turns by 195 degrees.*more elements"):
        bf.solve_modes(model(1), 3)
    modes = bf.solve_modes(model(2), 3)
    assert (modes.growth == 0.0).all()
    assert modes.frequencies[0] > 0.0


def test_an_element_whose_sections_overlap_only_in_its_middle_is_refused():
    """Its stresses are at its ends and its middle, its section forces at two Gauss points: it never converged."""
    beam = bf.Beam(bf.Arc((0.0, 0.0), 0.3, 0.0, 3.16), 1, bf.ANCF(bf.Structural()), bf.Rectangle(0.02, 0.01), STEEL)
    with pytest.raises(bf.InputError, match=r"are too long: .* turns by 181 degrees"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))]))
