"""What the command says of model files: in their keys and units, not in Python."""

import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

import beamfem as bf
from beamfem.cli.app import app
from beamfem.cli.modelfile.phrases import _PHRASES, in_keys

ROOT = Path(__file__).parent.parent
LEE = (ROOT / "examples" / "lee_frame.toml").read_text()
CANTILEVER = (ROOT / "examples" / "cantilever.toml").read_text()
# what writes in Python is told in Python: connectors, integrators and functions of the user's, and what no file can ask
OF_PYTHON = (
    "such as dataclasses.replace(begin",
    "field_on_basis",
    "its energy() is not that",
    "Write lengths as np.sqrt",
    "a Model is asked for",
    "one of model.connectors",
    "must be the Model of its states",
    "as bf.Integrator describes it",
    "no cubic spline",
    "must give True or False",
)


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def _text(node: ast.AST) -> str:
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "1" for part in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


def messages(room: str) -> Iterator[str]:
    """Yield the sentences in the code of a room: texts with blanks, no docstrings; 1 for what is filled in."""
    for file in sorted((ROOT / "beamfem" / room).rglob("*.py")):
        tree = ast.parse(file.read_text())
        skipped = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.JoinedStr):
                skipped |= {id(part) for part in ast.walk(node) if part is not node}
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and isinstance(node.body[0], ast.Expr):
                skipped.add(id(node.body[0].value))
        yield from (text for node in ast.walk(tree) if id(node) not in skipped and " " in (text := _text(node)))


FUNCTIONS = {name for name in bf.__all__ if name.islower()} - {"load", "converge", "sweep"}  # these are words too
CLASSES = {name for name in bf.__all__ if not name.islower()} - {"Newton", "Modes", "Buckling"}
SENTENCES = [text for room in ("solve", "assembly", "linalg", "results") for text in messages(room)]


@pytest.mark.parametrize("text", [text for text in SENTENCES if not any(part in text for part in OF_PYTHON)])
def test_messages_of_solvers_are_told_in_keys(text):
    told = in_keys(text)
    words = set(re.findall(r"[A-Za-z_]+", re.sub(r"`[^`]*`|\[\[?[a-z.A-Z]+\]?\]", "", told)))
    if text.startswith(("Modes(", "Buckling(", "BeamStress(", "State |")):
        return  # texts of results for a prompt
    assert not words & FUNCTIONS, told
    assert not words & CLASSES, told
    assert not re.search(r"\b(?!E |I )\w+\((?!s\)|ne\b)[a-z]+=|\bmodel=|\bsnap=|save_every=", told), told


def test_phrases_are_those_of_messages():
    """A message that is reworded is found here, not by a user."""
    known = [text for room in ("",) for text in messages(room)]
    for python, _ in _PHRASES:
        parts = [text for text in known if python.strip() in text]
        assert len(parts) > 1, f"no message says: {python}"  # the phrase itself is one


def test_snapping_and_free_models_are_told_in_keys(tmp_path):
    static = LEE.replace('kind = "path"', 'kind = "static"').replace("[0, -1.0]", "[0, -25000.0]")
    (tmp_path / "lee.toml").write_text(re.sub("until = .*", "", static))
    said = invoke("run", tmp_path / "lee.toml")
    assert said.exit_code == 1
    assert '`kind = "path"` in [analysis] follows the path around it; `snap = "jump"` beside' in said.stderr
    assert "trace_equilibrium" not in said.stderr
    free = CANTILEVER.replace('kind = "clamp"', 'kind = "pin"').replace('"fx", "fy", "m"', '"fx"')
    (tmp_path / "free.toml").write_text(free)
    told = json.loads(invoke("run", tmp_path / "free.toml", "--json").stdout)["error"]["message"]
    assert told.startswith("beam 'arm' can move freely")
    assert '`kind = "dynamics"` in [analysis]' in told
    assert "simulate" not in told


def test_warnings_are_told_once_and_without_lines_of_python(tmp_path):
    (tmp_path / "column.toml").write_text(CANTILEVER.replace("[0, 833.3333333333334]", "[-5000, 0]"))
    command = [sys.executable, "-m", "beamfem", "run", str(tmp_path / "column.toml")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    (line,) = done.stderr.splitlines()
    assert re.match(r"warning: \d of \d rows are unstable equilibria", line)
    assert '`kind = "path"` in [analysis] finds the bifurcations' in line
    assert "; the equilibrium is unstable" in done.stdout
    assert "completed: " in done.stdout


@pytest.mark.filterwarnings("ignore::beamfem.UnitsWarning")
def test_tables_have_the_units_of_the_file(tmp_path):
    (tmp_path / "lee.toml").write_text(
        LEE.replace('units = "N, cm"\n', "").replace("[materials", 'units = "N, mm"\n[materials', 1)
    )
    said = invoke("run", tmp_path / "lee.toml")
    assert re.search(r"load_factor +ux \[mm\] +uy \[mm\]\n", said.stdout)
    found = json.loads(invoke("run", tmp_path / "lee.toml", "--json").stdout)
    assert found["outputs"][0]["units"] == {"ux": "mm", "uy": "mm"}
    assert set(found["outputs"][0]["rows"][0]) == {"load_factor", "ux", "uy"}


def test_what_is_written_is_told_of_in_keys_too(tmp_path):
    """The flying beam has a stiffness and no height, and so no stress."""
    flying = ROOT / "examples" / "flying_beam.toml"
    (tmp_path / "a.toml").write_text(
        flying.read_text().replace("duration = 6.0", "duration = 0.1").replace("at = [4.0]", "")
    )
    command = [sys.executable, "-m", "beamfem", "run", "a.toml", "--vtk", "a.pvd"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    (line,) = done.stderr.splitlines()
    assert line.startswith("warning: the stress of 1 of 1 beams (rod) is not known")
    assert "their key `height` gives it" in line


@pytest.mark.filterwarnings("always::beamfem.LockingWarning")
def test_a_warning_of_a_solve_is_printed_once(tmp_path):
    """As it is found; what is too small for a Python warning is printed at the end."""
    text, changed = re.subn(r'kind = "CRBF", order = \d', 'kind = "ANCF"', CANTILEVER)
    assert changed == 1
    (tmp_path / "ancf.toml").write_text(text)
    said = invoke("run", tmp_path / "ancf.toml")
    assert said.stderr.count("elements lock") == 1
