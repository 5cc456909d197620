"""Names of beams and units of the model in what is saved, exported and printed."""

from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf
from beamfem.io.description import describe, rebuild

# the same numbers under the names of several units
pytestmark = pytest.mark.filterwarnings("ignore::beamfem.UnitsWarning")


def bracket(units="N, mm"):
    """Two beams of steel in newton and millimetres, one of them with a name."""
    steel = bf.Material(2e5, 0.3, 7.8e-9)
    arm = bf.Beam(bf.Line((0, 0), (100, 0)), 2, bf.CRBF(3), bf.Rectangle(10, 2), steel, name="arm")
    post = bf.Beam(bf.Line((100, 0), (100, 50)), 2, bf.CRBF(3), bf.Circle(5), steel)
    joints, loads = [bf.Rigid(arm.end, post.start)], [bf.PointForce(post.end, (1, 0))]
    return bf.Model([arm, post], [bf.Clamp(arm.start)], loads, joints, units=units)


def test_names_are_saved_and_older_files_have_none(tmp_path):
    model = bracket()
    bf.solve_static(model).save(tmp_path / "a.h5")
    assert [beam.name for beam in bf.load(tmp_path / "a.h5").model.beams] == ["arm", None]
    older = describe(model, np.array([0.0, 1.0]))
    for beam in older["beams"]:
        del beam["name"]
    assert [beam.name for beam in rebuild(older).beams] == [None, None]


def test_a_crooked_model_keeps_names():
    model = bracket()
    crooked = model.with_imperfection(bf.solve_modes(model, count=1), 0.1)
    assert [beam.name for beam in crooked.beams] == ["arm", None]


def test_messages_and_texts_call_beams_by_name():
    model = bracket()
    arm, post = model.beams
    assert repr(arm) == "Beam('arm', Line of length 100, 2 x CRBF-3)"
    assert str(arm.end) == "(100, 0), fraction 1 of beam 'arm'"
    with pytest.raises(bf.InputError, match=r"beam 'arm' and \(101, 0\), .* of its beam, which are 1 mm apart"):
        bf.Model(
            [arm, moved := replace(post, curve=bf.Line((101, 0), (101, 9)))],
            joints=[bf.Rigid(arm.end, moved.start)],
            units="N, mm",
        )
    with pytest.raises(bf.FreeMotionError, match="beam 'arm' can move freely"):
        bf.solve_static(bf.Model([arm], [bf.Pin(arm.start)], [bf.PointForce(arm.end, (0, 1))]))
    with pytest.raises(bf.InputError, match="2 beams of a Model have the name 'arm'"):
        bf.Model([arm, replace(arm)])
    with pytest.raises(bf.InputError, match="the name '1', the number of one without a name"):
        bf.Model([replace(arm, name="1"), post])
    for name in ("", " ", 3):
        with pytest.raises(bf.InputError, match="name of a Beam must"):
            replace(arm, name=name)
    assert "<td style='text-align: left; vertical-align: top'>arm</td>" in model._repr_html_()
    overlapping = replace(post, curve=bf.Arc((0, 0), 1.0, 0.0, 1.0), section=bf.Rectangle(1, 4), elements=8)
    with pytest.raises(bf.InputError, match=r"at arc length .* mm the axis .* a radius of curvature of 1 mm, .* 2 mm"):
        _ = bf.Model([overlapping], units="N, mm").meshes


@pytest.mark.filterwarnings("ignore::beamfem.errors.EnergyWarning")  # two steps of a sudden start
def test_motions_tell_energy_and_time_in_the_units_of_the_model():
    model = bracket("N, mm, ms")
    motion = bf.simulate(model, duration=1.0, step=0.5)
    assert motion.statistics.ended == "2 steps of 0.5 ms"
    assert motion.energy_drift.unit == "N mm"
    assert " N mm of " in repr(motion)


def test_paraview_files_have_names_and_units(tmp_path):
    pyvista, h5py = pytest.importorskip("pyvista"), pytest.importorskip("h5py")
    solution = bf.solve_static(bracket())
    solution.to_vtk(tmp_path / "a.pvd")
    for name in ("a", "a_centreline", "a_boundary"):
        grid = pyvista.read(tmp_path / name / "0001.vtu")
        array = grid.GetPointData().GetArray("displacement")
        assert array.GetInformation().Get(array.UNITS_LABEL()) == "mm"
    body = pyvista.read(tmp_path / "a" / "0001.vtu")
    stress = body.GetPointData().GetArray("von_mises_stress")
    assert stress.GetInformation().Get(stress.UNITS_LABEL()) == "MPa"
    assert list(body.field_data["beams"]) == ["arm", "1"]
    assert list(body.field_data["materials"]) == ["E = 200000 MPa, nu = 0.3, density 7.8e-09 t/mm^3"]
    assert list(body.field_data["sections"]) == ["rectangle 10 x 2 mm", "circle, diameter 5 mm"]
    solution.to_vtk(tmp_path / "a.vtkhdf")
    assert pyvista.read(tmp_path / "a_centreline.vtkhdf").n_points > 0
    with h5py.File(tmp_path / "a_centreline.vtkhdf") as file:
        assert list(file["VTKHDF/CellData/beam"].attrs["beams"]) == ["arm", "1"]
        assert file["VTKHDF/PointData/bending_moment"].attrs["units"] == "N mm"


def test_tables_of_beams_have_names():
    solution = bf.solve_static(bracket())
    pytest.importorskip("xarray")
    assert solution.to_xarray().beam.attrs["names"] == "arm, 1"


def test_results_files_have_section_forces_for_xarray(tmp_path, monkeypatch):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    model = bracket()
    solution, (arm, _) = bf.solve_static(model), model.beams
    solution.save(tmp_path / "a.h5")

    def opened(group):
        with xarray.open_dataset(tmp_path / "a.h5", group=group, engine="h5netcdf", phony_dims="access") as file:
            return file.load()

    one, other = opened("beams/0"), opened("beams/1")
    assert one.attrs["name"] == "arm"
    assert "name" not in other.attrs
    assert one.moment.dims == ("load_factor", "element_end")
    assert (one.moment.units, one.normal.units, one.element_end.units) == ("N mm", "N", "mm")
    assert one.element_end.values.tolist() == [0.0, 50.0, 50.0, 100.0]
    # the clamp turns the beam by its moment, which is minus that in the section beside it
    assert one.moment.values[-1, 0] == pytest.approx(-solution.reaction(arm.start)[-1, 2])
    monkeypatch.setattr("beamfem.io.results_hdf5._MOST", 3)
    solution.save(tmp_path / "a.h5")
    assert set(opened("beams/0")) == {"x", "y", "rotation"}
