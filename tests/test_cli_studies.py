"""The command `beamfem study`: studies are listed, described and run with their parameters as options."""

import json
import sys

import pytest
from test_cli import ROOT, invoke

import beamfem as bf
from beamfem.cli import elements, options
from beamfem.cli.modelfile.elements import PRESETS

STUDY = '''"""A study of nothing.

Second paragraph.
"""
from helper import twice
import beamfem as bf

def main(elements: int, length: float = 1.5, name: str = "beam", fine: bool = False, meshes: tuple[int, ...] = (1, 2),
         element: bf.Element = bf.ANCF(), section: bf.Section | None = None, some_order: int = 1, json: int = 3):
    """Return what was given.

    Parameters
    ----------
    elements : int
        Number of elements
        of the beam.
    length : float, [m], default 1.5
        Length of the beam.
    name, fine : str, bool
        What is returned as well.
    meshes : tuple of int
        Numbers of elements.
    some_order : int
        Order of the field.

    Returns
    -------
    dict
        All of it.
    """
    print("working")
    if length < 0:
        raise bf.InputError("length must be positive")
    if length > 100:
        raise bf.ConvergenceError("no equilibrium")
    return {"elements": twice(elements), "length": length, "name": name, "fine": fine, "meshes": meshes,
            "element": element.name, "section": section, "json": json, "order": some_order}
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
        if name.split(".")[0] in ("studies", "nothing", "helper", "factor", "times", "alone"):
            del sys.modules[name]


def test_studies_are_listed_and_run_with_their_parameters(studies):
    listed = invoke("study")
    assert listed.stdout.splitlines()[-1].split(maxsplit=1) == ["nothing", "A study of nothing."]
    assert [item["name"] for item in json.loads(invoke("study", "--json").stdout)] == ["nothing"]
    done = invoke("study", "nothing", "--elements", 3, "--fine", "--meshes", "4,8", "--element", "CRBF(3)")
    assert done.exit_code == 0, done.output
    for line in ("working", "elements: 6", "length: 1.5", "fine: True", "meshes: 4 8", "element: CRBF-3", "json: 3"):
        assert line in done.stdout.splitlines()
    found = json.loads(invoke("study", "--json", "nothing", "--elements", 3, "--json", 7).stdout)["result"]
    assert (found["meshes"], found["element"], found["section"], found["json"]) == ([1, 2], "ANCF", None, 7)
    assert invoke("study", "nothing", "--elements", 3, "--quiet").stdout == ""


def test_studies_in_sub_folders_go_by_their_file_or_with_their_folder(studies, monkeypatch):
    """Of two with one file name, the folder tells which is meant; both ways of sharing code work."""
    for name in [name for name in sys.modules if name.split(".")[0] == "studies"]:
        monkeypatch.delitem(sys.modules, name)
    (studies / "__init__.py").touch()
    for name, factor in (("twice", 2), ("thrice", 3)):
        (studies / name).mkdir()
        (studies / name / "factor.py").write_text(f"FACTOR = {factor}\n")
        head = f'"""Times {factor}."""\nfrom studies.{name}.factor import FACTOR\n'
        code = f"{head}\ndef main(x: int = 1):\n    return FACTOR * x\n"
        (studies / name / "times.py").write_text(code)
    (studies / "twice" / "alone.py").write_text("from factor import FACTOR\n\ndef main():\n    return FACTOR\n")
    names = [item["name"] for item in json.loads(invoke("study", "--json").stdout)]
    assert names == ["nothing", "thrice/times", "twice/alone", "twice/times"]
    assert json.loads(invoke("study", "--json", "alone").stdout)["result"] == 2
    for name, expected in (("thrice/times", 12), ("twice/times", 8)):
        assert json.loads(invoke("study", "--json", name, "--x", 4).stdout)["result"] == expected
    done = invoke("study", "times")
    assert done.exit_code == 2
    assert "thrice/times or twice/times" in done.stderr


def helped(*arguments):
    """Return the help of a command without its frame, and the line of each option by its name."""
    text = invoke(*arguments, "--help").stdout
    assert "\u2502" in text, "options stand in a panel"
    rows: dict[str, str] = {}
    name = ""
    for line in (line.strip(" \u2502") for line in text.splitlines() if line.startswith("\u2502")):
        name = next((word for word in line.lstrip("* ").split()[:1] if word.startswith("--")), name)
        rows[name] = f"{rows.get(name, '')} {line}"
    return " ".join(text.split()), {name: " ".join(row.split()) for name, row in rows.items()}


def test_help_of_a_study_comes_from_its_docstring(studies, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    text, options = helped("study", "nothing")
    assert "Usage: beamfem study nothing [OPTIONS] A study of nothing. \u256d" in text
    assert list(options)[:4] == ["--elements", "--length", "--name", "--fine"]
    for name, words in (
        ("--elements", "Number of elements of the beam. [required]"),
        ("--length", "Length of the beam (m). [default: 1.5]"),
        ("--name", "What is returned as well. [default: beam]"),
        ("--fine", "What is returned as well. [default: no-fine]"),
        ("--meshes", "<int,...> Numbers of elements. [default: 1,2]"),
        ("--element", "<element> [default: ANCF]"),
        ("--some-order", "Order of the field. [default: 1]"),
        ("--quiet", "Print errors only."),
    ):
        assert options[name].endswith(words)
    assert "--section" not in text
    assert "--some_order" not in text


def test_options_of_studies_may_have_underscores(studies):
    for option in ("--some-order", "--some_order"):
        for given in ([option, 4], [f"{option}=4"]):
            done = invoke("study", "--json", "nothing", "--elements", 3, *given, "--name=a_b")
            found = json.loads(done.stdout)["result"]
            assert (found["order"], found["name"]) == (4, "a_b")


def test_parameters_of_studies_may_be_described_in_a_sentence(studies):
    (studies / "short.py").write_text(
        'def main(x: float = 1.0, y: int = 2):\n    """Add; x [m]: the first; y: the second one."""\n    return x + y\n'
    )
    _, options = helped("study", "short")
    assert options["--x"].endswith("The first (m). [default: 1.0]")
    assert options["--y"].endswith("The second one. [default: 2]")


def test_elements_are_shown_as_they_are_typed(studies, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    head = "from collections.abc import Sequence\nimport beamfem as bf\n"
    parameters = "one: bf.Element = bf.CRBF(3), some: Sequence[bf.Element] = (bf.CRBF(2), bf.ANCFCRBF())"
    code = "    return {'one': one == bf.CRBF(3), 'some': some == (bf.CRBF(2), bf.ANCFCRBF())}\n"
    (studies / "shown.py").write_text(f"{head}def main({parameters}):\n{code}")
    _, rows = helped("study", "shown")
    assert rows["--one"].endswith("<element> [default: CRBF(3)]")
    assert rows["--some"].endswith("[default: CRBF(2),ANCFCRBF]")
    for given in ((), ("--one", "CRBF(3)", "--some", "CRBF(2),ANCFCRBF")):
        assert json.loads(invoke("study", "--json", "shown", *given).stdout)["result"] == {"one": True, "some": True}


@pytest.mark.parametrize("name", [*(name for name in PRESETS if name != "CRBF"), "CRBF(1)", "CRBF(8)"])
def test_the_text_of_an_element_is_read_as_this_element(name):
    assert elements.text_of_element(elements.element_from_text(name)) == name


@pytest.mark.parametrize(
    ("element", "name"),
    [
        (bf.CRBF(3, integration="full"), "CRBF-3"),
        (bf.ANCF(bf.Structural()), "ANCF"),
        (bf.Element(bf.Lagrange(2), bf.Gradients(), bf.Structural()), "order2-gradients"),
    ],
)
def test_elements_that_no_text_describes_are_shown_with_a_remark(element, name):
    assert elements.text_of_element(element) == f"{name} (in Python only)"


@pytest.mark.parametrize(
    "file", [file for file in (ROOT / "studies").rglob("*.py") if "\ndef main(" in file.read_text()]
)
def test_every_option_of_the_studies_is_described(file, monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setenv("COLUMNS", "100")
    _, options = helped("study", file.relative_to(ROOT / "studies").with_suffix("").as_posix())
    assert {"--json", "--quiet", "--help"} <= set(options)
    for name, row in options.items():
        assert row.partition(" [default:")[0].endswith("."), name


def test_mistakes_with_studies(studies, tmp_path):
    for arguments, words in (
        (("nothin", "--elements", 1), "did you mean nothing"),
        (("nothing",), "--elements"),
        (("nothing", "--elements", "x"), "--elements"),
        (("nothing", "--elements", 1, "--lenght", 2), "--length"),
        (("nothing", "--elements", 1, "--meshes", "1,x"), "'x' is not a valid int"),
        (("nothing", "--elements", 1, "--element", "CRFB(2)"), "did you mean CRBF"),
        (("nothing", "--elements", 1, "--element", "CRBF"), "needs its order"),
        (("nothing", "--elements", 1, "--length", "-1"), "length must be positive"),
    ):
        done = invoke("study", *arguments)
        assert done.exit_code == 2, arguments
        assert words in " ".join(done.stderr.replace("│", " ").split()), arguments
    assert invoke("study", "nothing", "--elements", 1, "--length", 200).exit_code == 1
    assert "--folder" in invoke("study", "--folder", tmp_path / "none").stderr
    (tmp_path / "empty").mkdir()
    done = invoke("study", "--folder", tmp_path / "empty")
    assert done.exit_code == 2
    assert "function main" in done.stderr


def test_the_studies_of_the_repository_have_options(monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "path", list(sys.path))
    assert "paper/cantilever_small" in invoke("study").stdout
    done = invoke("study", "--json", "cantilever_small", "--meshes", "3,48")
    found = json.loads(done.stdout)["result"]
    assert found["ANCF-CRBF, continuum, plane stress"][1] == pytest.approx(0.01819510330389, rel=2e-4)


def test_a_parameter_that_no_text_can_describe_needs_a_default():
    def main(section: bf.Section) -> None: ...

    with pytest.raises(bf.InputError, match="section of main"):
        options.command_of(main, print, {})
