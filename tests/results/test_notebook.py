"""Tables for notebooks and labelled arrays."""

import re
import sys

import numpy as np
import pytest
from drawn import arch, cantilever, frame, pendulum

import beamfem as bf
from beamfem.io.table import arrays
from beamfem.view import solid_pyvista


def rows_of(table):
    return dict(re.findall(r"<tr><td[^>]*>(.*?)</td><td[^>]*>(.*?)</td></tr>", table))


def test_model_tells_what_it_consists_of():
    model = frame().model
    rows = rows_of(model._repr_html_())
    assert rows["coordinates"] == str(model.size)
    assert rows["beams"] == "3, 3 m long in all"
    assert rows["elements"] == f"{sum(mesh.elements for mesh in model.meshes)} (CRBF-2)"
    assert rows["supports"] == "Clamp, Roller, Spring, Pin, Prescribed, Foundation"
    assert rows["loads"] == "Gravity, 2 DistributedLoad, 2 PointForce, PointMoment"
    assert rows["joints"] == "Hinge, Rigid"
    assert "(0, 0)" in model._repr_html_()


def test_solution_tells_how_it_ended():
    solution = cantilever()
    rows = rows_of(solution._repr_html_())
    assert rows["rows"] == "2"
    assert rows["load factor"] == "0 to 1"
    assert rows["ended"] == f"completed: {solution.statistics.ended}"
    assert rows["solved in"] == f"{solution.iterations} Newton iterations in 1 step"
    moved = np.linalg.norm(solution.displacement(solution.model.beams[0].end)[-1])
    assert rows["largest displacement"].startswith(f"{moved:.4g} m")
    assert rows["largest displacement"].endswith("at (1, 0), load factor 1")
    assert "<b>Path of statics</b>" in arch()._repr_html_()


def test_many_beams_are_not_all_listed():
    beams = [
        bf.Beam(bf.Line((0, i), (1, i)), 1, bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1.0))
        for i in range(40)
    ]
    assert "28 more" in bf.Model(beams)._repr_html_()


@pytest.mark.parametrize("make", [cantilever, pendulum])
def test_arrays_are_those_of_the_solution(make):
    solution = make()
    beam = solution.model.beams[0]
    data, coordinates = arrays(solution, beam)
    end = {name: values[:, -1] for name, (_, values, _) in data.items() if values.ndim == 2}
    np.testing.assert_allclose(np.stack([end["x"], end["y"]], axis=1), solution.position(beam.end), atol=1e-13)
    np.testing.assert_allclose(np.stack([end["ux"], end["uy"]], axis=1), solution.displacement(beam.end), atol=1e-13)
    np.testing.assert_allclose(end["rotation"], solution.rotation(beam.end), atol=1e-12)
    np.testing.assert_allclose(end["axial_strain"], solution.fields(beam.end).green_strain.xx, atol=1e-12)
    np.testing.assert_array_equal(data["strain_energy"][1], solution.energy().strain)
    name = "load_factor" if solution.static else "time"
    np.testing.assert_array_equal(coordinates[name][1], solution.at)
    assert ("vx" in data) != solution.static
    for dims, values, about in (*data.values(), *coordinates.values()):
        assert len(dims) == values.ndim
        assert set(about) == {"units", "long_name"}
    assert data["moment"][2]["units"] == "N m"


def test_xarray():
    xarray = pytest.importorskip("xarray")
    solution = pendulum()
    found = solution.to_xarray()
    assert isinstance(found, xarray.Dataset)
    np.testing.assert_array_equal(found["time"], solution.time)
    assert found["moment"].attrs["units"] == "N m"


def test_without_xarray_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(bf.BeamfemError, match=r"beamfem\[xarray\]"):
        cantilever().to_xarray()


def test_a_figure_shows_itself():
    """As PNG, which is what is asked of the last value of a cell, whatever backend is active."""
    figure = cantilever().plot()
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_what_is_written_shows_itself(tmp_path):
    solution = cantilever()
    page = solution.to_html(tmp_path / "page.html")
    assert page == tmp_path / "page.html"
    assert page._repr_html_().startswith('<iframe srcdoc="&lt;!doctype html')
    film = solution.animate(tmp_path / "film.gif")
    assert film._repr_html_().startswith('<img src="data:image/gif;base64,')
    film.unlink()
    assert film._repr_html_() is None
    assert (page.parent / "other.txt")._repr_html_() is None


def test_without_a_path_the_file_is_a_temporary_one():
    solution = cantilever()
    assert solution.animate(seconds=0.2)._repr_html_().startswith('<img src="data:image/gif;base64,')
    assert "<iframe srcdoc=" in solution.to_html()._repr_html_()
    study = bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[1, 2, 4])
    assert "<iframe srcdoc=" in study.to_html()._repr_html_()
    assert solution.to_html() != solution.to_html()


def test_show_in_a_notebook_is_a_page_with_a_slider_where_nothing_else_is_installed(monkeypatch):
    monkeypatch.setattr(solid_pyvista, "in_notebook", lambda: True)
    monkeypatch.setattr(solid_pyvista, "find_spec", lambda name: None)
    assert "<iframe srcdoc=" in cantilever().show()._repr_html_()


def test_modes_and_critical_loads_are_tables():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    free = bf.solve_modes(bf.Model([beam]), count=4)
    table = free._repr_html_()
    assert table.count("<tr>") == 5
    assert table.count("rigid: ") == 3
    assert f"{free.frequencies[3]:.6g}" in table
    column = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [bf.PointForce(beam.end, (-1.0, 0.0))])
    buckling = bf.solve_buckling(column, count=2)
    for load in buckling.load_factors:
        assert f"{load:.6g}" in buckling._repr_html_()
    assert "ended because the requested number, 2, was found" in buckling._repr_html_()


def test_sweeps_studies_and_stresses_are_tables():
    found = bf.sweep(lambda load: {"sag": 2.0 * load}, load=[1.0, 2.0])
    assert "<td style='text-align: left; vertical-align: top'>4</td>" in found._repr_html_()
    study = bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[1, 2, 4, 8])
    assert "Convergence of" in study._repr_html_()
    solution = cantilever()
    peaks = solution.stresses(solution.model.beams[0])._repr_html_()
    assert f"{solution.stresses(solution.model.beams[0]).peak().value:.6g}" in peaks


def test_the_largest_displacement_is_that_of_all_rows(tmp_path):
    """Of a vibration that is back at rest in its last row, and inside of elements too."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(4), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)])
    swing = bf.solve_modes(model, 1).solution(0, amplitude=1e-3, frames=5)[:4]
    rows = rows_of(swing._repr_html_())
    when = f"t = {swing.time[0]:.3g} s"
    assert rows["largest displacement"] == f"0.001 m: (0, 0.001) m at (0.5, 0), {when}".replace(
        "0, 0.001", _moved(swing)
    )
    assert np.abs(swing.displacement(beam.at(0.5))[-1]).max() < 1e-9
    assert f"at (0.5, 0), {when}" in swing.to_html(tmp_path / "swing.html").read_text()


def _moved(swing):
    ux, uy = swing.displacement(swing.model.beams[0].at(0.5))[0]
    return f"{0.0 if abs(ux) < 1e-12 else ux:.4g}, {uy:.4g}"


def test_states_beams_energies_and_section_forces_are_tables():
    solution = cantilever()
    beam, tip = solution.model.beams[0], solution.displacement(solution.model.beams[0].end)[-1]
    rows = rows_of(solution[-1]._repr_html_())
    assert rows["load factor or time"] == "1"
    assert rows["largest displacement"].startswith(f"{np.linalg.norm(tip):.4g} m")
    assert rows_of(arch()[2]._repr_html_())["at rest"] == "yes"
    assert rows_of(pendulum()[5]._repr_html_())["at rest"] == "no"
    rows = rows_of(beam._repr_html_())
    assert rows["curve"] == "Line, (0, 0) to (1, 0)"
    assert (rows["length"], rows["elements"]) == ("1", "4")
    assert rows["element"].startswith("CRBF-3")
    assert rows["section"].startswith("area 0.0001, second moment 8.333e-10")
    assert rows["material"] == "youngs modulus 2e+11, poisson ratio 0.3, density 7800"
    table = solution.energy()._repr_html_()
    assert "largest [J]" in table
    assert f"{solution.energy().strain[-1]:.6g}" in table
    forces = solution.section_forces(beam)
    table = forces._repr_html_()
    assert f"{forces.moment.max():.6g}" in table
    assert "largest moment [N m]" in table
    path = arch()
    assert "<b>SectionForces</b>" in path[2].section_forces(path.model.beams[0])._repr_html_()


def test_tables_of_a_model_in_millimetres_say_so():
    beam = bf.Beam(bf.Line((0, 0), (500, 0)), 4, bf.CRBF(3), bf.Rectangle(20, 4), bf.Material(2e5, 0.3, 7.8e-9))
    solution = bf.solve_static(
        bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -10))], units="N, mm")
    )
    assert "largest [N mm]" in solution.energy()._repr_html_()
    assert "moment [N mm]" in solution.section_forces(beam)._repr_html_()
    assert "von_mises [MPa]" in solution.stresses(beam)._repr_html_()
    assert " MPa at 0 mm" in repr(solution.stresses(beam))
