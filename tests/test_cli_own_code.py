"""Results with parts from a user's Python file on the command line: `--code` runs this file, and nothing else does."""

import json
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import pyvista
from model_file_pairs import arm
from test_cli import invoke

import beamfem as bf

PAGE = (Path(__file__).parent.parent / "docs" / "model_files.md").read_text().split("## User-defined Python code")[1]
PARTS = re.search(r"```python\n(.*?)```", PAGE, re.S)[1]
MODEL = re.search(r"```toml\n(.*?)```", PAGE, re.S)[1].replace("duration = 0.1", "duration = 0.01")
TELL = "from pathlib import Path\nPath(__file__).with_name('ran').touch()\n"
COMMANDS = {"info": (), "export": ("a.pvd",), "plot": ("a.svg",)}


@pytest.fixture(autouse=True)
def _forgotten():
    """Forget the user's modules after each test."""
    yield
    for name in ("parts", "other"):
        sys.modules.pop(name, None)


@pytest.fixture
def saved(tmp_path, monkeypatch):
    """Return the results of the example of the page; `parts.py` beside them, here too, leaves a file `ran`."""
    monkeypatch.chdir(tmp_path)
    Path("parts.py").write_text(PARTS + TELL)
    Path("m.toml").write_text(MODEL)
    done = invoke("run", "m.toml", "--out", "m.h5", "--quiet")
    assert done.exit_code == 0, done.output
    del sys.modules["parts"]
    Path("ran").unlink()
    return tmp_path / "m.h5"


@pytest.mark.parametrize("command", COMMANDS)
def test_the_option_is_named_and_no_file_is_run_without_it(saved, command):
    done = invoke(command, saved, *COMMANDS[command])
    assert (done.exit_code, done.stdout) == (2, "")
    said = "the file holds a Dashpot of the module parts; name the Python file to run: --code parts.py"
    assert done.stderr == f"error: {saved} cannot be loaded: {said}\n"
    assert not Path("ran").exists()
    assert "parts" not in sys.modules


def test_info_shows_a_model_with_its_connectors(saved):
    found = json.loads(invoke("info", saved, "--code", "parts.py", "--json").stdout)
    assert (found["kind"], found["states"]) == ("motion", 11)
    assert found["model"]["connectors"] == ["Dashpot: points arm.end, at (1, 0) m, damping 5"]
    assert Path("ran").exists()
    text = invoke("info", saved, "--code", "parts.py").stdout
    assert "\nconnectors\n  Dashpot: points arm.end, at (1, 0) m, damping 5\n" in text


def test_export_writes_the_force_that_the_file_computes(saved):
    done = invoke("export", saved, "a.pvd", "--code", "parts.py")
    assert (done.exit_code, done.stdout) == (0, "wrote a.pvd\n")
    solution = bf.load(saved)
    velocity = solution.velocity(solution.model.beams[0].end)[-1, 1]
    assert velocity < -0.05
    boundary = pyvista.read(sorted(Path("a_boundary").iterdir())[-1])
    (kind,) = np.flatnonzero(np.char.equal(boundary.field_data["kinds"], "Dashpot"))
    (force,) = boundary["force"][boundary.cell_data["kind"] == kind]
    np.testing.assert_allclose(force, [0.0, -5.0 * velocity, 0.0], rtol=1e-12)


def test_plot_draws_the_model_of_the_file(saved):
    done = invoke("plot", saved, "a.svg", "--code", saved.with_name("parts.py"))
    assert (done.exit_code, done.stdout) == (0, "wrote a.svg\n")
    assert "<svg" in Path("a.svg").read_text()


@pytest.mark.parametrize("command", COMMANDS)
def test_quiet_prints_nothing(saved, command):
    done = invoke(command, saved, *COMMANDS[command], "--code", "parts.py", "--quiet")
    assert (done.exit_code, done.output) == (0, "")
    refused = invoke(command, saved.with_name("none.h5"), *COMMANDS[command], "--quiet")
    assert refused.exit_code == 2
    assert "there is no file" in refused.stderr


def test_what_the_file_prints_is_not_part_of_the_answer(saved):
    Path("parts.py").write_text("print('hello')\n" + PARTS)
    for command in (("info", saved, "--code", "parts.py"), ("run", "m.toml")):
        done = invoke(*command, "--json")
        assert json.loads(done.stdout)
        assert "hello" in done.stderr
        del sys.modules["parts"]


def test_a_file_may_import_the_parts_from_beside_it(saved):
    folder = saved.with_name("code")
    folder.mkdir()
    Path("parts.py").rename(folder / "parts.py")
    (folder / "other.py").write_text("import parts\n")
    assert invoke("info", saved, "--code", folder / "other.py").exit_code == 0


@pytest.mark.parametrize(
    ("code", "text", "words"),
    [
        ("none.py", None, "none.py cannot be run: there is no such file"),
        ("parts", "", "parts cannot be run: it must be the name of a Python file"),
        ("json.py", "raise SystemExit\n", "json.py has the name of an installed module"),
        ("other.py", "import beamfem\nx + 1\n", "other.py cannot be run: line 2: NameError: name 'x'"),
        ("other.py", "import sys\nsys.exit(0)\n", "other.py cannot be run: line 2: SystemExit: 0"),
        ("other.py", "", "parts, which other.py does not import; name the Python file to run: --code parts.py"),
        ("parts.py", "", "the file holds a Dashpot, and parts.py has no dataclass of this name"),
        ("parts.py", PARTS.replace("damping", "size"), "parts:Dashpot is no longer that which the file was saved with"),
    ],
)  # fmt: skip
def test_a_mistake_with_the_file_is_named(saved, code, text, words):
    if text is not None:
        Path(code).write_text(text)
    done = invoke("info", saved, "--code", code)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert json.loads(invoke("info", saved, "--code", code, "--json").stdout)["exit_code"] == 2


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("__main__", "of the script that saved it, which commands cannot read; move Part to a Python file"),
        ("own.parts", "of the module own.parts; name the Python file to run: --code FILE.py, a file that imports it"),
    ],
)
def test_classes_of_scripts_and_packages_are_told_apart(tmp_path, monkeypatch, module, words):
    """The class is of such a module while the model is saved, and the module is gone after it."""

    @dataclass(frozen=True)
    class Part(bf.PointLoad):
        point: bf.Point
        value = 0.0, -1.0, 0.0

    Part.__module__, Part.__qualname__ = module, "Part"
    home = ModuleType(module)
    home.Part = Part
    beam = arm()
    with monkeypatch.context() as patched:
        patched.setitem(sys.modules, module, home)
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [Part(beam.end)])).save(tmp_path / "a.h5")
    done = invoke("info", tmp_path / "a.h5")
    assert done.exit_code == 2
    assert words in done.stderr
