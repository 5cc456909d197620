"""What comes with beamfem: a model file to start from, examples to copy, studies with their parameters as options."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from zipfile import ZipFile

import pytest
from test_cli import ROOT, invoke

from beamfem.cli import bundled
from beamfem.cli.model_file import read_model_file

STUDY = '''"""A study of nothing.

Second paragraph.
"""
from helper import twice
import beamfem as bf

def main(elements: int, length: float = 1.5, name: str = "beam", fine: bool = False, meshes: tuple[int, ...] = (1, 2),
         section: bf.Section | None = None, some_order: int = 1):
    """Return what was given.

    Parameters
    ----------
    elements : int
        Number of elements.
    """
    print("working")
    if length < 0:
        raise bf.InputError("length must be positive")
    if length > 100:
        raise bf.ConvergenceError("no equilibrium")
    return {"elements": twice(elements), "length": length, "name": name, "fine": fine, "meshes": meshes,
            "section": section, "order": some_order}
'''


@pytest.fixture
def studies(tmp_path, monkeypatch):
    folder = tmp_path / "studies"
    folder.mkdir()
    (folder / "nothing.py").write_text(STUDY)
    (folder / "helper.py").write_text('"""No study."""\ndef twice(x):\n    return 2 * x\n')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    known = set(sys.modules)
    yield folder
    for name in set(sys.modules) - known:
        if name.split(".")[0] in ("studies", "nothing", "helper", "times"):
            del sys.modules[name]


def test_studies_are_listed_and_run_with_their_parameters(studies):
    listed = invoke("study")
    assert listed.stdout.splitlines()[-1].split(maxsplit=1) == ["nothing", "A study of nothing."]
    assert [item["name"] for item in json.loads(invoke("study", "--json").stdout)] == ["nothing"]
    done = invoke("study", "nothing", "--elements", 3, "--fine", "--meshes=4,8", "--some-order", 2, "--json")
    found = json.loads(done.stdout)["result"]
    assert found == {
        "elements": 6,
        "length": 1.5,
        "name": "beam",
        "fine": True,
        "meshes": [4, 8],
        "section": None,
        "order": 2,
    }
    assert invoke("study", "nothing", "--elements", 3, "--meshes", 7).stdout.splitlines()[0] == "working"
    assert invoke("study", "nothing", "--elements", 3, "--quiet").stdout == ""


def test_studies_in_sub_folders_are_named_by_their_file_or_with_their_folder(studies):
    for name, factor in (("twice", 2), ("thrice", 3)):
        (studies / name).mkdir()
        (studies / name / "times.py").write_text(
            f'"""Times {factor}."""\ndef main(x: int = 1):\n    return {factor} * x\n'
        )
    assert "with its folder" in invoke("study", "times").stderr
    for name, result in (("twice/times", "10"), ("thrice/times", "15")):
        assert invoke("study", name, "--x", 5).stdout.strip() == result


def test_help_lists_the_options_with_their_defaults_and_descriptions(studies):
    text = invoke("study", "nothing", "--help").stdout
    assert text.startswith("Usage: beamfem study nothing [OPTIONS]\n\n  A study of nothing.\n")
    assert re.search(r"--elements <int> +\[required\]\n +--length <float> +\[default: 1.5\]\n", text)
    assert re.search(r"--some-order <int> +\[default: 1\]", text)
    assert "Number of elements." in text


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nothin", "--elements", 1), "did you mean nothing"),
        (("nothing",), "Missing option '--elements'"),
        (("nothing", "--elements", "x"), "Invalid value for '--elements'"),
        (("nothing", "--elements"), "Option '--elements' requires an argument"),
        (("nothing", "--elements", 1, "--lenght", 2), "Possible options: --elements, --length"),
        (("nothing", "--elements", 1, "--meshes", "1,x"), "Invalid value for '--meshes'"),
        (("nothing", "--elements", 1, "--length", "-1"), "length must be positive"),
        (("--folder", "none"), "--folder"),
    ],
)
def test_mistakes_with_studies(studies, arguments, words):
    done = invoke("study", *arguments)
    assert done.exit_code == 2
    assert words in " ".join(done.stderr.replace("│", " ").split())
    assert invoke("study", "nothing", "--elements", 1, "--length", 200).exit_code == 1


def test_the_studies_of_the_repository_have_options(monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "path", list(sys.path))
    assert "paper/cantilever_small" in invoke("study").stdout
    done = invoke("study", "--json", "cantilever_small", "--meshes", "3,48")
    found = json.loads(done.stdout)["result"]
    assert found["ANCF-CRBF, continuum, plane stress"][1] == pytest.approx(0.01819510330389, rel=2e-4)
    message = invoke("study", "penduum").stderr
    known = "accuracy/random_motions, accuracy/random_statics, all, benchmarks/chain_growth, "
    assert f"did you mean pendulum? Known are {known}" in message
    assert message.count("chain_growth") == 1


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
    monkeypatch.setattr(bundled, "_PACKAGE", tmp_path / "none" / "beamfem")
    assert "came without its examples" in invoke("examples").stderr


def test_folders_in_the_package_come_before_those_beside_it(tmp_path, monkeypatch):
    monkeypatch.setattr(bundled, "_PACKAGE", tmp_path / "beamfem")
    assert bundled.shipped("studies") is None
    (tmp_path / "studies").mkdir()
    assert bundled.shipped("studies") == tmp_path / "studies"
    inside = tmp_path / "beamfem" / "shipped" / "studies"
    inside.mkdir(parents=True)
    assert bundled.shipped("studies") == inside


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


def test_a_new_model_file_runs_as_it_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = invoke("new", "bracket.toml")
    assert (done.exit_code, done.stdout) == (0, "wrote bracket.toml; solve it with: beamfem run bracket.toml\n")
    found = json.loads(invoke("run", "bracket.toml", "--json").stdout)
    end, foot = (output["rows"][0] for output in found["outputs"])
    assert foot["fy"] == pytest.approx(10.0, rel=1e-9)
    assert foot["m"] == pytest.approx(10.0 * (0.4 + end["ux"]), rel=1e-9)
    assert -0.3 < end["uy"] < 0.0


@pytest.mark.parametrize(("name", "words"), [("a.txt", "a.toml would be right"), ("there.toml", "already exists")])
def test_a_new_model_file_takes_no_place_of_another(tmp_path, name, words):
    (tmp_path / "there.toml").write_text("mine")
    done = invoke("new", tmp_path / name)
    assert done.exit_code == 2
    assert words in done.stderr
    assert (tmp_path / "there.toml").read_text() == "mine"


def test_everything_that_the_template_mentions_can_be_read(tmp_path):
    """The lines behind a comment sign too, one analysis after the other."""
    text = Path(bundled.__file__).with_name("template.toml").read_text()
    begin, analyses, rest = re.split(r"^# -+ (?:one \[analysis\]|outputs to print).*\n", text, flags=re.MULTILINE)
    begin = re.sub(r"^# (?=\w+ = |\[)", "", begin, flags=re.MULTILINE)
    kinds = []
    for analysis in re.split(r"^(?:# )?\[analysis\]\n", analyses, flags=re.MULTILINE)[1:]:
        own = "[analysis]\n" + re.sub(r"^# ", "", analysis, flags=re.MULTILINE)
        kinds.append(re.search(r'kind = "(\w+)"', own)[1])
        asked = rest if kinds[-1] in ("static", "path", "dynamics") else ""
        asked = re.sub(r"^# (?=\w+ = |\[\[)", "", asked, flags=re.MULTILINE)
        (tmp_path / "model.toml").write_text(begin + own + asked)
        assert len(read_model_file(tmp_path / "model.toml").model.loads) == 2
    tapered = re.search(r"height = \S+ # tapered: (\{.*\})", begin)[1]
    (tmp_path / "model.toml").write_text(re.sub(r"height = .*", f"height = {tapered}", begin))
    assert read_model_file(tmp_path / "model.toml").model.beams[1].section_at(0.2).area == pytest.approx(0.03 * 0.0015)
    assert kinds == ["static", "path", "buckling", "modes", "dynamics"]
