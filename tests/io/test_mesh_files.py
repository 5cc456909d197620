"""Line meshes in files: every format, sets, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
from mesh_parts import THREE, ends, frame, written

import beamfem as bf
from beamfem.io.line_mesh import read_mesh

MESHES = Path(__file__).parents[2] / "meshes"


# What files hold


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".inp", ".xdmf", ".vtk"])
def test_lines_survive_every_format(tmp_path, suffix):
    if suffix == ".xdmf":
        pytest.importorskip("h5py")
    mesh = written(tmp_path / f"frame{suffix}", THREE, [("line", [[0, 1], [1, 2], [3, 2]])])
    assert ends(mesh) == [[(0, 0), (0, 1)], [(0, 1), (1, 1)], [(1, 0), (1, 1)]]
    assert np.all(mesh.cells[:, 2] == -1)


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".xdmf"])
def test_quadratic_lines_survive_every_format(tmp_path, suffix):
    points = [(0, 0, 0), (1, 0.3, 0), (2, 0, 0), (2.5, 1, 0), (2, 2, 0)]
    mesh = written(tmp_path / f"arch{suffix}", points, [("line3", [[0, 2, 1], [2, 4, 3]])])
    assert ends(mesh) == [[(0, 0), (2, 0)], [(2, 0), (2, 2)]]
    assert mesh.nodes[mesh.cells[:, 2]].tolist() == [[1, 0.3], [2.5, 1]]
    first = frame(mesh).beams[0].curve
    assert first == bf.BSpline(2, (0, 0, 0, 1, 1, 1), ((0, 0), (1, 0.6), (2, 0)))
    # arc length of y = 0.3 (1 - (x - 1)^2)
    assert first.length == pytest.approx(np.hypot(1, 0.6) + np.arcsinh(0.6) / 0.6, rel=1e-14)


def test_quadratic_lines_of_meshio_have_the_wrong_name_in_abaqus(tmp_path):
    path = tmp_path / "arch.inp"
    points = [(0, 0, 0), (1, 0.3, 0), (2, 0, 0)]
    with pytest.raises(bf.InputError, match="line 9: element 1 of type B33H has 2 nodes; a quadratic line is a B32"):
        written(path, points, [("line3", [[0, 2, 1]])])
    path.write_text(path.read_text().replace("B33H", "B32"))
    mesh = read_mesh(path)
    assert mesh.nodes[mesh.cells[0]].tolist() == [[0, 0], [2, 0], [1, 0.3]]


@pytest.mark.parametrize("suffix", [".vtu", ".xdmf", ".vtk"])
def test_whole_numbers_on_cells_and_points_are_sets(tmp_path, suffix):
    if suffix == ".xdmf":
        pytest.importorskip("h5py")
    mesh = written(
        tmp_path / f"numbers{suffix}",
        THREE,
        [("line", [[0, 1], [1, 2], [3, 2]])],
        cell_data={"profile": [np.array([1, 0, 2])], "length": [np.array([1.0, 1.0, 1.0])]},
        point_data={"foot": np.array([1, 0, 0, 1])},
    )
    members = {name: cells.tolist() for name, cells in mesh.member_sets.items()}
    assert members == {"profile": [0, 2], "profile=0": [1], "profile=1": [0], "profile=2": [2]}
    found = frame(mesh)
    assert [tuple(point.reference) for point in found.points("foot")] == [(0, 0), (1, 0)]


def test_gmsh_groups_without_a_name_go_by_number(tmp_path):
    cells = [("line", [[0, 1], [1, 2]]), ("line3", [[2, 3, 4]]), ("vertex", [[3]])]
    tags = [np.array([7, 8]), np.array([7]), np.array([7])]
    points = [*THREE, (1.1, 0.5, 0)]
    mesh = written(
        tmp_path / "groups.msh",
        points,
        cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"top": np.array([8, 1])},
    )
    assert {name: cells.tolist() for name, cells in mesh.member_sets.items()} == {"7": [0, 2], "top": [1]}
    assert mesh.nodes[mesh.point_sets["7"]].tolist() == [[1, 0]]


GMSH_ASCII = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
0 3 "the foot"
1 1 "columns"
$EndPhysicalNames
$Entities
3 2 0 0
1 0 0 0 1 3
2 0 1 0 0
3 1 1 0 0
1 0 0 0 0 1 0 1 1 2 1 -2
2 0 1 0 1 1 0 1 2 2 2 -3
$EndEntities
$Nodes
5 4 1 40
0 1 0 1
10
0 0 0
0 2 0 1
20
0 1 0
0 3 0 1
40
1 1 0
1 1 0 1
30
0 0.5 0
1 2 0 0
$EndNodes
$Elements
3 4 1 4
0 1 15 1
1 10
1 1 1 2
2 10 30
3 30 20
1 2 1 1
4 20 40
$EndElements
"""


def test_a_text_file_of_gmsh_is_read_or_refused_with_advice(tmp_path):
    path = tmp_path / "text.msh"
    path.write_text(GMSH_ASCII)
    mesh = read_mesh(path)
    assert mesh.member_sets["columns"].tolist() == [0, 1]
    assert mesh.member_sets["2"].tolist() == [2]
    assert mesh.nodes[mesh.point_sets["the foot"]].tolist() == [[0, 0]]
    path.write_text(GMSH_ASCII.replace("4 20 40", "4 20"))
    with pytest.raises(bf.InputError, match="ASCII file: save it as a binary one"):
        read_mesh(path)


ABAQUS = """*Heading
** a comment
*Node, nset=ALL
1, 0., 0.
2, 0., 1., 0.
*Element, type=B21
10, 1, 2,
*Node
3, 1., 1.
4, 2., 1.
5, 2.5, 0.4
6, 2., 0.
*Element, type=B21, elset=Beams
11, 2, 3
12, 3, 4
*Element, type=B22,
 elset=Curved
20, 4, 5, 6
*Elset, elset=Frame, generate
10, 12, 2
*Elset, elset=All
Frame, CURVED
11
*Nset, nset=Feet
1,
*Nset, nset=Feet
6
*Nset, nset=Held
feet, 3
*Boundary
Held, 1, 3
"""


def test_an_abaqus_file_keeps_its_sets(tmp_path):
    path = tmp_path / "frame.inp"
    path.write_text(ABAQUS)
    with pytest.warns(bf.NotReadWarning, match=r"frame\.inp: .* left out: \*BOUNDARY\. Give"):
        mesh = read_mesh(path)
    members = {name: cells.tolist() for name, cells in mesh.member_sets.items()}
    assert members == {"Beams": [1, 2], "Curved": [3], "Frame": [0, 2], "All": [0, 1, 2, 3]}
    assert mesh.nodes[mesh.cells[3]].tolist() == [[2, 1], [2, 0], [2.5, 0.4]]
    found = frame(mesh)
    assert [tuple(point.reference) for point in found.points("Held")] == [(0, 0), (1, 1), (2, 0)]
    assert len(found.points("ALL")) == 2


def test_what_an_abaqus_file_holds_besides_lines_is_named(tmp_path):
    others = "*Beam Section, elset=Beams, material=Steel, section=RECT\n0.1, 0.2\n"
    others += "*Material, name=Steel\n*Elastic\n2e11, 0.3\n"
    others += "".join(f"*Material, name=M{number}\n" for number in range(7)) + "*Step\n*Static\n*End Step\n"
    path = tmp_path / "whole.inp"
    path.write_text("*Heading\na frame\n" + ABAQUS + others)
    names = r"\*BOUNDARY, \*BEAM SECTION Beams, \*MATERIAL Steel, \*ELASTIC, \*MATERIAL M0, .* M3 and 5 more\."
    with pytest.warns(bf.NotReadWarning, match=names):
        read_mesh(path)
    path.write_text(ABAQUS.split("*Boundary")[0])
    assert len(read_mesh(path).cells) == 4


@pytest.mark.filterwarnings("ignore::beamfem.NotReadWarning")
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("Feet\n1,", "Feet\nHands", "line 25: there is no nset 'Hands' so far; known: ALL"),
        ("Feet\n1,", "Feet\n99,", "nset Feet lists 99"),
        ("11, 2, 3", "11, 2, 77", "element 11 has nodes that the file does not give"),
        ("11, 2, 3", "11, 2", "element 11 of type B21 needs 2 nodes"),
        ("11, 2, 3", "10, 2, 3", "element 10 is given twice"),
        ("3, 1., 1.\n", "3, 1., one\n", "line 9: this line below .NODE cannot be read"),
        ("3, 1., 1.\n", "3, 1., 1.\n1, 5., 5.\n", "node 1 is given twice at different places"),
        ("*Boundary", "*Ngen\n1, 6", "NGEN cannot be read"),
        ("*Boundary", "*Include, input=none.inp", "none.inp cannot be read"),
        ("type=B21, elset=Beams", "type=CPS4, elset=Beams", "no line or line3: 2 CPS4"),
    ],
)
def test_abaqus_files_are_refused_by_name_and_line(tmp_path, old, new, message):
    path = tmp_path / "bad.inp"
    assert old in ABAQUS
    path.write_text(ABAQUS.replace(old, new))
    with pytest.raises(bf.InputError, match=message):
        read_mesh(path)


def test_abaqus_files_include_others(tmp_path):
    (tmp_path / "nodes.inc").write_text("*NODE\n1, 0, 0\n2, 3, 4\n")
    (tmp_path / "all.inp").write_text("*INCLUDE, INPUT=nodes.inc\n*ELEMENT, TYPE=T2D2, ELSET=bar\n1, 1, 2\n")
    mesh = read_mesh(tmp_path / "all.inp")
    assert frame(mesh).members("bar")[0].curve.length == 5.0
    (tmp_path / "self.inp").write_text("*INCLUDE, INPUT=self.inp\n")
    with pytest.raises(bf.InputError, match="include each other"):
        read_mesh(tmp_path / "self.inp")


# What files may not hold


@pytest.mark.parametrize(
    ("points", "cells", "message"),
    [
        (THREE, [("line", [[0, 1]]), ("triangle", [[0, 1, 2], [0, 2, 3]])], "no line or line3: 2 triangle"),
        (THREE, [("triangle", [[0, 1, 2]])], "no line or line3: 1 triangle"),
        (THREE, [("vertex", [[0]])], "there are no lines in it"),
        ([*THREE[:3], (1, 0, 0.2)], [("line", [[0, 1], [2, 3]])], r"1 node\(s\) do not, such as \(1, 0, 0.2\)"),
        (THREE, [("line", [[0, 1], [2, 2]])], r"line 1 .* has no length, both ends are at \(1, 1\)"),
        (THREE, [("line", [[0, 1], [1, 2], [1, 0]])], r"lines 0 and 2 .* same line from \(0, 0\) to \(0, 1\)"),
        ([*THREE, (1, 1, 0)], [("line", [[0, 1], [1, 2], [4, 3]])], r"two nodes are at \(1, 1\)"),
        ([*THREE, (0, 0, 0)], [("line", [[0, 1], [0, 4]])], "line 1 .* has no length"),
        (
            [(0, 0, 0), (2, 0, 0), (1, 0.1, 0), (1, 1, 0)],
            [("line3", [[0, 1, 2]]), ("line", [[2, 3]])],
            "split the line3",
        ),
        ([(0, 0, 0), (np.nan, 0, 0)], [("line", [[0, 1]])], "not finite"),
    ],
)
@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
def test_meshes_that_are_no_frames_are_refused(tmp_path, suffix, points, cells, message):
    with pytest.raises(bf.InputError, match=message) as caught:
        written(tmp_path / f"bad{suffix}", points, cells)
    assert f"bad{suffix}" in str(caught.value)


def test_two_arcs_between_the_same_nodes_are_no_duplicates(tmp_path):
    points = [(0, 0, 0), (2, 0, 0), (1, 0.5, 0), (1, -0.5, 0)]
    mesh = written(tmp_path / "lens.vtu", points, [("line3", [[0, 1, 2], [0, 1, 3]]), ("line", [[0, 1]])])
    assert len(frame(mesh).joints) == 4
    with pytest.raises(bf.InputError, match="same line"):
        written(tmp_path / "twice.vtu", points, [("line3", [[0, 1, 2], [1, 0, 2]])])


def test_files_that_cannot_be_read_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"there is no file .*none.msh"):
        read_mesh(tmp_path / "none.msh")
    for name, message in (
        ("bad.msh", "as gmsh"),
        ("bad.vtu", "as vtu"),
        ("bad.txt", "mesh files end in"),
        ("bad.inp", "no l"),
    ):
        (tmp_path / name).write_text("nothing of use\n")
        with pytest.raises(bf.InputError, match=message):
            read_mesh(tmp_path / name)


def test_reading_prints_nothing(tmp_path, capfd):
    read_mesh(MESHES / "portal.msh")
    (tmp_path / "bad.msh").write_text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n")
    with pytest.raises(bf.InputError):
        read_mesh(tmp_path / "bad.msh")
    assert capfd.readouterr() == ("", "")
