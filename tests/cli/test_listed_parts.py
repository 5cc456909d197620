"""A part of the package is its class and its line in the stub: all that deals with parts takes it from there.

The file of new parts is imported as one of `beamfem.parts` in a process of its own, where it is listed as it would be.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import beamfem as bf
from beamfem.cli.part_kinds import ACTING, CURVES, ELEMENTS, FORCES, LAWS, SECTIONS
from beamfem.model.parts_by_role import parts_in
from beamfem.public_names import public_dataclasses

FILE = str(Path(__file__).parents[1] / "trial_parts.py")
PARTS = ("SnowLoad", "Slide", "Weld", "Buffer")
EXPORTED = f"""
import importlib.util, json, sys
import beamfem
from beamfem import public_names

spec = importlib.util.spec_from_file_location("beamfem.parts.trial_parts", {FILE!r})
module = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = module
spec.loader.exec_module(module)
for name in {PARTS}:
    public_names.STUB += f"from .parts.trial_parts import {{name}} as {{name}}\\n"
    setattr(beamfem, name, getattr(module, name))
    beamfem.__all__.append(name)
"""
USED = """
from typer.testing import CliRunner
from beamfem.cli.app import app

def command(*arguments):
    done = CliRunner().invoke(app, list(arguments))
    assert done.exit_code == 0, done.output
    return done.stdout

found = {}
command("run", "model.toml", "--out", "a.h5", "--quiet")
found["words"] = json.loads(command("info", "a.h5", "--json"))["model"]
command("export", "a.h5", "a.pvd", "--quiet")
command("plot", "a.h5", "a.svg", "--quiet")

import numpy as np
import pyvista
from pathlib import Path

solution = beamfem.load("a.h5")
model = solution.model
parts = {"Slide": model.supports[1], "SnowLoad": model.loads[0], "Weld": model.joints[0], "Buffer": model.connectors[0]}
found["loaded"] = [type(part) is getattr(beamfem, name) for name, part in parts.items()]
found["kinds"] = [str(kind) for kind in pyvista.read(sorted(Path("a_boundary").iterdir())[-1]).field_data["kinds"]]
solution.to_html("a.html")
model.plot("model.svg")
modes = beamfem.solve_modes(model, 1)
found["imperfect"] = [type(part).__name__ for part in model.with_imperfection(modes, 1e-3).loads]
found["potential"] = solution.energy().potential[-1]
found["p"] = solution.p[-1].tolist()
print(json.dumps(found))
"""
BEAMS = """
[materials.steel]
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[sections.square]
kind = "rectangle"
width = 0.01
height = 0.01
[beams.arm]
curve = { kind = "line", start = [0, 0], end = [0.8, 0.6] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = "square"
material = "steel"
[beams.tip]
curve = { kind = "line", start = [0.8, 0.6], end = [1.6, 0.6] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = "square"
material = "steel"
[[supports]]
kind = "clamp"
point = "arm.start"
"""
TRIAL = """
[[supports]]
kind = "slide"
point = "tip.end"
stiffness = 400
[[joints]]
kind = "weld"
a = "arm.end"
b = "tip.start"
thickness = 0.004
[[loads]]
kind = "snow"
beam = "arm"
size = { kind = "table", points = [[0, 50], [1, 90]] }
[[loads]]
kind = "snow"
beam = "tip"
size = 40
amplitude = { kind = "table", points = [[0, 0], [1, 1]] }
[[connectors]]
kind = "buffer"
point = "tip.at(0.5)"
stiffness = 700
"""


def run(code, folder):
    done = subprocess.run([sys.executable, "-c", EXPORTED + code], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def expected():
    """Return the model of the file with parts of the package as it is."""
    steel, square = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    arm = bf.Beam(bf.Line((0, 0), (0.8, 0.6)), 4, bf.CRBF(3), square, steel)
    tip = bf.Beam(bf.Line((0.8, 0.6), (1.6, 0.6)), 4, bf.CRBF(3), square, steel)
    supports = [bf.Clamp(arm.start), bf.Prescribed(tip.end, ux=0.0, rotation=0.0), bf.Spring(tip.end, (0.0, 400.0))]
    supports.append(bf.Spring(tip.at(0.5), (0.0, 700.0)))
    snow = bf.DistributedLoad(arm, lambda s: (0.0, -0.8 * (50.0 + 40.0 * s)))
    loads = [snow, bf.DistributedLoad(tip, (0.0, -40.0))]
    return bf.solve_static(bf.Model([arm, tip], supports, loads, [bf.Rigid(arm.end, tip.start)]))


def test_listed_parts_are_solved_told_saved_drawn_and_exported(tmp_path):
    (tmp_path / "model.toml").write_text(BEAMS + TRIAL)
    found, known = run(USED, tmp_path), expected()
    assert found["p"] == pytest.approx(known.p[-1].tolist(), abs=1e-9)
    assert found["potential"] == pytest.approx(known.energy().potential[-1], rel=1e-9)
    assert found["loaded"] == [True] * 4
    words = found["words"]
    assert words["supports"][1] == "Slide: point tip.end, stiffness 400 N/m"
    assert words["joints"] == ["Weld: a arm.end, b tip.start, thickness 0.004 m"]
    assert words["loads"][0].startswith("SnowLoad: beam arm, size a function")
    assert words["loads"][1] == "SnowLoad: beam tip, size 40 N/m, amplitude a function"
    assert words["connectors"] == ["Buffer: point tip.at(0.5), stiffness 700 N/m"]
    assert found["kinds"] == ["Clamp", "Slide", "SnowLoad", "Buffer"]
    assert found["imperfect"] == ["SnowLoad", "SnowLoad"]
    for name in ("a.svg", "model.svg", "a.html"):
        assert (tmp_path / name).stat().st_size > 1000


def test_wrong_keys_of_listed_parts_have_their_line(tmp_path):
    code = """
from beamfem.cli.model_file import read_model_file
from beamfem.cli.model_file import ModelFileError
said = []
for line, wrong in (("size = 40", "size = true"), ("size = 40", "sise = 40"), ('kind = "buffer"', 'kind = "bufer"')):
    text = open("model.toml").read()
    open("wrong.toml", "w").write(text.replace(line, wrong))
    try:
        read_model_file("wrong.toml")
    except ModelFileError as error:
        said.append(str(error))
print(json.dumps(said))
"""
    (tmp_path / "model.toml").write_text(BEAMS + TRIAL)
    value, key, kind = run(code, tmp_path)
    assert "loads[2].size: must be a number, or a function" in value
    assert "unknown key; did you mean size?" in key
    assert "there is no kind 'bufer'; did you mean buffer?" in kind


def test_kinds_are_those_of_model_files():
    assert list(ACTING["supports"]) == ["clamp", "foundation", "pin", "prescribed", "roller", "spring"]
    assert list(ACTING["loads"]) == [
        *(
            "actuation",
            "distributed",
            "gravity",
            "motor",
            "moving-force",
            "force",
            "moment",
            "pressure",
            "pretension",
            "temperature",
        ),
    ]
    assert list(ACTING["joints"]) == ["hinge", "rigid"]
    assert list(ACTING["masses"]) == ["mass", "rigid-body"]
    assert set(CURVES) == {"arc", "bspline", "chain", "line", "polyline", "elliptic-arc", "hermite"}
    assert set(SECTIONS) == {
        "circle",
        "rectangle",
        "tube",
        "moments",
        "stiffness",
        "layered",
        "fibres",
        "polygon",
        "profile",
    }
    assert set(LAWS) == {"elastic-plastic", "maxwell", "ramberg-osgood"}
    assert set(ELEMENTS) == {"ANCF", "ANCFCRBF", "CRBF", "BilinearANCF", "BilinearCRBF", "ShearRigid"}
    assert set(FORCES) == {"continuum", "elastic-line", "split-continuum", "structural"}
    assert len(public_dataclasses("parts")) == sum(map(len, ACTING.values()))  # no two have one kind


def test_listed_parts_are_public():
    assert {kind.__name__ for kind in public_dataclasses("parts")} <= set(bf.__all__)


@pytest.mark.parametrize("name", ["supports", "loads", "joints", "masses"])
def test_a_model_names_all_parts_that_its_lists_hold(name):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1e3))
    with pytest.raises(bf.InputError) as caught:
        bf.Model([beam], **{name: [1]})
    assert all(kind.__name__ in str(caught.value) for kind in parts_in(name))
