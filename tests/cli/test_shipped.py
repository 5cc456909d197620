"""Studies and examples come with the package: found from anywhere, copied, and in the wheel."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path
from zipfile import ZipFile

import pytest
from typer.testing import CliRunner

from beamfem.cli import bundled_examples as examples
from beamfem.cli.app import app

ROOT = Path(__file__).parents[2]


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_studies_are_found_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "paper/rollup" in invoke("study").stdout
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies" / "own.py").write_text("def main():\n    return 1\n")
    assert [item["name"] for item in json.loads(invoke("study", "--json").stdout)] == ["own"]


def test_examples_are_listed_and_copied_once(tmp_path, monkeypatch):
    listed = invoke("examples").stdout.splitlines()
    names = sorted(path.name for path in (ROOT / "examples").glob("*.*") if path.suffix in (".py", ".toml"))
    assert [line.split()[0] for line in listed] == names
    assert "cantilever.py      A cantilever under a tip force that bends it by most of its length." in listed
    assert f"python {tmp_path / 'a' / 'examples' / 'cantilever.py'}" in invoke("examples", tmp_path / "a").stdout
    assert (tmp_path / "a" / "examples" / "own_mesh.py").is_file()
    assert (tmp_path / "a" / "meshes" / "portal.msh").is_file()
    again = invoke("examples", tmp_path / "a")
    assert again.exit_code == 2
    assert "is there already" in again.stderr
    monkeypatch.setattr(examples, "_PACKAGE", tmp_path / "none" / "beamfem")
    assert "came without its examples" in invoke("examples").stderr


def test_folders_in_the_package_come_before_those_beside_it(tmp_path, monkeypatch):
    monkeypatch.setattr(examples, "_PACKAGE", tmp_path / "beamfem")
    assert examples.shipped("studies") is None
    (tmp_path / "studies").mkdir()
    assert examples.shipped("studies") == tmp_path / "studies"
    inside = tmp_path / "beamfem" / "shipped" / "studies"
    inside.mkdir(parents=True)
    assert examples.shipped("studies") == inside


def test_the_wheel_is_told_to_hold_them():
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel["force-include"] == {name: f"beamfem/shipped/{name}" for name in ("examples", "meshes", "studies")}


@pytest.mark.slow
def test_the_wheel_holds_them(tmp_path):
    """Needs the network, for what builds wheels."""
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--quiet", "--wheel-dir", str(tmp_path), str(ROOT)]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    if "No matching distribution" in built.stderr:
        pytest.skip("hatchling cannot be fetched here")
    assert built.returncode == 0, built.stderr
    (wheel,) = tmp_path.glob("*.whl")
    names = set(ZipFile(wheel).namelist())
    for folder in ("examples", "meshes", "studies"):
        own = [path for path in (ROOT / folder).rglob("*.*") if path.is_file() and "__pycache__" not in path.parts]
        assert {f"beamfem/shipped/{path.relative_to(ROOT).as_posix()}" for path in own} <= names
    assert "beamfem_command.py" in names
    assert not any(name.endswith(".pyc") or name.startswith("tests") for name in names)
