"""Frames from mesh files: what files hold, what they may not hold, and structures against references."""

import sys
from pathlib import Path

import numpy as np
import pytest
from mesh_parts import SECTION, THREE, frame, written

import beamfem as bf
from beamfem.io.frame import Frame
from beamfem.io.line_mesh import LineMesh, read_mesh

MESHES = Path(__file__).parents[2] / "meshes"


# What files hold


def test_a_portal_is_beams_joined_at_their_nodes():
    mesh = read_mesh(MESHES / "portal.msh")
    assert isinstance(mesh, LineMesh)
    assert {name: len(cells) for name, cells in mesh.member_sets.items()} == {"columns": 4, "beam": 4}
    assert {name: len(nodes) for name, nodes in mesh.point_sets.items()} == {"feet": 2, "corners": 2, "midspan": 1}
    found = frame(mesh)
    assert isinstance(found, Frame)
    assert (len(found.beams), len(found.joints)) == (8, 7)
    assert all(isinstance(joint, bf.Rigid) for joint in found.joints)
    assert [tuple(point.reference) for point in found.points("feet")] == [(0.0, 0.0), (6.0, 0.0)]
    assert len(found.members("columns")) == 4
    assert tuple(found.at(3.0, 4.0).reference) == (3.0, 4.0)


def test_chains_are_the_members_of_the_drawing():
    found = frame(read_mesh(MESHES / "portal.msh"), elements=2, members="chains")
    assert [beam.curve for beam in found.beams] == [
        bf.Line((0, 0), (0, 4)),
        bf.Line((6, 0), (6, 4)),
        bf.Line((0, 4), (6, 4)),
    ]
    assert [len(beam.elements) - 1 for beam in found.beams] == [4, 4, 8]
    assert len(found.joints) == 2
    (middle,) = found.points("midspan")
    assert middle.fraction == pytest.approx(0.5, abs=1e-15)
    assert found.members("beam") == found.beams[2:]


def test_cells_and_chains_are_the_same_structure():
    mesh = read_mesh(MESHES / "portal.msh")
    tips = []
    for members in ("cells", "chains"):
        found = frame(mesh, elements=2, members=members)
        (top,) = found.points("midspan")
        loads = [bf.PointForce(top, (1e5, -3e5))]
        model = bf.Model(found.beams, [bf.Clamp(foot) for foot in found.points("feet")], loads, found.joints)
        tips.append(bf.solve_static(model).displacement(top)[-1])
    assert np.abs(tips[0] - tips[1]).max() < 1e-10 * np.abs(tips[0]).max()


def test_unknown_names_list_those_that_are_known():
    mesh = read_mesh(MESHES / "portal.msh")
    found = frame(mesh)
    with pytest.raises(bf.InputError, match="no member set 'roof'; known are columns, beam"):
        found.members("roof")
    with pytest.raises(bf.InputError, match="no point set 'columns'; known are feet, corners, midspan"):
        found.points("columns")
    with pytest.raises(bf.InputError, match="no point set 'top'"):
        frame(mesh, hinges="top")
    with pytest.raises(bf.InputError, match="no member set 'roof'"):
        frame(mesh, section={"roof": SECTION})
    with pytest.raises(bf.InputError, match=r"no line ends at \(3, 3\); the nearest end is at \(3, 4\)"):
        found.at(3.0, 3.0)
    with pytest.raises(bf.InputError, match='"cells" or "chains"'):
        frame(mesh, members="beams")


def test_properties_by_set():
    mesh = read_mesh(MESHES / "portal.msh")
    thin = bf.Rectangle(0.05, 0.05)
    found = frame(mesh, {"columns": 1, "beam": 3}, section={"columns": SECTION, "beam": thin})
    assert {beam.section for beam in found.members("beam")} == {thin}
    assert {beam.section for beam in found.members("columns")} == {SECTION}
    assert [beam.elements for beam in found.beams] == [1, 1, 1, 1, 3, 3, 3, 3]
    with pytest.raises(
        bf.InputError, match=r"section: 4 line\(s\) are in none of \['beam'\], such as the one at \(0, 1\)"
    ):
        frame(mesh, section={"beam": thin})
    doubled = LineMesh(mesh.nodes, mesh.cells, {**mesh.member_sets, "all": np.arange(8)}, mesh.point_sets)
    with pytest.raises(bf.InputError, match=r"section: line 0 .* is in 'columns' and in 'all'"):
        frame(doubled, section={"columns": SECTION, "all": thin})
    with pytest.raises(bf.InputError, match="elements must be at least 1"):
        frame(mesh, 0)


@pytest.mark.parametrize("members", ["cells", "chains"])
def test_a_three_hinged_portal(members):
    """Load F on its midspan, hinged there and at the feet: H = F L / (4 h), moment at the corners H h."""
    mesh = read_mesh(MESHES / "portal.msh")
    found = frame(mesh, elements=2, members=members, hinges=["midspan", "feet"])
    (top,) = found.points("midspan")
    assert sum(isinstance(joint, bf.Hinge) for joint in found.joints) == 1
    feet = found.points("feet")
    force = 10.0  # small, so that the linear statics of the reference hold
    model = bf.Model(found.beams, [bf.Pin(foot) for foot in feet], [bf.PointForce(top, (0.0, -force))], found.joints)
    solution = bf.solve_static(model)
    expected = [(force * 6 / 16, force / 2, 0.0), (-force * 6 / 16, force / 2, 0.0)]
    for foot, value in zip(feet, expected, strict=True):
        assert np.abs(solution.reaction(foot)[-1] - value).max() < 1e-5 * force


def test_a_ring_is_one_chain_that_closes(tmp_path):
    """Ring of 4 parabolas a quarter under opposite forces: F R^3 / (E I) (pi / 4 - 2 / pi) across, thin and linear."""
    angle = np.arange(64) * 2.0 * np.pi / 64
    points = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(64)])
    first = 2 * np.arange(32)
    lines = np.column_stack([first, (first + 2) % 64, first + 1])
    lines[::3, :2] = lines[::3, 1::-1]  # cells may run either way
    mesh = written(tmp_path / "ring.vtu", points, [("line3", lines)])
    section = bf.Rectangle(1e-3, 1e-3)
    material = bf.Material(1.0 / section.second_moment, 0.3, 1.0)
    found = mesh.frame(1, bf.CRBF(3), section, material, members="chains")
    assert (len(found.beams), len(found.joints)) == (1, 1)
    top, low = found.at(0.0, 1.0), found.at(0.0, -1.0)
    supports = [bf.Pin(low), bf.Roller(top, (1.0, 0.0))]
    model = bf.Model(found.beams, supports, [bf.PointForce(top, (0.0, 1e-4))], found.joints)
    moved = bf.solve_static(model).displacement(top)[-1, 1]
    assert moved == pytest.approx(1e-4 * (np.pi / 4 - 2 / np.pi), rel=1e-4)


def test_straight_quadratic_lines_are_lines(tmp_path):
    cells = [("line3", [[0, 2, 1]])]
    mesh = written(tmp_path / "straight.vtu", [(0, 0, 0), (1.2, 0, 0), (2, 0, 0)], cells)
    assert frame(mesh).beams[0].curve == bf.Line((0, 0), (2, 0))
    mesh = written(tmp_path / "back.vtu", [(0, 0, 0), (1.6, 0, 0), (2, 0, 0)], cells)
    with pytest.raises(bf.InputError, match=r"turns back: its middle node stands at 0\.8"):
        frame(mesh)


def test_a_point_set_off_the_lines_is_named(tmp_path):
    mesh = written(tmp_path / "off.vtu", THREE, [("line", [[0, 1]])], point_data={"tip": np.array([0, 0, 1, 0])})
    with pytest.raises(bf.InputError, match="point set 'tip' has a point at which no line ends"):
        frame(mesh).points("tip")


# References


@pytest.mark.parametrize("members", ["cells", "chains"])
def test_lees_frame_from_a_file_meets_its_first_limit_load(members):
    material = bf.Material(7.2e6, 0.3, 1.0)
    mesh = read_mesh(MESHES / "lee_frame.msh")
    found = mesh.frame(8, bf.CRBF(4), bf.Section(area=6.0, second_moment=2.0), material, members=members)
    (load,) = found.points("load")
    supports = [bf.Pin(point) for point in found.points("hinges")]
    model = bf.Model(found.beams, supports, [bf.PointForce(load, (0.0, -1.0))], found.joints)
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(load)[1] < -55.0)
    first = path.limit_points[0]
    assert first.load_factor == pytest.approx(18544.52709, rel=1e-7)
    assert first.displacement(load) == pytest.approx([26.8783276616, -48.7542403782], rel=1e-6)


def test_the_deep_arch_from_a_file_meets_its_limit_load():
    """Clamped-hinged arch of 215 degrees, 8.97308996972 E I / R^2; parabolas for the circle leave 1e-6."""
    section = bf.Rectangle(1.0 / 5000.0, 1.0 / 5000.0)
    material = bf.Material(1.0 / section.second_moment, 0.3, 1.0)
    found = read_mesh(MESHES / "arch215.msh").frame(1, bf.CRBF(3), section, material, members="chains")
    assert (len(found.beams), len(found.joints)) == (1, 0)
    (left,), (crown,), (right,) = (found.points(name) for name in ("left", "crown", "right"))
    supports = [bf.Clamp(left), bf.Pin(right)]
    model = bf.Model(found.beams, supports, [bf.PointForce(crown, (0.0, -1.0))], found.joints)
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(crown)[1] < -1.15)
    assert path.limit_points[0].load_factor == pytest.approx(8.97308996972, rel=1.5e-6)


@pytest.mark.slow
def test_the_lattice_of_five_thousand_members_solves():
    mesh = read_mesh(MESHES / "lattice.vtu")
    found = mesh.frame(2, bf.CRBF(1), bf.Rectangle(0.05, 0.05), bf.Material(1e7, 0.3, 1000.0))
    assert len(found.beams) == 5125
    top = found.points("edge=2")
    supports = [bf.Clamp(point) for point in found.points("edge=1")]
    loads = [bf.PointForce(point, (0.0, -1.0)) for point in top]
    model = bf.Model(found.beams, supports, loads, found.joints)
    solution = bf.solve_static(model)
    held = sum(solution.reaction(support.point)[-1] for support in supports)
    assert held[1] == pytest.approx(42.0, rel=1e-8)
    assert abs(held[0]) < 1e-6


def test_the_files_are_what_the_script_makes(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "path", [str(MESHES), *sys.path])
    import make_meshes

    monkeypatch.setattr(make_meshes, "FOLDER", tmp_path)
    make_meshes.main()
    for path in tmp_path.iterdir():
        again, kept = read_mesh(path), read_mesh(MESHES / path.name)
        assert np.array_equal(again.cells, kept.cells)
        assert np.allclose(again.nodes, kept.nodes, rtol=0.0, atol=1e-15)
        assert again.member_sets.keys() == kept.member_sets.keys()
        assert again.point_sets.keys() == kept.point_sets.keys()
        assert (MESHES / path.name).stat().st_size < 300_000
    assert {path.name for path in tmp_path.iterdir()} == {
        path.name for path in MESHES.iterdir() if path.suffix in (".msh", ".vtu")
    }


def test_a_closed_ring_of_lines_is_one_chain():
    """Its edges sum to zero: "a Line needs two different points"."""
    points = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    mesh = bf.LineMesh(points, np.array([(0, 1, -1), (1, 2, -1), (2, 3, -1), (3, 0, -1)]), {}, {})
    frame = mesh.frame(8, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1.0), members="chains")
    assert sum(beam.curve.length for beam in frame.beams) == pytest.approx(4.0, rel=1e-12)
