"""The command `beamfem study`: studies are listed, described and run with their parameters as options."""

import json
import re
import sys

import pytest
from test_cli import ROOT, invoke

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
    assert "did you mean pendulum? Known are all, benchmarks/chain_growth, " in message
    assert message.count("chain_growth") == 1
