"""Warnings that a user sees: Python warnings of errors of 1 % and more, and their number in the text of results."""

import warnings

import numpy as np
import pytest
from section_laws import LinearLaw
from slow_values import mostly_slow

import beamfem as bf
from beamfem.section import StiffnessSection

pytestmark = pytest.mark.filterwarnings("error::beamfem.LockingWarning", "error::beamfem.LargeStrainWarning")
STEEL = bf.Material(2.1e11, 0.3, 7850.0)


def cantilever(element, count, slenderness, load=5.0, **material):
    """A model of a cantilever of length 1 under a force P with P L^2 / (E I) = load, and its beam."""
    height = 1.0 / slenderness
    section = bf.Rectangle(height, height)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), count, element, section, bf.Material(2.1e11, 0.3, 7850.0, **material))
    force = bf.PointForce(beam.end, (0.0, load * 2.1e11 * section.second_moment))
    return bf.Model([beam], [bf.Clamp(beam.start)], [force]), beam


def test_locking_warns_at_the_solve_and_is_counted():
    """The tip is at (0.967, 0.224) instead of (0.612, 0.714), of which nothing was seen."""
    model, _ = cantilever(bf.ANCF(), 20, 1e4)
    with pytest.warns(bf.LockingWarning, match="without locking the largest displacement would change by more than"):
        solution = bf.solve_static(model)
    assert "1 warning" in repr(solution)
    assert len(solution.warnings) == 1


def test_a_warning_is_about_the_line_of_the_user():
    model, _ = cantilever(bf.ANCF(), 20, 1e4)
    with pytest.warns(bf.LockingWarning) as caught:
        bf.solve_static(model)
    assert caught[0].filename == __file__


def test_a_filter_silences_one_category():
    model, _ = cantilever(bf.ANCF(), 20, 1e4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", bf.LockingWarning)
        solution = bf.solve_static(model)
    assert solution.warnings


def test_below_one_per_cent_it_is_said_in_the_result_only():
    model, _ = cantilever(bf.ANCF(), 32, 100)
    solution = bf.solve_static(model)  # a warning would be an error here
    assert "about 0.13 %" in solution.warnings[0]
    assert "1 warning" in repr(solution)


def test_a_result_without_warnings_says_nothing_of_them():
    model, _ = cantilever(bf.CRBF(3), 8, 20, 1.0)
    solution = bf.solve_static(model)
    assert solution.warnings == ()
    assert "warning" not in repr(solution)


@pytest.mark.parametrize(
    "solve",
    [
        lambda model: bf.solve_static(model, at=[0.5, 1.0]),
        lambda model: bf.trace_equilibrium(model, until=1.0),
        lambda model: bf.simulate(model, duration=0.05, step=5e-4),
    ],
    ids=["static", "path", "motion"],
)
def test_every_analysis_warns(solve):
    model, _ = cantilever(bf.ANCF(), 4, 100)
    with pytest.warns(bf.LockingWarning):
        solve(model)


def test_modes_warn_of_locking_and_count_it():
    """About the bent cantilever, whose frequencies a coarse mesh raises."""
    model, _ = cantilever(bf.BilinearANCF(), 8, 50, 0.0001)
    with pytest.warns(bf.LockingWarning, match="a frequency would change by"):
        modes = bf.solve_modes(model, count=2)
    assert "1 warning" in repr(modes)
    assert len(modes.warnings) == 1


@mostly_slow("make", [bf.ANCF, bf.ANCFCRBF, bf.BilinearANCF, lambda: bf.CRBF(2, integration="full")], quick=(0, 2))
def test_no_locking_of_one_per_cent_escapes_the_bound(make):
    """What the chords of elements say decides whether the estimate is made; it may look in vain, never miss."""
    for slenderness in (2.0, 10.0, 100.0, 1000.0):
        for count in (1, 2, 4, 8, 16, 32):
            for load in (0.01, 5.0):
                model, _ = cantilever(make(), count, slenderness, load)
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    try:
                        solution = bf.solve_static(model)
                    except bf.ConvergenceError:  # some of the coarsest meshes snap through
                        continue
                said = any(issubclass(warning.category, bf.LockingWarning) for warning in caught)
                sentence = next((text for text in solution.warnings if "elements lock" in text), "about 0 %")
                size = 100.0 if "more than" in sentence else float(sentence.split("about ")[1].split(" %")[0])
                assert said == (size >= 1.0) or size == pytest.approx(1.0, rel=0.05)


def test_a_utilisation_above_one_warns_with_its_place():
    """M = F L at the clamp: sigma / strength by hand."""
    load, height, strength = 0.01, 0.05, 1e6
    model, _ = cantilever(bf.CRBF(3), 8, 1.0 / height, load, strength=strength)
    expected = load * 2.1e11 * height / 2.0 / strength
    with pytest.warns(bf.LargeStrainWarning, match=f"utilisation of the strength reaches {expected:.3g} at 0 m of"):
        solution = bf.solve_static(model)
    assert solution.peak_stress("utilisation").value == pytest.approx(expected, rel=1e-3)


def test_stress_of_a_hindered_expansion_is_not_missed():
    """E alpha T = 1.2 times the strength in a bar between two clamps, in which nothing moves."""
    material = bf.Material(2e11, 0.3, 7850.0, thermal_expansion=1e-5, strength=1e8)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.1, 0.1), material)
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], [bf.Temperature(beam, 60.0)])
    with pytest.warns(bf.LargeStrainWarning, match=r"utilisation of the strength reaches 1\.2 "):
        bf.solve_static(model)


def test_strains_beyond_a_linear_law_warn_with_place_and_value():
    """A stretch of 0.3: a bar pulled by F = 0.3 E A."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1000.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (3e3, 0.0))])
    with pytest.warns(
        bf.LargeStrainWarning, match=r"strains reach 0\.3 at 0\.\d+ m of beam 0 in row \d+, load factor 1:"
    ):
        bf.solve_static(model)


def test_strains_up_to_a_fifth_and_large_rotations_do_not_warn():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.CRBF(3), bf.Rectangle(0.05, 0.05), bf.Material(1e6, 0.3, 1000.0))
    bending = 1e6 * 0.05**4 / 12.0
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 2.0 * np.pi * bending)])
    assert bf.solve_static(model).warnings == ()  # h kappa / 2 = 0.157


def test_a_bend_beyond_a_fifth_warns():
    """h kappa / 2 = 0.31 of a rod rolled up to a circle."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.CRBF(3), bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1000.0))
    bending = 1e6 * 0.1**4 / 12.0
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 2.0 * np.pi * bending)])
    with pytest.warns(bf.LargeStrainWarning, match=r"strains reach 0\.314 "):
        bf.solve_static(model)


def test_a_section_law_may_strain_as_far_as_it_describes():
    """The same bar with the linear section (E A = 1e4), and with a law of its own: only linear sections end at 0.2."""
    for section, categories in ((StiffnessSection, [bf.LargeStrainWarning]), (LinearLaw, [])):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), section(1e4, 3e3, 8.0, 1.0, 0.01))
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (2.5e3, 0.0))])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            solution = bf.solve_static(model)
        assert solution.displacement(beam.end)[-1, 0] == pytest.approx(0.25, rel=1e-6)
        assert [warning.category for warning in caught] == categories


def test_warnings_name_the_line_that_called_the_package():
    """However deep inside the package they arise."""
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    loads = [bf.PointForce(column.end, (0, -1000.0))]
    with pytest.warns(bf.UnstableWarning) as caught:
        bf.solve_static(bf.Model([column], supports=[bf.Clamp(column.start)], loads=loads), steps=3)
    assert {warning.filename for warning in caught} == {__file__}
