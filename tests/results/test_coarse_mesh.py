"""Warnings of meshes that are too coarse for the displacements of a static solution."""

import warnings

import numpy as np
import pytest
from coarse_models import coarse_recipe, displacements, fine_recipe

import beamfem as bf
from beamfem.solve.accuracy.coarse_mesh import _differences

pytestmark = pytest.mark.filterwarnings("error::beamfem.CoarseMeshWarning")
STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.02, 0.01)
EI = 2e11 * SECTION.second_moment


def cantilever(element, elements, loads, section=SECTION):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, STEEL)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], loads(beam))


def rolled_up(beam):
    return [bf.PointMoment(beam.end, 2.0 * np.pi * EI)]


def test_a_roll_up_in_one_element_warns_with_size_and_remedy():
    """Its tip is 5.6 % of the length off the clamp, where it belongs."""
    _, model = cantilever(bf.CRBF(5), 1, rolled_up)
    with pytest.warns(bf.CoarseMeshWarning, match=r"off by about 5\.3 % .* of the one element of beam 0\. .* 1/2 of"):
        solution = bf.solve_static(model)
    assert "1 warning" in repr(solution)
    assert len(solution.warnings) == 1
    _, enough = cantilever(bf.CRBF(5), 2, rolled_up)
    assert bf.solve_static(enough).warnings == ()


@pytest.mark.parametrize("order", range(1, 9))
def test_roll_ups_warn_if_the_tip_is_off_by_2_per_cent(order):
    for elements in (1, 2, 3, 4, 6, 8, 16, 24, 32):
        beam, model = cantilever(bf.CRBF(order), elements, rolled_up)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            off = np.linalg.norm(bf.solve_static(model).position(beam.end)[-1])
        if not 0.015 < off < 0.025:
            assert bool(caught) == (off > 0.02), f"{elements} elements: {off}"


def test_one_bilinear_element_warns_under_any_small_force():
    _, model = cantilever(bf.CRBF(1), 1, lambda beam: [bf.PointForce(beam.end, (0.0, 1e-6 * EI))])
    with pytest.warns(bf.CoarseMeshWarning, match="off by about 33 %"):
        bf.solve_static(model)


def test_the_elements_are_named():
    first = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), SECTION, STEEL, "fine")
    second = bf.Beam(bf.Line((1, 0), (2, 0)), (0, 0.1, 0.2, 0.9, 1.0), bf.CRBF(1), SECTION, STEEL, "uneven")
    loads = [bf.PointForce(second.end, (0.0, 0.5 * EI))]
    model = bf.Model([first, second], [bf.Clamp(first.start)], loads, [bf.Rigid(first.end, second.start)])
    bf.solve_static(model)
    end = [bf.Clamp(first.start), bf.Pin(second.start)]
    with pytest.warns(bf.CoarseMeshWarning, match=r"element 2 of beam 'uneven'\. Elements there of 1/\d of"):
        bf.solve_static(model.with_(supports=end))


def test_a_filter_silences_it_and_the_result_still_says_it():
    _, model = cantilever(bf.CRBF(5), 1, rolled_up)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", bf.CoarseMeshWarning)
        assert "too coarse" in bf.solve_static(model).warnings[0]


def test_rows_that_are_back_where_they_began_are_not_off():
    """Their displacements are nothing, and so is nearly all of their error."""
    steel, section = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 1.5), 3, bf.CRBF(2), section, steel)
    out_and_back = bf.Interpolated([(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)])
    load = bf.PointForce(beam.end, (0.0, -20.0), amplitude=out_and_back)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]), steps=4)
    assert abs(solution.displacement(beam.end)[-1]).max() < 1e-12
    assert solution.warnings == ()


def test_elements_that_lock_are_warned_of_as_such_only():
    _, model = cantilever(bf.ANCF(), 4, lambda beam: [bf.PointForce(beam.end, (0.0, 5.0 * EI))])
    with pytest.warns(bf.LockingWarning) as caught:
        bf.solve_static(model)
    assert len(caught) == 1


def test_moments_and_jumps_of_the_section_at_nodes_are_no_sign_of_a_coarse_mesh():
    def stepped(s):
        return bf.Rectangle(0.02, 0.01 if s < 0.5 else 0.02)

    def moments(beam):
        return [bf.PointMoment(beam.at(0.25), EI), bf.PointForce(beam.end, (0.0, EI))]

    _, model = cantilever(bf.CRBF(2), 8, moments, stepped)
    assert bf.solve_static(model).warnings == ()


@pytest.mark.parametrize("order", range(1, 9))
def test_slopes_of_polynomials_from_their_differences(order):
    xi = np.asarray(bf.Lagrange(order).nodes)
    values = np.polynomial.Polynomial(np.random.default_rng(order).normal(size=order + 1))
    slope = values.deriv()
    start, end, _, highest = np.diff(values(xi)) @ _differences(tuple(xi))
    assert [start, end] == pytest.approx([slope(0.0), slope(1.0)])
    legendre = np.polynomial.Legendre.fit(xi, slope(xi), order - 1, domain=[0.0, 1.0]) if order > 1 else slope
    assert highest == pytest.approx(legendre.coef[-1])


def judged(seed):
    """Return the true error over the largest displacement, None if unknown, and whether the solve warns."""
    recipe = coarse_recipe(seed)
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            built = recipe.build()
            solution = bf.solve_static(built.model)
        found = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for elements in (24, 48):
                fine = fine_recipe(recipe, elements).build()
                found.append(displacements(fine, bf.solve_static(fine.model)))
    except bf.BeamfemError:
        return None, False
    known = [warning.category for warning in caught]
    warned = bf.CoarseMeshWarning in known or bf.LockingWarning in known
    size = np.linalg.norm(found[1], axis=1).max()
    error = np.linalg.norm(displacements(built, solution) - found[1], axis=1).max() / size
    unknown = np.linalg.norm(found[1] - found[0], axis=1).max() > 0.2 * error * size and error > 1e-6
    return (None if unknown else error), warned


def require_right(seeds):
    known = [(error, warned) for error, warned in map(judged, seeds) if error is not None]
    poor, good = ([warned for error, warned in known if low < error < high] for low, high in ((0.05, 9e9), (-1, 0.005)))
    assert len(known) > 0.6 * len(seeds)
    assert sum(poor) >= 0.9 * len(poor)
    assert sum(good) <= 0.02 * len(good)


@pytest.mark.slow
def test_random_meshes_warn_if_they_are_poor():
    require_right(range(20))


@pytest.mark.slow
def test_1000_random_meshes_warn_if_they_are_poor():
    """Of 100 of them some 30 are good, of which a single false warning would be more than 2 %."""
    require_right(range(1000))


def test_one_element_of_order_two_that_is_too_coarse_warns():
    """It has no neighbour to differ from, and its moments tell nothing of a section that varies within it."""
    wavy = lambda s: bf.Rectangle(0.01, 0.02 * (1.0 + 0.5 * np.sin(6.0 * s + 3.0)))  # noqa: E731
    tips = []
    for elements, kind in ((1, bf.CRBF(2)), (16, bf.CRBF(6))):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, kind, wavy, bf.Material(2e11, 0.3, 7800.0))
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1e3))])
        if elements == 1:
            with pytest.warns(bf.CoarseMeshWarning, match="the mesh is too coarse"):
                solution = bf.solve_static(model)
        else:
            solution = bf.solve_static(model)
        tips.append(solution.displacement(beam.end)[-1, 1])
    assert abs(tips[0] / tips[1] - 1.0) > 0.05


@pytest.mark.parametrize("load", [bf.Temperature, bf.Actuation])
def test_a_clamped_bar_that_does_not_move_has_no_coarse_mesh(load):
    """Round-off of its displacements was off by more than the largest one."""
    steel = bf.Material(2.1e11, 0.3, 7850.0, thermal_expansion=1.2e-5)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), bf.Rectangle(0.01, 0.01), steel)
    bent = load(bar, 0.0, gradient=1e3) if load is bf.Temperature else load(bar, curvature=0.1)
    model = bf.Model([bar], [bf.Clamp(bar.start), bf.Clamp(bar.end)], [bent])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution = bf.solve_static(model)
    assert not solution.warnings
