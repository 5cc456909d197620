"""Supports, loads and connectors in ParaView files: what acts there balances, and is where it acts."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from test_vtk import collection, point_data, read
from vtkmodules.util.numpy_support import vtk_to_numpy

import beamfem as bf
from beamfem.element.fields import Axis
from beamfem.mesh.reference import length_points
from beamfem.results.beam_stress import second_piola_kirchhoff
from tests.connectors import SpringDamper
from tests.own_parts import Bracket, Guide, HalfWave, Traction

MATERIAL = bf.Material(2e7, 0.3, 1000.0)
SECTION = bf.Rectangle(0.05, 0.05)


def bracket(element=None):
    """An angle of two beams under every kind of load and support, far from its reference."""
    lower = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element or bf.CRBF(3), SECTION, MATERIAL)
    upper = bf.Beam(bf.Line((1, 0), (1, 1)), 4, element or bf.CRBF(2), SECTION, MATERIAL)
    supports = [
        bf.Clamp(lower.start),
        bf.Spring(upper.end, (100.0, 20.0), 3.0),
        bf.Foundation(lower, (10.0, 500.0)),
    ]
    loads = [
        bf.PointForce(upper.end, (30.0, 0.0), follower=True),
        bf.PointMoment(upper.at(0.5), 3.0),
        bf.Gravity((0.0, -9.81)),
        bf.Pressure(upper, 40.0),
        bf.DistributedLoad(lower, lambda s: (0.0, -20.0 * s)),
    ]
    return bf.Model([lower, upper], supports, loads, [bf.Rigid(lower.end, upper.start)])


def boundary(solution, folder, row=-1, **options):
    solution.to_vtk(folder / "a.pvd", **options)
    grid = read(collection(folder / "a_boundary.pvd")[1][row])
    texts = {}
    for name in ("kinds", "roles"):
        array = grid.GetFieldData().GetAbstractArray(name)
        texts[name] = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    kind = vtk_to_numpy(grid.GetCellData().GetArray("kind"))
    return vtk_to_numpy(grid.GetPoints().GetData()), point_data(grid), np.array(texts["kinds"])[kind], grid


def first_moment(solution, beam):
    """Integral of x over the reference length of a beam of 1 m [m^2]."""
    x, weight = leggauss(6)
    place = np.linspace(0.0, 1.0, beam.elements + 1)[:-1, None] + 0.5 * (1.0 + x) / beam.elements
    found = [[solution.position(beam.at(s))[-1, 0] for s in part] for part in place.tolist()]
    return (np.array(found) @ weight).sum() * 0.5 / beam.elements


@pytest.mark.parametrize("element", [None, bf.ANCF(), bf.ShearRigid(), bf.BilinearCRBF()], ids=str)
def test_forces_and_moments_balance(element, tmp_path):
    model = bracket(element)
    solution = bf.solve_static(model)
    at, data, kind, _ = boundary(solution, tmp_path)
    assert abs(solution.displacement(model.beams[1].end)[-1]).max() > 0.05
    weights = {  # of the vertices along beams [m]
        name: length_points(model.meshes[number])[2]
        for name, number in (("Foundation", 0), ("Pressure", 1), ("DistributedLoad", 0))
    }
    forces = data["force"].copy()
    for name, weight in weights.items():
        forces[kind == name] += weight[:, None] * data["line_force"][kind == name]
    moments = data["moment"] + at[:, 0] * forces[:, 1] - at[:, 1] * forces[:, 0]
    mass = MATERIAL.density * SECTION.area
    weight = 9.81 * mass * 2.0  # of both beams of 1 m
    first = sum(first_moment(solution, beam) for beam in model.beams)
    largest = np.abs(forces).max()
    assert forces.sum(axis=0)[:2] == pytest.approx([0.0, weight], abs=1e-6 * largest)
    assert moments.sum() == pytest.approx(9.81 * mass * first, abs=1e-6 * largest)
    assert set(data["acceleration"][kind == "Gravity", 1]) == {-9.81}


def test_vertices_are_where_the_beam_is(tmp_path):
    model = bracket()
    solution = bf.solve_static(model)
    at, data, kind, grid = boundary(solution, tmp_path)
    assert {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())} == {1}
    upper = model.beams[1]
    (force,) = np.flatnonzero(kind == "PointForce")
    assert at[force, :2] == pytest.approx(solution.position(upper.end)[-1])
    turn = solution.rotation(upper.end)[-1]
    assert data["force"][force, :2] == pytest.approx([30.0 * np.cos(turn), 30.0 * np.sin(turn)])
    (clamp,) = np.flatnonzero(kind == "Clamp")
    assert data["prescribed"][clamp].tolist() == [1.0, 1.0, 1.0]
    assert data["moment"][clamp] == pytest.approx(solution.reaction(model.beams[0].start)[-1, 2])
    (spring,) = np.flatnonzero(kind == "Spring")
    assert data["stiffness"][spring].tolist() == [100.0, 20.0, 3.0]
    still, moved, *_ = boundary(solution, tmp_path / "still", geometry="reference")
    assert still + moved["displacement"] == pytest.approx(at)


def test_supports_at_one_point_are_one_vertex(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SECTION, MATERIAL)
    near = beam.at(0.1 + 0.2), beam.at(0.3)  # one node, two fractions
    supports = [bf.Clamp(beam.start), bf.Roller(beam.end, (0.6, 0.8)), bf.Spring(beam.end, (0.0, 50.0))]
    supports += [bf.Spring(point, (10.0, 10.0)) for point in near]
    model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), (0.0, -20.0))])
    solution = bf.solve_static(model)
    _, data, kind, _ = boundary(solution, tmp_path)
    assert kind.tolist() == ["Clamp", "Roller + Spring", "Spring", "PointForce"]
    assert data["prescribed"][1] == pytest.approx([0.6, 0.8, 0.0])
    assert data["force"].sum(axis=0) == pytest.approx(0.0, abs=1e-9)


def test_parts_of_ones_own_are_written_too(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SECTION, MATERIAL)
    loads = [Traction(beam, 5.0), HalfWave(beam, 3.0), Bracket(beam.end, 2.0, 0.1)]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), Guide(beam.end, 400.0)], loads))
    _, data, kind, _ = boundary(solution, tmp_path)
    assert list(dict.fromkeys(kind)) == ["Clamp", "Guide", "Traction", "HalfWave", "Bracket"]
    assert data["moment"][kind == "Bracket"] == pytest.approx(-0.2)
    along = data["line_force"][kind == "Traction"]
    assert np.linalg.norm(along, axis=1) == pytest.approx(5.0, rel=1e-3)


def test_models_that_nothing_acts_on_have_no_such_file(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, MATERIAL)
    solution = bf.simulate(bf.Model([beam]), 0.01, 0.005, velocity=bf.RigidVelocity(angular=1.0))
    solution.to_vtk(tmp_path / "free.pvd")
    assert sorted(file.name for file in tmp_path.glob("*.pvd")) == ["free.pvd", "free_centreline.pvd"]


def test_fields_are_chosen_among_those_of_all_files(tmp_path):
    solution = bf.solve_static(bracket())
    _, data, *_ = boundary(solution, tmp_path, fields=["line_force", "bending_moment"], single=True)
    assert set(data) == {"line_force"}
    assert data["line_force"].dtype == np.float32
    with pytest.raises(bf.InputError, match="did you mean acceleration"):
        solution.to_vtk(tmp_path / "b.pvd", fields=["aceleration"])


def test_legends_are_attributes_in_vtkhdf(tmp_path):
    h5py = pytest.importorskip("h5py")
    bf.solve_static(bracket()).to_vtk(tmp_path / "a.vtkhdf")
    with h5py.File(tmp_path / "a_boundary.vtkhdf") as file:
        data = file["VTKHDF/CellData"]
        kinds = data["kind"].attrs["kinds"][np.unique(data["kind"])]
        assert list(kinds[:2]) == ["Clamp", "Spring"]
        assert list(data["role"].attrs["roles"]) == ["support", "load", "connector"]
    with h5py.File(tmp_path / "a.vtkhdf") as file:
        assert list(file["VTKHDF/CellData/material"].attrs["materials"]) == [
            "E = 2e+07 Pa, nu = 0.3, density 1000 kg/m^3"
        ]


def test_meshio_and_read_mesh_read_centrelines(tmp_path):
    meshio = pytest.importorskip("meshio")
    model = bracket()
    solution = bf.solve_static(model)
    solution.to_vtk(tmp_path / "a.pvd")
    file = tmp_path / "a_centreline" / f"{len(solution) - 1:04d}.vtu"
    read_by_meshio = meshio.read(file)
    assert {block.type: len(block.data) for block in read_by_meshio.cells} == {"line": 2 * 4 * 12}
    with pytest.raises(bf.InputError, match="merge"):
        bf.read_mesh(file)
    mesh = bf.read_mesh(file, merge=True)
    assert mesh.nodes.shape == (2 * 4 * 12 + 1, 2)
    assert set(mesh.member_sets) == {"beam=0", "beam=1", "material=0", "section=0"}
    frame = mesh.frame(1, bf.CRBF(1), SECTION, MATERIAL, members="chains")
    assert len(frame.beams) == 2
    assert len(frame.joints) == 1
    ends = np.array([beam.curve.position(np.array([beam.curve.length]))[0] for beam in frame.beams])
    assert ends == pytest.approx(np.array([solution.position(beam.end)[-1] for beam in model.beams]))


def test_the_second_piola_kirchhoff_stress_is_that_of_the_deformation_gradient():
    """For random fields of a body, det(F) F^-1 sigma F^-T by matrices."""
    rng = np.random.default_rng(1)
    height = rng.normal(size=(5, 3))
    now, reference = Axis(*rng.normal(size=(5, 4, 5, 2))), Axis(*rng.normal(size=(5, 5, 2)))
    cauchy = rng.normal(size=(4, 5, 3, 6)) * [1, 1, 0, 1, 0, 0]
    found = second_piola_kirchhoff(cauchy, now, reference, height)
    for step, point, level in np.ndindex(4, 5, 3):
        y = height[point, level]
        g = np.column_stack([now.r_s[step, point] + y * now.d_s[step, point], now.d[step, point]])
        j = np.column_stack([reference.r_s[point] + y * reference.d_s[point], reference.d[point]])
        xx, yy, _, xy, _, _ = cauchy[step, point, level]
        f = g @ np.linalg.inv(j)
        expected = np.linalg.det(f) * np.linalg.inv(f) @ [[xx, xy], [xy, yy]] @ np.linalg.inv(f).T
        size = np.abs(expected).max()
        assert found[step, point, level, [0, 3, 1]] == pytest.approx(expected[[0, 0, 1], [0, 1, 1]], abs=1e-9 * size)


def test_the_second_piola_kirchhoff_stress_does_not_rotate_with_the_body(tmp_path):
    """A bar that hangs askew from one end: sigma along its direction, S along its reference, smaller by the stretch."""
    pull, turn, area = 60.0, 0.6, SECTION.area
    soft = bf.Material(1e5, 0.0, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.BilinearCRBF(), SECTION, soft)
    force = bf.PointForce(beam.end, (pull * np.cos(turn), pull * np.sin(turn)))
    ends = [bf.Pin(beam.start), bf.Prescribed(beam.end, rotation=turn)]
    solution = bf.solve_static(bf.Model([beam], ends, [force]))
    solution.to_vtk(tmp_path / "bar.pvd", fields=["cauchy_stress", "second_piola_kirchhoff_stress"])
    data = point_data(read(collection(tmp_path / "bar.pvd")[1][-1]))
    stretch = np.linalg.norm(solution.position(beam.end)[-1])
    assert stretch > 1.1
    along = pull / area
    expected = [along * np.cos(turn) ** 2, along * np.sin(turn) ** 2, 0, along * np.sin(turn) * np.cos(turn), 0, 0]
    assert data["cauchy_stress"] == pytest.approx(np.tile(expected, (len(data["cauchy_stress"]), 1)), abs=1e-6 * along)
    reference = np.tile([along / stretch, 0, 0, 0, 0, 0], (len(data["cauchy_stress"]), 1))
    assert data["second_piola_kirchhoff_stress"] == pytest.approx(reference, abs=1e-6 * along)


def test_connectors_are_vertices_with_their_forces(tmp_path):
    lower, upper = (bf.Beam(bf.Line((0, y), (1, y)), 4, bf.CRBF(3), SECTION, MATERIAL) for y in (0.0, 0.5))
    spring = SpringDamper(lower.end, upper.end, stiffness=200.0)
    clamps = [bf.Clamp(lower.start), bf.Clamp(upper.start)]
    solution = bf.solve_static(bf.Model([lower, upper], clamps, [bf.PointForce(upper.end, (0.0, 9.0))], (), [spring]))
    _, data, kind, _ = boundary(solution, tmp_path)
    own = data["force"][kind == "SpringDamper"]
    assert own == pytest.approx(np.pad(solution.connector_force(spring)[-1][:, :2], ((0, 0), (0, 1))))
    assert abs(own).max() > 1.0
    assert own.sum(axis=0) == pytest.approx(0.0, abs=1e-9)
