"""What ParaView files hold where one chooses: geometry, fields, size of numbers; ids and what they stand for."""

import numpy as np
import pytest
from drawn import cantilever
from test_vtk import collection, point_data, read, swing
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

import beamfem as bf


@pytest.fixture(scope="module")
def solution():
    return swing(bf.CRBF(3), duration=0.06)


def of_hdf(path, step):
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.SetStep(step)
    reader.Update()
    return reader.GetOutput()


def exported(solution, folder, ending, row, **options):
    """Body and centreline of a row."""
    solution.to_vtk(folder / f"a.{ending}", **options)
    for name in ("a", "a_centreline"):
        file = folder / f"{name}.{ending}"
        yield read(collection(file)[1][row]) if ending == "pvd" else of_hdf(file, row)


def positions(grid):
    return vtk_to_numpy(grid.GetPoints().GetData())


@pytest.mark.parametrize("ending", ["pvd", "vtkhdf"])
def test_the_reference_warped_by_the_displacement_is_the_deformed_body(solution, tmp_path, ending):
    now = list(exported(solution, tmp_path / "now", ending, -1 % len(solution)))
    still = list(exported(solution, tmp_path / "still", ending, -1 % len(solution), geometry="reference"))
    for deformed, reference in zip(now, still, strict=True):
        moved = point_data(reference)["displacement"]
        assert np.abs(moved).max() > 0.01
        np.testing.assert_allclose(positions(reference) + moved, positions(deformed), atol=1e-15)
    corners = positions(still[0])
    assert corners.min(axis=0)[:2] == pytest.approx([-0.008, -0.006])  # a line from (0, 0) to (0.6, 0.8), 0.02 high
    assert corners.max(axis=0)[:2] == pytest.approx([0.608, 0.806])


@pytest.mark.parametrize("ending", ["pvd", "vtkhdf"])
def test_only_the_fields_that_are_named_are_written(solution, tmp_path, ending):
    for grid in exported(solution, tmp_path, ending, 1, fields=["bending_moment", "displacement"]):
        assert set(point_data(grid)) == {"bending_moment", "displacement"}
    for grid in exported(solution, tmp_path, ending, 1, fields=[]):
        assert not point_data(grid)
        assert grid.GetNumberOfCells() > 0


@pytest.mark.parametrize("ending", ["pvd", "vtkhdf"])
def test_single_numbers_are_the_same_to_seven_digits(solution, tmp_path, ending):
    whole = list(exported(solution, tmp_path / "whole", ending, 2))
    single = list(exported(solution, tmp_path / "single", ending, 2, single=True))
    for expected, found in zip(whole, single, strict=True):
        assert positions(found).dtype == np.float32
        np.testing.assert_allclose(positions(found), positions(expected), atol=1e-7)
        for name, values in point_data(expected).items():
            assert point_data(found)[name].dtype == np.float32
            size = np.abs(values).max()
            np.testing.assert_allclose(point_data(found)[name], values, atol=1e-6 * size, err_msg=name)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"geometry": "undeformed"}, "geometry must be"),
        ({"fields": ["bending_momnet"]}, "did you mean bending_moment"),
        ({"fields": "displacement"}, "fields"),
        ({"single": 4}, "single must be"),
    ],
)
def test_a_choice_that_there_is_not_is_named_and_nothing_written(solution, tmp_path, options, words):
    with pytest.raises(bf.InputError, match=words):
        solution.to_vtk(tmp_path / "a.pvd", **options)
    assert not list(tmp_path.iterdir())


def test_nothing_that_is_zero_by_definition_is_written(solution, tmp_path):
    static, motion = (next(exported(each, tmp_path, "pvd", 1)) for each in (cantilever(), solution))
    assert "velocity" not in point_data(static)
    assert "velocity" in point_data(motion)


def test_materials_and_sections_have_numbers_and_a_legend(tmp_path):
    steel, rubber = bf.Material(2e11, 0.3, 7800.0), bf.Material(1e7, 0.3, 1200.0)
    flat = bf.Rectangle(0.01, 0.01)
    sandwich = bf.Layered([bf.Layer(steel, 0.002), bf.Layer(rubber, 0.006), bf.Layer(steel, 0.002)], width=0.01)
    parts = [(flat, steel), (sandwich, None), (bf.Rectangle(0.01, 0.01), rubber), (lambda arc: flat, steel)]
    beams = [
        bf.Beam(bf.Line((0, y), (1, y)), 1, bf.CRBF(2), section, material)
        for y, (section, material) in enumerate(parts)
    ]
    solution = bf.solve_static(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams]))
    body, line = exported(solution, tmp_path, "pvd", 0)

    def cells(grid, name):
        return vtk_to_numpy(grid.GetCellData().GetArray(name)).tolist()

    def legend(grid, name):
        array = grid.GetFieldData().GetAbstractArray(name)
        return [array.GetValue(i) for i in range(array.GetNumberOfValues())]

    assert cells(body, "beam") == [0, 1, 1, 1, 2, 3]
    assert cells(body, "material") == [0, 0, 1, 0, 1, 0]
    assert cells(body, "section") == [0, 1, 1, 1, 0, 2]
    of_steel, of_rubber = "E = 2e+11 Pa, nu = 0.3, density 7800 kg/m^3", "E = 1e+07 Pa, nu = 0.3, density 1200 kg/m^3"
    layers = "layers of 0.002, 0.006, 0.002 m from below, 0.01 m wide"
    assert legend(body, "materials") == [of_steel, of_rubber, "of the section"]
    assert legend(body, "sections") == ["rectangle 0.01 x 0.01 m", layers, "varies along the beam"]
    assert body.GetFieldData().GetAbstractArray("beams") is None  # none has a name
    assert [set(cells(line, "material")[12 * i : 12 * (i + 1)]) for i in range(4)] == [{0}, {2}, {1}, {0}]
    assert line.GetFieldData().GetAbstractArray("materials") is None  # meshio could not read the file


@pytest.mark.parametrize("suffix", ["pvd", "vtkhdf"])
@pytest.mark.parametrize("moving", [False, True])
def test_no_field_of_a_body_is_lost_as_it_is_tessellated(tmp_path, capfd, suffix, moving):
    """Of 25 numbers at a point (28 in a motion) VTK keeps 18: it prints errors and drops what comes last."""
    pyvista = pytest.importorskip("pyvista")
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.05), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1e3))])
    solution = bf.simulate(model, duration=1e-3, step=5e-4) if moving else bf.solve_static(model)
    solution.to_vtk(tmp_path / f"body.{suffix}")
    body = pyvista.read(tmp_path / ("body/0001.vtu" if suffix == "pvd" else "body.vtkhdf"))
    assert sum(np.size(body[name]) // body.n_points for name in body.point_data) <= 18
    drawn = body.tessellate()
    assert set(drawn.point_data) == set(body.point_data)
    assert "bending_moment" in drawn.point_data
    assert "Could not pass field" not in capfd.readouterr().err
    solution.to_vtk(tmp_path / f"tensors.{suffix}", fields=["cauchy_stress", "second_piola_kirchhoff_stress"])
    tensors = pyvista.read(tmp_path / ("tensors/0001.vtu" if suffix == "pvd" else "tensors.vtkhdf"))
    assert sorted(tensors.point_data) == ["cauchy_stress", "second_piola_kirchhoff_stress"]
