"""Bad files of meshes, results, drawings and models get an error that names them, on the command line no traceback."""

import time

import h5py
import pytest
from bad_inputs import CANTILEVER, require_named
from typer.testing import CliRunner

import beamfem as bf
from beamfem.cli.app import app

BAD, FILE = bf.InputError, bf.FileError
NODES = "*NODE\n1, 0, 0\n2, 1, 0\n"

# the name of a file, what is in it, the kind of the error and its words
FILES = {
    "no result": ("none.h5", None, FILE, "there is no file"),
    "no mesh": ("none.msh", None, FILE, "there is no file"),
    "no drawing": ("none.dxf", None, FILE, "there is no file"),
    "a folder for a result": ("folder", None, FILE, "cannot be read: it is a folder"),
    "an empty result": ("x.h5", b"", BAD, "no HDF5 file"),
    "text for a result": ("x.h5", b"hello", BAD, "no HDF5 file"),
    "a result of its first bytes": ("x.h5", b"\x89HDF\r\n\x1a\n", BAD, "truncated"),
    "an empty mesh": ("x.msh", b"", BAD, "cannot be read as gmsh"),
    "noise for a mesh": ("x.msh", b"\x00\xff" * 50, BAD, "cannot be read as gmsh"),
    "an ASCII mesh": ("x.msh", b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", BAD, "cannot be read"),
    "noise for a grid": ("x.vtu", b"\x00\xff" * 50, BAD, "cannot be read as vtu"),
    "a mesh of an unknown kind": ("x.mesh99", b"", BAD, "mesh files end in"),
    "a mesh without a cell": ("x.obj", b"", BAD, "no lines"),
    "an Abaqus file of 1e300": ("x.inp", b"*NODE\n1, 0, 0\n2, 1e300, 0\n*ELEMENT, TYPE=B21\n1, 1, 2\n", BAD, "apart"),
    "an include without end": ("x.inp", b"*INCLUDE, INPUT=/dev/zero\n", BAD, "a device"),
    "a drawing of its first line": ("x.dxf", b"  0\n", BAD, "DXF"),
    "an empty Abaqus file": ("x.inp", b"", BAD, "no lines"),
    "an element of no node": ("x.inp", f"{NODES}*ELEMENT, TYPE=B21\n1, 1, 9\n".encode(), BAD, "does not give"),
    "an element of no type": ("x.inp", f"{NODES}*ELEMENT\n1, 1, 2\n".encode(), BAD, "line 4"),
    "a node of text": ("x.inp", b"*NODE\n1, a, 0\n", BAD, "line 2"),
    "a set of an unknown set": ("x.inp", f"{NODES}*NSET, NSET=a\ntop\n".encode(), BAD, "no nset 'top'"),
    "an include of nothing": ("x.inp", b"*INCLUDE, INPUT=none.inp\n", BAD, "cannot be read"),
    "an empty drawing": ("x.dxf", b"", BAD, "DXF"),
    "noise for a drawing": ("x.dxf", b"\x00\xff" * 50, BAD, "DXF"),
}


def read(path):
    reader = {".h5": bf.load, ".dxf": bf.read_dxf, "": bf.load}.get(path.suffix, bf.read_mesh)
    return reader(path)


@pytest.mark.parametrize("case", FILES)
def test_bad_files_are_named(case, tmp_path):
    name, content, kind, words = FILES[case]
    (tmp_path / "folder").mkdir()
    if content is not None:
        (tmp_path / name).write_bytes(content)
    require_named(lambda: read(tmp_path / name), kind, words)


@pytest.mark.parametrize("reader", [bf.load, bf.read_mesh, bf.read_dxf])
@pytest.mark.parametrize("path", [None, 5, 1.5, True, b"x.h5", "", "a\0b", ["x.h5"], bf.Beam])
def test_what_is_no_path_is_named(reader, path):
    require_named(lambda: reader(path), BAD, "a path is a text such as")


def test_a_layer_is_a_text(tmp_path):
    (tmp_path / "x.dxf").write_text("")
    require_named(lambda: bf.read_dxf(tmp_path / "x.dxf", layer=3), BAD, "layer must be a text")


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("results") / "good.h5"
    bf.solve_static(CANTILEVER).save(path)
    return path.read_bytes()


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.99])
def test_a_truncated_result_is_named(saved, share, tmp_path):
    path = tmp_path / "cut.h5"
    path.write_bytes(saved[: int(share * len(saved))])
    require_named(lambda: bf.load(path), BAD, "cannot be loaded")


CHANGES = {
    "foreign": ("format", "another program", "not one that beamfem saved"),
    "newer": ("format_version", 99, "a newer beamfem can load it"),
    "without rows": ("rows", 0, "before the first rows"),
}


@pytest.mark.parametrize("case", CHANGES)
def test_a_result_of_another_kind_is_named(saved, case, tmp_path):
    attribute, value, words = CHANGES[case]
    path = tmp_path / "changed.h5"
    path.write_bytes(saved)
    with h5py.File(path, "r+") as file:
        file.attrs[attribute] = value
    require_named(lambda: bf.load(path), BAD, words)


def test_a_file_that_may_not_be_read_is_named(tmp_path, monkeypatch):
    def refuse(self, *arguments, **options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.open", refuse)
    for reader, name in ((bf.load, "x.h5"), (bf.read_mesh, "x.msh"), (bf.read_dxf, "x.dxf")):
        require_named(lambda reader=reader, name=name: reader(tmp_path / name), FILE, "Permission denied")


@pytest.mark.parametrize("command", ["info", "export", "plot"])
@pytest.mark.parametrize("case", [name for name, (file, *_) in FILES.items() if not file.endswith((".msh", ".dxf"))])
def test_the_command_line_shows_no_traceback(command, case, tmp_path):
    name, content, _, _ = FILES[case]
    (tmp_path / "folder").mkdir()
    if content is not None:
        (tmp_path / name).write_bytes(content)
    target = {"info": [], "export": [str(tmp_path / "x.pvd")], "plot": [str(tmp_path / "x.png")]}[command]
    result = CliRunner().invoke(app, [command, str(tmp_path / name), *target])
    assert result.exit_code == 2
    assert isinstance(result.exception, SystemExit)
    assert "Traceback" not in result.output
    assert "error: " in result.output


COMMANDS = {
    "run of a folder": ["run", "."],
    "run of nothing": ["run", "none.toml"],
    "run of nothing as JSON": ["run", "none.toml", "--json"],
    "a study that is none": ["study", "--folder", "none", "x"],
    "an unknown command": ["rum"],
    "an unknown option": ["run", "none.toml", "--outt", "x"],
    "no file": ["info"],
}


@pytest.mark.parametrize("case", COMMANDS)
def test_a_wrong_command_shows_no_traceback(case):
    result = CliRunner().invoke(app, COMMANDS[case])
    assert result.exit_code == 2
    assert isinstance(result.exception, SystemExit)
    assert "Traceback" not in result.output


@pytest.mark.parametrize("reader", [bf.load, bf.read_mesh, bf.read_dxf])
def test_a_device_is_read_by_nothing(reader):
    """Its bytes have no end, and would fill the memory."""
    require_named(lambda: reader("/dev/zero"), FILE, "a device")
    done = CliRunner().invoke(app, ["run", "/dev/zero"])
    assert (done.exit_code, "this is a device" in done.stderr) == (2, True)


def test_a_mesh_whose_lines_name_nodes_that_are_not_there_is_named(tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "x.vtk"
    meshio.Mesh([[0, 0, 0], [1, 0, 0]], [("line", [[0, 7]])]).write(path, binary=False)
    require_named(lambda: bf.read_mesh(path), BAD, "it is damaged: nodes of its lines must be between -1 and 1, got 7")


def test_a_number_of_thousands_of_digits_in_a_model_file_is_named(tmp_path):
    (tmp_path / "x.toml").write_text(f"[analysis]\nsteps = {'9' * 5000}\n")
    done = CliRunner().invoke(app, ["run", str(tmp_path / "x.toml")])
    assert (done.exit_code, "a number cannot be read" in done.stderr) == (2, True)


@pytest.mark.slow
def test_a_model_file_with_a_long_table_is_read_in_time(tmp_path):
    """Each item was looked for from the first line: a million took minutes, and this a minute."""
    (tmp_path / "x.toml").write_text("x = [\n" + "1,\n" * 200_000 + "]\n")
    begun = time.perf_counter()
    done = CliRunner().invoke(app, ["run", str(tmp_path / "x.toml")])
    assert (done.exit_code, "unknown key" in done.stderr) == (2, True)
    assert time.perf_counter() - begun < 15.0


def test_suffixes_in_capitals_are_written(tmp_path, saved):
    (tmp_path / "good.h5").write_bytes(saved)
    for name in ("a.PVD", "a.VTKHDF"):
        done = CliRunner().invoke(app, ["export", str(tmp_path / "good.h5"), str(tmp_path / name)])
        assert done.exit_code == 0, done.stderr
        assert (tmp_path / name).exists()


def test_a_name_as_long_as_systems_allow_is_written(tmp_path):
    path = tmp_path / ("n" * 252 + ".h5")
    bf.solve_static(CANTILEVER).save(path)
    assert len(bf.load(path)) == 2
