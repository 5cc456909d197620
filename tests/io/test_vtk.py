"""ParaView files: read back what was written."""

import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from drawn import EI, arch, cantilever
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import VTK_LAGRANGE_QUADRILATERAL, VTK_LINE
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import beamfem as bf
from beamfem.io import vtk
from beamfem.io import vtk_cells as cells
from beamfem.results.axis_points import axis_at

HEIGHT = 0.02
# Degree (3, 2): xi and side of the twelve points of a cell, from vtkHigherOrderQuadrilateral.PointIndexFromIJK.
XI = np.array([0.0, 3.0, 3.0, 0.0, 1.0, 2.0, 3.0, 1.0, 2.0, 0.0, 1.0, 2.0]) / 3.0
SIDE = np.array([-1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
Y = 0.5 * HEIGHT * SIDE


def swing(*elements, duration=0.2, step=0.02, **options):
    beams = []
    for i, element in enumerate(elements):
        line = bf.Line((0.0, float(i)), (0.6, 0.8 + i))
        material = bf.Material(2e6, 0.3, 5000.0)
        beams.append(bf.Beam(line, 3, element, bf.Rectangle(0.02, HEIGHT), material))
    model = bf.Model(beams, [bf.Pin(beam.start) for beam in beams], [bf.Gravity((0.0, -9.81))])
    return bf.simulate(model, duration, step, **options)


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def collection(path):
    """Times (steps,) and files of a .pvd."""
    sets = ElementTree.parse(path).findall("./Collection/DataSet")
    return np.array([float(s.get("timestep")) for s in sets]), [Path(path).parent / s.get("file") for s in sets]


def point_data(grid):
    data = grid.GetPointData()
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


@pytest.fixture(scope="module")
def solution():
    return swing(bf.ANCFCRBF(), bf.BilinearCRBF())


@pytest.fixture(scope="module")
def written(solution, tmp_path_factory):
    path = tmp_path_factory.mktemp("vtk") / "new folder" / "a & b" / "swing.pvd"
    solution.to_vtk(path)
    return path


def test_a_file_a_step_at_the_times_of_the_solution(solution, written):
    for path in (written, *(written.with_name(f"swing_{part}.pvd") for part in ("centreline", "boundary"))):
        times, files = collection(path)
        np.testing.assert_array_equal(times, solution.at)
        assert all(file.is_file() for file in files)
    parts = ("swing", "swing_centreline", "swing_boundary")
    names = [f"{part}{suffix}" for part in parts for suffix in ("", ".pvd")]
    assert sorted(file.name for file in written.parent.iterdir()) == sorted(names)


def test_points_are_those_of_the_field(solution, written):
    _, files = collection(written)
    for row in (0, 5, len(solution) - 1):
        points = vtk_to_numpy(read(files[row]).GetPoints().GetData()).reshape(2, 3, 12, 3)
        for mesh, found in zip(solution.model.meshes, points, strict=True):
            for element in range(mesh.elements):
                axis = axis_at(mesh, solution.p[row : row + 1], np.full(12, element), XI)
                np.testing.assert_allclose(found[element, :, :2], axis.r[0] + Y[:, None] * axis.d[0], atol=1e-14)
        assert not points[..., 2].any()


def test_cells_are_curved_quadrilaterals_with_active_degrees(written):
    grid = read(collection(written)[1][-1])
    assert {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())} == {VTK_LAGRANGE_QUADRILATERAL}
    degrees = grid.GetCellData().GetHigherOrderDegrees()
    assert degrees is not None
    assert degrees.GetTuple(0)[:2] == (3.0, 2.0)


def test_vtk_maps_a_cell_onto_the_body(written):
    """A wrong order of the points would fold the cell."""
    grid = read(collection(written)[1][0])
    cell, weights = grid.GetCell(1), [0.0] * 12
    corner, bottom, top, middle = ([0.0] * 3 for _ in range(4))
    for place, xyz in (((0, 0, 0), corner), ((0.5, 0, 0), bottom), ((0.5, 1, 0), top), ((0.5, 0.5, 0), middle)):
        cell.EvaluateLocation(reference(0), place, xyz, weights)
    np.testing.assert_allclose(np.subtract(top, bottom)[:2], HEIGHT * np.array([-0.8, 0.6]), atol=1e-12)
    np.testing.assert_allclose(middle[:2], [0.3, 0.4], atol=1e-12)
    np.testing.assert_allclose(np.subtract(bottom, corner)[:2], np.array([0.6, 0.8]) / 6.0, atol=1e-12)


def test_body_data(written):
    _, files = collection(written)
    start, end = read(files[0]), read(files[-1])
    data = point_data(end)
    assert all(np.isfinite(values).all() for values in data.values())
    for name in ("displacement", "velocity"):
        assert data[name].shape == (72, 3)
        assert np.abs(data[name]).max() > 0.01
    for tensor, components in (("green_strain", ("xx", "yy", "xy")), ("stress", ("xx", "xy"))):
        assert all(data[f"{tensor}_{component}"].shape == (72,) for component in components)
    assert "stress_yy" not in data  # zero in beam theory
    moved = vtk_to_numpy(end.GetPoints().GetData()) - vtk_to_numpy(start.GetPoints().GetData())
    np.testing.assert_allclose(data["displacement"], moved, atol=1e-13)


def test_strain_belongs_to_the_height_of_its_point():
    """Bent counter-clockwise: the lower face is stretched and the upper one compressed, and so is the stress."""
    element = bf.CRBF(3)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, bf.Rectangle(0.02, HEIGHT), bf.Material(2e6, 0.0, 1.0))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 1e-3)]))
    (samples,) = cells.bodies(solution.model)
    data = samples.arrays(solution)
    strain, stress = data["green_strain_xx"][-1].reshape(2, 12), data["stress_xx"][-1].reshape(2, 12)
    assert (strain[:, SIDE < 0.0] > 0.0).all()
    assert (strain[:, SIDE > 0.0] < 0.0).all()
    np.testing.assert_allclose(stress, np.tile(-1e-3 * Y / (0.02 * HEIGHT**3 / 12), (2, 1)), rtol=1e-6, atol=1e-6)


def test_velocity_is_the_rate_of_the_points():
    solution = swing(bf.ANCFCRBF(), duration=0.02, step=1e-4)
    (samples,) = cells.bodies(solution.model)
    data = samples.arrays(solution)
    rate = (data["points"][101] - data["points"][99]) / 2e-4
    # the integrator's velocity and the central difference both are of second order in the step
    np.testing.assert_allclose(data["velocity"][100], rate, atol=5e-5 * np.abs(rate).max())


def test_centreline(solution, written):
    grid = read(collection(written.with_name("swing_centreline.pvd"))[1][-1])
    assert {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())} == {VTK_LINE}
    points, data = vtk_to_numpy(grid.GetPoints().GetData()), point_data(grid)
    half = len(points) // 2
    for beam, last in zip(solution.model.beams, (half - 1, -1), strict=True):
        np.testing.assert_allclose(points[last, :2], solution.position(beam.end)[-1], atol=1e-14)
        np.testing.assert_allclose(data["displacement"][last, :2], solution.displacement(beam.end)[-1], atol=1e-14)
        np.testing.assert_allclose(data["velocity"][last, :2], solution.velocity(beam.end)[-1], atol=1e-13)
        np.testing.assert_allclose(data["rotation"][last], solution.rotation(beam.end)[-1], atol=1e-13)


@pytest.mark.parametrize("element", [bf.BilinearANCF(), bf.BilinearCRBF()])
def test_rotation_counts_full_turns_over_chunks(element, tmp_path, monkeypatch):
    spin = 2.0 * np.pi * 10.0
    material = bf.Material(2e7, 0.3, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, element, bf.Rectangle(0.02, HEIGHT), material)
    model, velocity = bf.Model([beam], [bf.Pin(beam.start)]), bf.RigidVelocity(angular=spin)
    solution = bf.simulate(model, 0.25, 0.0005, velocity=velocity, save_every=10)
    monkeypatch.setattr(vtk, "VALUES_IN_MEMORY", 1)
    solution.to_vtk(tmp_path / "spin.pvd")
    rotation = point_data(read(tmp_path / "spin" / "0050.vtu"))["rotation"]
    expected = solution.rotation(beam.end)[-1]
    assert expected > 4.0 * np.pi
    np.testing.assert_allclose(rotation[1:3], expected, atol=1e-12)


def test_a_path_without_a_suffix_becomes_one_file_of_all_steps(solution, tmp_path):
    pytest.importorskip("h5py")
    solution.to_vtk(tmp_path / "folder" / "fall")
    names = ["fall.vtkhdf", "fall_boundary.vtkhdf", "fall_centreline.vtkhdf"]
    assert sorted(file.name for file in (tmp_path / "folder").iterdir()) == names


def test_other_suffixes_are_refused(solution, tmp_path):
    with pytest.raises(bf.InputError, match=r'swing\.pvd" would be right'):
        solution.to_vtk(tmp_path / "swing.vtu")
    assert not list(tmp_path.iterdir())
    with pytest.raises(bf.InputError, match="a path is a text"):
        solution.to_vtk("")


def test_an_export_that_fails_leaves_no_collection(solution, tmp_path):
    (tmp_path / "swing" / "0003.vtu").mkdir(parents=True)
    with pytest.raises(bf.FileError, match=r"swing\.pvd"):
        solution.to_vtk(tmp_path / "swing.pvd")
    assert [path.name for path in tmp_path.iterdir()] == ["swing"]


def test_section_forces_on_the_centreline(tmp_path):
    """A dead tip force P: at every point of the centreline M is P times the lever arm to the tip where it is now."""
    solution = cantilever(load=2.0, elements=12)
    solution.to_vtk(tmp_path / "bent.pvd")
    grid = read(collection(tmp_path / "bent_centreline.pvd")[1][-1])
    data, points = point_data(grid), vtk_to_numpy(grid.GetPoints().GetData())
    force = 2.0 * EI
    lever = solution.position(solution.model.beams[0].end)[-1, 0] - points[:, 0]
    # twelve elements of order 3 know the moment to 2e-5 of the largest
    np.testing.assert_allclose(data["bending_moment"], force * lever, atol=2e-5 * force)
    # normal and shear force are the two components of P in the section's frame
    np.testing.assert_allclose(np.hypot(data["normal_force"], data["shear_force"]), force, rtol=1e-4)
    np.testing.assert_allclose(data["normal_force"], force * np.sin(data["rotation"]), atol=1e-4 * force)
    # on the body they are those of its axis: below the middle of a layer as above it
    body = read(collection(tmp_path / "bent.pvd")[1][-1])
    at = np.interp(point_data(body)["rotation"], data["rotation"], force * lever)
    np.testing.assert_allclose(point_data(body)["bending_moment"], at, atol=1e-4 * force)


def test_beams_are_numbered_and_rows_carry_their_time(solution, written):
    grid = read(collection(written)[1][4])
    np.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray("beam")), [0, 0, 0, 1, 1, 1])
    assert grid.GetFieldData().GetArray("time").GetValue(0) == solution.at[4]


def test_time_of_a_path_is_its_row(tmp_path):
    """Its load factor falls between the limit points, and ParaView wants times that rise."""
    path = arch()
    assert np.any(np.diff(path.at) < 0.0)
    path.to_vtk(tmp_path / "arch.pvd")
    times, files = collection(tmp_path / "arch.pvd")
    np.testing.assert_array_equal(times, np.arange(len(path)))
    found = [read(file).GetFieldData().GetArray("load_factor").GetValue(0) for file in files]
    np.testing.assert_array_equal(found, path.at)


def test_modes_can_be_exported(tmp_path):
    model = cantilever().model
    modes = bf.solve_modes(bf.Model(model.beams, model.supports), 2)
    modes.solution(1, frames=5).to_vtk(tmp_path / "mode.pvd")
    assert len(collection(tmp_path / "mode.pvd")[0]) == 5
    beam = model.beams[0]
    column = bf.Model([beam], model.supports, [bf.PointForce(beam.end, (-1.0, 0.0))])
    bf.solve_buckling(column, 1).solution(0).to_vtk(tmp_path / "buckling.pvd")
    np.testing.assert_array_equal(collection(tmp_path / "buckling.pvd")[0], [0.0, 1.0])


def test_steps_of_an_earlier_export_are_removed(solution, tmp_path):
    path = tmp_path / "swing.pvd"
    solution.to_vtk(path)
    other = tmp_path / "swing" / "notes.vtu"
    other.write_text("mine")
    cantilever().to_vtk(path)
    for name in ("swing", "swing_centreline"):
        assert sorted(file.name for file in (tmp_path / name).glob("0*.vtu")) == ["0000.vtu", "0001.vtu"]
    assert other.read_text() == "mine"


def test_sections_without_a_material_have_no_stress(tmp_path):
    """nan in a field would make ParaView's colours useless."""
    section = bf.Section.from_stiffness(1e4, 1e4, 100.0, 1.0, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), section)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))]))
    with pytest.warns(bf.UnknownStressWarning, match="stress of 1 of 1 beams .* is left out"):
        solution.to_vtk(tmp_path / "bent.pvd")
    for name in ("bent", "bent_centreline"):
        data = point_data(read(tmp_path / name / "0001.vtu"))
        assert "green_strain_xx" in data
        assert not [key for key in data if key.startswith("stress")]
        assert all(np.isfinite(values).all() for values in data.values())


MOTION_STATICS_PATH = (lambda: swing(bf.ANCFCRBF(), bf.CRBF(4)), cantilever, arch)


@pytest.mark.parametrize("make", MOTION_STATICS_PATH, ids=["motion", "static", "path"])
def test_vtkhdf_holds_what_the_vtu_files_hold(make, tmp_path, monkeypatch):
    solution = make()
    monkeypatch.setattr(vtk, "VALUES_IN_MEMORY", 200)  # several chunks of rows
    solution.to_vtk(tmp_path / "a.pvd")
    solution.to_vtk(tmp_path / "b.vtkhdf")
    for name in ("", "_centreline", "_boundary"):
        times, files = collection(tmp_path / f"a{name}.pvd")
        reader = vtkHDFReader()
        reader.SetFileName(str(tmp_path / f"b{name}.vtkhdf"))
        reader.UpdateInformation()
        information = reader.GetOutputInformation(0)
        key = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
        np.testing.assert_array_equal([information.Get(key, i) for i in range(information.Length(key))], times)
        for row in {0, len(files) // 2, len(files) - 1}:
            reader.SetStep(row)
            reader.Update()
            found, expected = reader.GetOutput(), read(files[row])
            assert found.GetNumberOfCells() == expected.GetNumberOfCells()
            assert found.GetCellType(0) == expected.GetCellType(0)
            here, there = (common_points(grid, bool(name)) for grid in (found, expected))
            points = [vtk_to_numpy(grid.GetPoints().GetData()) for grid in (found, expected)]
            np.testing.assert_allclose(points[0][here], points[1][there], atol=1e-15)
            data, right = point_data(found), point_data(expected)
            assert set(data) == set(right)
            for field, values in right.items():
                size = np.nanmax(np.abs(values), initial=0.0)
                np.testing.assert_allclose(data[field][here], values[there], atol=1e-13 * size, err_msg=field)
            assert found.GetCellData().GetHigherOrderDegrees() is None
            if not name:  # older readers take a square number of points for a degree
                assert np.sqrt(found.GetCell(0).GetNumberOfPoints()) % 1.0 == 0.0
                assert surface(found) == pytest.approx(surface(expected), rel=1e-6)
            at = "load_factor" if solution.static else "time"
            assert found.GetFieldData().GetArray(at).GetNumberOfTuples() == 1
            assert found.GetFieldData().GetArray(at).GetValue(0) == solution.at[row]
    parts = ("", "_centreline", "_boundary")
    names = [f"a{part}{suffix}" for part in parts for suffix in ("", ".pvd")] + [f"b{part}.vtkhdf" for part in parts]
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted(names)


def common_points(grid, line):
    """Numbers of the points that cells of other heights have too: corners, then the lower edge."""
    cells = [grid.GetCell(number) for number in range(grid.GetNumberOfCells())]
    along = [cell.GetNumberOfPoints() if line else 4 + cell.GetOrder(0) - 1 for cell in cells]
    ids = [[cell.GetPointId(i) for i in range(count)] for cell, count in zip(cells, along, strict=True)]
    return np.concatenate(ids)


def surface(grid):
    """Area of the body as VTK divides it into triangles."""
    skin, triangles, mass = vtkDataSetSurfaceFilter(), vtkTriangleFilter(), vtkMassProperties()
    skin.SetInputData(grid)
    skin.SetNonlinearSubdivisionLevel(3)
    triangles.SetInputConnection(skin.GetOutputPort())
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    return mass.GetSurfaceArea()


def test_vtkhdf_without_h5py_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(bf.BeamfemError, match=r"beamfem\[store\]"):
        cantilever().to_vtk(tmp_path / "bent.vtkhdf")


def test_documented_fields_are_those_that_are_written(solution, written):
    text = (Path(__file__).parents[2] / "docs" / "paraview.md").read_text()
    for path in (written, *(written.with_name(f"swing_{part}.pvd") for part in ("centreline", "boundary"))):
        for name in point_data(read(collection(path)[1][0])):
            assert f"`{name}`" in text or f"`{name.rsplit('_', 1)[0]}_xx`" in text
