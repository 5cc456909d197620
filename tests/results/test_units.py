"""Units are names in labels; no number changes."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.cli.model_file import ModelFileError, read_model_file
from beamfem.units import units_of

# the same numbers under the names of several units
pytestmark = pytest.mark.filterwarnings("ignore::beamfem.UnitsWarning")


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ("N, m", {"m": "m", "N m": "N m", "Pa": "Pa", "J": "J", "m/s": "m/s", "Hz": "Hz", "rad": "rad", "-": "-"}),
        ("N, mm", {"m": "mm", "N m": "N mm", "Pa": "MPa", "J": "N mm", "m/s": "mm/s", "1/m": "1/mm", "K/m": "K/mm"}),
        ("kN, m", {"N": "kN", "Pa": "kPa", "J": "kN m"}),
        ("in, lbf", {"N m": "lbf in", "Pa": "psi"}),
        ("uN, um, ms", {"m/s": "um/ms", "Hz": "1/ms", "Pa": "MPa"}),
        ("N, cm", {"Pa": "N/cm^2"}),
    ],
)
def test_units_of_a_model_take_the_place_of_those_of_si(given, named):
    assert {si: units_of(given).of(si) for si in named} == named


def strip(units="N, mm"):
    """A strip of steel in newton, millimetres and tonnes, and where it bends to under 10 N."""
    steel = bf.Material(2e5, 0.3, 7.8e-9)
    beam = bf.Beam(bf.Line((0, 0), (500, 0)), 4, bf.CRBF(order=3), bf.Rectangle(20, 4), steel)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -10))], units=units)


def test_pictures_pages_and_tables_name_them(tmp_path):
    beam, model = strip()
    solution = bf.solve_static(model)
    shape = solution.plot(colour="stress")
    assert [shape.axes[0].get_xlabel(), shape.axes[0].get_ylabel()] == ["x [mm]", "y [mm]"]
    assert shape.axes[1].get_ylabel() == "von Mises stress [MPa]"
    assert solution.plot_history(beam.end).axes[0].get_ylabel() == "displacement [mm]"
    assert solution.plot_curve(("uy", beam.end), ("m", beam.start)).axes[0].get_ylabel().endswith("[N mm]")
    assert bf.solve_modes(model, count=1).plot().axes[0].get_xlabel() == "x [mm]"
    assert "500 mm long in all" in model._repr_html_()
    assert " mm at (500, 0)" in solution._repr_html_()
    page = solution.to_html(tmp_path / "strip.html").read_text()
    assert '"length":"mm"' in page
    assert "bending moment [N mm]" in page
    assert "[Pa]" not in solution.stresses(beam)._repr_html_()
    fast = bf.Model(model.beams, model.supports, units="N, mm, ms")
    modes = bf.solve_modes(fast, count=1)
    assert "frequency [1/ms]" in modes._repr_html_()
    assert repr(modes).endswith("1/ms)")
    assert modes.plot().axes[0].get_title().endswith("1/ms")
    motion = bf.simulate(model, duration=1e-3, step=1e-4)
    assert motion.plot_curve("time", ("vy", beam.end)).axes[0].get_ylabel() == "velocity vy at (500, 0) [mm/s]"


def test_no_number_changes_and_files_keep_them(tmp_path):
    (beam, named), (plain, model) = strip(), strip("N, m")
    one, other = bf.solve_static(named), bf.solve_static(model)
    assert np.array_equal(one.position(beam.end), other.position(plain.end))
    one.save(tmp_path / "strip.h5")
    assert bf.load(tmp_path / "strip.h5").model.units == "N, mm"
    assert "units" not in repr(named)


@pytest.mark.parametrize(
    ("units", "said"),
    [("N, mn", "'mn' is none; did you mean"), ("N, kN", "one force"), (3, "units must be a text"), ("", "'' is none")],
)
def test_units_that_are_none_are_refused(units, said):
    with pytest.raises(bf.InputError, match=said):
        strip(units)


def test_a_model_file_names_them(tmp_path):
    path = tmp_path / "strip.toml"
    text = """
units = "N, mm"
[materials.steel]
youngs_modulus = 2e5
poisson_ratio = 0.3
density = 7.8e-9
[beams.strip]
curve = { kind = "line", start = [0, 0], end = [500, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 20, height = 4 }
material = "steel"
[[supports]]
kind = "clamp"
point = "strip.start"
"""
    path.write_text(text)
    assert read_model_file(path).model.unit("N m") == "N mm"
    path.write_text(text.replace("N, mm", "N, furlong"))
    with pytest.raises(ModelFileError, match="'furlong' is none") as caught:
        read_model_file(path)
    assert caught.value.line == 2


def test_printed_results_tell_their_units():
    """A peak printed bare numbers, a motion the times of its rows without the second."""
    beam, model = strip()
    solution, motion = bf.solve_static(model), bf.simulate(model, 1e-3, 1e-4)
    peak = solution.stresses(beam).peak("tension")
    assert repr(peak) == f"Peak(tension {peak.value:.4g} MPa at 0 mm in row 1, load factor 1, of beam 0)"
    assert f"tension {peak.in_words}" in repr(solution.stresses(beam))
    assert "von_mises" in repr(motion.peak_stress())
    assert repr(motion.peak_stress()).endswith(" mm in row 10, t = 0.001 s, of beam 0)")
    assert "utilisation is not known" in repr(solution.stresses(beam).peak("utilisation"))
    assert "time 0 to 0.001 s" in repr(motion)
