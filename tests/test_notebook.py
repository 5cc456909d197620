"""Tables for notebooks and labelled arrays."""

import re
import sys

import numpy as np
import pytest
from drawn import arch, cantilever, frame, pendulum

import beamfem as bf
from beamfem.io.table import arrays


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
    assert rows["ended"] == solution.statistics.ended
    moved = np.linalg.norm(solution.displacement(solution.model.beams[0].end)[-1])
    assert rows["largest displacement"].startswith(f"{moved:.4g} m")
    assert rows["largest displacement"].endswith("at (1, 0), in the last row")
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


def test_several_beams_need_a_name(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", sys)
    with pytest.raises(bf.InputError, match="3 beams"):
        frame().to_xarray()
