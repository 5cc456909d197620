"""Values that no material, section or planet has in the units that a model names."""

import warnings

import pytest

import beamfem as bf
from beamfem.units import Units


def model(units, modulus, density, gravity=None, height=10.0, length=1000.0):
    """A cantilever of given numbers."""
    material = bf.Material(modulus, 0.3, density)
    beam = bf.Beam(bf.Line((0, 0), (length, 0)), 4, bf.CRBF(2), bf.Rectangle(height, height), material)
    loads = [] if gravity is None else [bf.Gravity((0.0, -gravity))]
    return bf.Model([beam], [bf.Clamp(beam.start)], loads, units=units)


def test_numbers_in_si_under_the_name_of_millimetres():
    """The cantilever sagged by 904 mm of 1000 and had 0.008 Hz; in MPa and t/mm^3 nothing is asked."""
    with pytest.warns(bf.UnitsWarning) as caught:
        model("N, mm", 2e11, 7850.0, 9810.0)
    (warning,) = caught
    text = str(warning.message)
    assert "youngs_modulus 2e+11 MPa is 2e+17 Pa" in text
    assert "(2e+11 Pa is 2e+05 MPa)" in text
    assert "density 7850 t/mm^3 is 7.85e+15 kg/m^3" in text
    assert "(7850 kg/m^3 is 7.85e-09 t/mm^3)" in text
    assert "gravity" not in text
    assert warning.filename == __file__


def test_the_warnings_of_a_solution_have_it_too():
    with pytest.warns(bf.UnitsWarning) as caught:
        named = model("N, mm", 2e11, 7.85e-9)
    assert str(caught[0].message) in bf.solve_static(named).warnings
    assert not bf.solve_static(model("N, mm", 2e5, 7.85e-9)).warnings


@pytest.mark.parametrize(
    ("units", "modulus", "density", "gravity", "height", "length"),
    [
        ("N, mm", 2e5, 7.85e-9, 9810.0, 10.0, 1000.0),
        ("kN, m", 2.1e8, 7.85, 9.81, 0.1, 5.0),
        ("lbf, in", 3e7, 7.3e-4, 386.0, 1.0, 40.0),
        ("uN, um", 1.6e5, 2.33e-15, 9.81e6, 2.0, 200.0),
        ("N, m", 1e6, 1000.0, 9.81, 0.01, 1.0),
    ],
)
def test_consistent_numbers_are_not_asked_about(units, modulus, density, gravity, height, length):
    model(units, modulus, density, gravity, height, length)  # a warning would be an error


@pytest.mark.parametrize(
    ("units", "modulus", "density", "gravity", "said"),
    [
        ("N, mm", 2.1e5, 7.85e-6, 9810.0, r"7\.85e-06 kg/mm\^3 is 7\.85e-09 t/mm\^3"),
        ("kN, m", 2.1e8, 7850.0, 9.81, r"7850 kg/m\^3 is 7\.85 t/m\^3"),
        ("N, m, ms", 2.1e11, 7.85e9, 9.81, r"gravity 9\.81 m/ms\^2 .*\(9\.81 m/s\^2 is 9\.81e-06 m/ms\^2\)"),
        ("N, m", 40.0, 1000.0, 9.81, "youngs_modulus 40 Pa is 40 Pa, which is not within 100 to 2e\\+12 "),
    ],
)
def test_the_likely_slip_is_named(units, modulus, density, gravity, said):
    with pytest.warns(bf.UnitsWarning, match=said):
        model(units, modulus, density, gravity, 0.1 if "mm" not in units else 10.0, 5.0 if "mm" not in units else 1e3)


def test_a_section_larger_than_the_beam_is_long():
    with pytest.warns(bf.UnitsWarning, match="a section 100 m high is larger than its beam is long, 5 m"):
        model("kN, m", 2.1e8, 7.85, None, 100.0, 5.0)


def test_numbers_without_named_units_may_be_in_any():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        material = bf.Material(1.0, 0.0, 1.0)
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(2.0, 2.0), material)
        bf.Model([beam], [bf.Clamp(beam.start)])


@pytest.mark.parametrize(
    ("units", "powers", "expected"),
    [
        (Units("lbf", "in"), (1, -2, 0), 6894.757),  # a psi in Pa
        (Units("kgf", "cm"), (1, -2, 0), 98066.5),  # a technical atmosphere
        (Units("N", "mm"), (1, -4, 2), 1e12),  # t/mm^3 in kg/m^3
        (Units("lbf", "ft", "min"), (0, 1, -2), 0.3048 / 3600.0),
    ],
)
def test_units_in_si(units, powers, expected):
    assert units.in_si(*powers) == pytest.approx(expected, rel=1e-6)
