"""Model files: every mistake with file, line and key; what is documented runs and is right."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from beamfem.cli.app import app
from beamfem.cli.modelfile import ModelFileError, actions, axes, elements, files, functions, parts, read_model_file
from beamfem.cli.modelfile.analyses import ANALYSES
from beamfem.cli.modelfile.lines import key_lines

ROOT = Path(__file__).parent.parent
DOCS = (ROOT / "docs" / "model_files.md").read_text()
BLOCKS = re.findall(r"```toml\n(.*?)```", DOCS, re.S)
BASE = (ROOT / "examples" / "cantilever.toml").read_text()

AWKWARD = """# no key = here
title = "a # that is no comment, = and ]"   # but this is
"quoted.key" = 1
dotted . "second part" . third = '''
[not.a.table]
x = 1
'''
date = 1979-05-27 07:32:00
list = [ # comment with ]
  [1, 2], # first
  { a = 1, b = { c = "}" } },
  \"\"\"text \\\"\"\" with ""quotes"" and
  [[none]] \"\"\"\"\",
]

[ table . "a b" ]
key = 'C:\\path'

[[array]]
name = "one"
[[array.inner]]
x = 1
[array.inner.deep]
y = {}
[[array]]
name = "two"
[[array.inner]]
[[array.inner]]
x = 3
"""


def leaves(value, path=()):
    yield path
    if isinstance(value, dict | list):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(item, (*path, key))


def test_every_key_of_an_awkward_text_has_its_line():
    values = tomllib.loads(AWKWARD)
    lines, text = key_lines(AWKWARD), AWKWARD.splitlines()
    for path in leaves(values):
        if path:
            assert path in lines, path
        if path and isinstance(path[-1], str):
            assert path[-1] in text[lines[path] - 1], path
    assert set(lines) == set(leaves(values)) - {()}
    assert lines["list", 1, "b", "c"] == 11
    assert lines["array", 1, "inner", 1, "x"] == 29
    assert lines["array", 0, "inner", 0, "deep", "y"] == 24
    assert key_lines(AWKWARD.replace("\n", "\r\n")) == lines


@pytest.mark.parametrize("name", ["cantilever", "lee_frame", "flying_beam"])
def test_lines_of_the_examples(name):
    text = (ROOT / "examples" / f"{name}.toml").read_text()
    lines = key_lines(text)
    for path in leaves(tomllib.loads(text)):
        if path and isinstance(path[-1], str):
            assert path[-1] in text.splitlines()[lines[path] - 1]


# what is replaced by what; the line, key and words of the error
MISTAKES = {
    "syntax": ("width = 0.01", "width = = 1", 12, None, "not valid TOML"),
    "unknown table": ("[[loads]]", "[[load]]", 26, "load", "did you mean loads"),
    "unknown key": ("height = 0.01", "hight = 0.01", 13, "sections.square.hight", "did you mean height"),
    "capital letter": ("width = 0.01", "Width = 0.01", 12, "sections.square.Width", "did you mean width"),
    "missing key": ("height = 0.01\n", "", 10, "sections.square", "height is missing"),
    "unknown kind": ('"rectangle"', '"rectangel"', 11, "sections.square.kind", "did you mean rectangle"),
    "missing kind": ('kind = "rectangle"\n', "", 10, "sections.square", "kind is missing"),
    "negative length": ("height = 0.01", "height = -0.01", 13, "sections.square.height", "greater than zero"),
    "length of words": ("height = 0.01", 'height = "thin"', 13, "sections.square.height", 'the text "thin"'),
    "true as a number": ("height = 0.01", "height = true", 13, "sections.square.height", "got true"),
    "incompressible": ("poisson_ratio = 0.3", "poisson_ratio = 0.5", 7, "materials.steel.poisson_ratio", "between"),
    "half an element": ("elements = 4", "elements = 4.5", 17, "beams.arm.elements", "whole number"),
    "unknown section": ('"square"', '"sqare"', 19, "beams.arm.section", "did you mean square"),
    "unknown material": ('= "steel"', '= "wood"', 20, "beams.arm.material", "known are steel"),
    "unknown preset": ('kind = "CRBF"', 'kind = "CRBFS"', 18, "beams.arm.element.kind", "did you mean CRBF"),
    "no order": (", order = 4", "", 18, "beams.arm.element", "order is missing"),
    "odd integration": ("order = 4", 'order = 4, integration = "ful"', 18, "beams.arm.element.integration", '"full"'),
    "curve without length": ("end = [1, 0]", "end = [0, 0]", 16, "beams.arm.curve.start", "two different points"),
    "curve of words": ("[1, 0]", '"right"', 16, "beams.arm.curve.end", "two numbers"),
    "point of no beam": ('"arm.start"', '"leg.start"', 24, "supports[1].point", "there is no beam 'leg'"),
    "no point": ('"arm.start"', '"arm"', 24, "supports[1].point", "arm.end"),
    "point beyond": ('"arm.start"', '"arm.at(1.5)"', 24, "supports[1].point", "between 0 and 1"),
    "point at words": ('"arm.start"', '"arm.at(half)"', 24, "supports[1].point", "must be a number"),
    "one table of many": ("[[supports]]", "[supports]", 22, "supports", "array of tables"),
    "held twice": (
        "[[loads]]",
        '[[supports]]\nkind = "pin"\npoint = "arm.start"\n[[loads]]',
        26,
        "supports[2]",
        "already prescribes",
    ),
    "force of three": ("[0, 833.3333333333334]", "[0, 1, 2]", 29, "loads[1].vector", "two finite numbers"),
    "scale as number": ("vector = [0, 833", "scale = 1\nvector = [0, 833", 29, "loads[1].scale", "true or false"),
    "no size": ("[[loads]]", "[imperfection]\nmode = 1\n[[loads]]", 26, "imperfection", "size is missing"),
    "imperfection of no mode": (
        "[[loads]]",
        "[imperfection]\nsize = 0.001\nmode = 0\n[[loads]]",
        28,
        "imperfection.mode",
        "at least 1, got 0",
    ),
    "imperfection of words": (
        "[[loads]]",
        '[imperfection]\nsize = 0.001\nof = "bucking"\n[[loads]]',
        28,
        "imperfection.of",
        "buckling",
    ),
    "unknown quantity": ('"ux", "uy", "rotation"', '"ux", "uz"', 34, "outputs[1].quantities", "no 'uz'"),
    "reaction nowhere": ('"ux", "uy", "rotation"', '"fx"', 34, "outputs[1].quantities", "no support"),
    "odd states": ('["fx", "fy", "m"]', '["fx"]\nat = "first"', 40, "outputs[2].at", '"last", "all"'),
    "unknown analysis": ("[[loads]]", '[analysis]\nkind = "dynamic"\n[[loads]]', 27, "analysis.kind", "dynamics"),
    "step beyond": (
        "[[loads]]",
        '[analysis]\nkind = "dynamics"\nduration = 1\nstep = 2\n[[loads]]',
        29,
        "analysis.step",
        "must not exceed",
    ),
    "odd tolerance": (
        "[[loads]]",
        '[analysis]\nkind = "static"\nnewton = { tolerance = -1 }\n[[loads]]',
        28,
        "analysis.newton.tolerance",
        "greater than zero",
    ),
    "material of a number": ('= "steel"', "= 3", 20, "beams.arm.material", "must be the name of a material"),
    "kind of a number": ('kind = "rectangle"', "kind = 3", 11, "sections.square.kind", "must be a text"),
    "curve of a list": ('{ kind = "line", start = [0, 0], end = [1, 0] }', "[0, 1]", 16, "beams.arm.curve", "table"),
    "load on no beam": (
        'kind = "force"\npoint = "arm.end"\nvector = [0, 833.3333333333334]',
        'kind = "distributed"\nbeam = "leg"\nvector = [0, 1]',
        28,
        "loads[1].beam",
        "there is no beam 'leg'",
    ),
    "no quantities": ('["ux", "uy", "rotation"]', "[]", 34, "outputs[1].quantities", "must be a list of some of"),
    "quantities as text": ('["ux", "uy", "rotation"]', '"ux"', 34, "outputs[1].quantities", "must be a list of some"),
    "output of a number": ('name = "tip"', "name = 3", 32, "outputs[1].name", "must be a text"),
    "output of two things": ('name = "tip"', 'beam = "arm"', 32, "outputs[1].beam", "one of them, or none"),
    "no states": ('["fx", "fy", "m"]', '["fx"]\nat = []', 40, "outputs[2].at", '"last", "all"'),
    "states at a number": ('["fx", "fy", "m"]', '["fx"]\nat = 1.0', 40, "outputs[2].at", "a list of numbers"),
    "outputs of modes": ("[[loads]]", '[analysis]\nkind = "modes"\n[[loads]]', 33, "outputs[1]", "go with static"),
    "a mode beyond": (
        "[[loads]]",
        '[analysis]\nkind = "modes"\ncount = 2\nmode = 3\n[[loads]]',
        29,
        "analysis.mode",
        "at most count, 2",
    ),
    "odd start": (
        "[[loads]]",
        '[analysis]\nkind = "dynamics"\nduration = 1\nstep = 0.1\nstart = "rest"\n[[loads]]',
        30,
        "analysis.start",
        '"reference" or "static"',
    ),
    "until of no quantity": (
        "[[loads]]",
        '[analysis]\nkind = "path"\nuntil = { point = "arm.end", quantity = "uz", above = 1 }\n[[loads]]',
        28,
        "analysis.until.quantity",
        "ux, uy or rotation",
    ),
    "until above and below": (
        "[[loads]]",
        '[analysis]\nkind = "path"\nuntil = { point = "arm.end", quantity = "uy", above = 1, below = 0 }\n[[loads]]',
        28,
        "analysis.until.below",
        "and not both",
    ),
    "until neither": (
        "[[loads]]",
        '[analysis]\nkind = "path"\nuntil = { point = "arm.end", quantity = "uy" }\n[[loads]]',
        28,
        "analysis.until",
        "either below or above",
    ),
    "no beams": ("[beams.arm]", "[materials.arm]", None, None, "at least one beam"),
}  # fmt: skip


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_reported_with_file_line_and_key(case, tmp_path):
    old, new, line, key, words = MISTAKES[case]
    assert old in BASE
    file = tmp_path / "model.toml"
    file.write_text(BASE.replace(old, new, 1))
    with pytest.raises(ModelFileError) as caught:
        read_model_file(file)
    error = caught.value
    assert (error.line, error.key) == (line, key), str(error)
    assert words in error.message
    assert str(error).startswith(str(file) + (f":{line}: " if line else ": ") + (f"{key}: " if key else ""))


def test_a_file_that_is_none(tmp_path):
    with pytest.raises(ModelFileError, match="no such file"):
        read_model_file(tmp_path / "none.toml")
    with pytest.raises(ModelFileError, match="folder"):
        read_model_file(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b'title = "\xfc"')
    with pytest.raises(ModelFileError, match="UTF-8"):
        read_model_file(tmp_path / "latin.toml")
    (tmp_path / "empty.toml").write_text("")
    with pytest.raises(ModelFileError, match="at least one beam"):
        read_model_file(tmp_path / "empty.toml")


def test_joints_that_do_not_touch_have_a_line_and_tables_move_supports(tmp_path):
    file = tmp_path / "model.toml"
    joint = '[[joints]]\nkind = "hinge"\na = "arm.start"\nb = "arm.end"\n'
    file.write_text(BASE + joint)
    with pytest.raises(ModelFileError, match="1 m apart") as caught:
        read_model_file(file)
    assert caught.value.line == BASE.count("\n") + 3  # of the key that is named first
    held = '[[supports]]\nkind = "prescribed"\npoint = "arm.end"\nuy = { kind = "table", points = [[0, 0], [1, 1]] }\n'
    file.write_text(BASE + held)  # in statics it is a path of the support
    assert read_model_file(file).model.supports[1].uy(0.25) == 0.25
    motion = '[analysis]\nkind = "dynamics"\nduration = 1.0\nstep = 0.1\n'
    file.write_text(BASE + motion + held)
    assert read_model_file(file).model.supports[1].uy.kinks == (0.0, 1.0)


def test_every_kind_and_key_is_documented():
    kinds = {**parts.SECTIONS, **elements.ELEMENTS, **axes.CURVES, **functions.FUNCTIONS}
    kinds |= {**actions.SUPPORTS, **actions.JOINTS, **actions.LOADS, **ANALYSES, **files.FILES}
    import inspect

    for kind, make in kinds.items():
        (row,) = [line for line in DOCS.splitlines() if re.match(rf"\|[^|]*`{kind}`", line)]
        for key in inspect.signature(make).parameters:
            assert f"`{key}`" in row, (kind, key)
    for kind in (*elements.FORCES, *elements.FIELDS, *elements.COORDINATES, *axes.MESHES):
        assert f'"{kind}"' in DOCS


def run(text, tmp_path, *options):
    file = tmp_path / "model.toml"
    file.write_text(text)
    result = CliRunner().invoke(app, ["run", str(file), "--json", *options])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_documented_files_are_right(tmp_path):
    (tmp_path / "parts.py").write_text(re.search(r"```python\n(.*?)```", DOCS, re.S)[1])
    (tmp_path / "portal.msh").write_bytes((ROOT / "meshes" / "portal.msh").read_bytes())
    weight, portal, crooked, string, column, driven, rolled, damped, swept = (run(block, tmp_path) for block in BLOCKS)
    assert portal["outputs"][1]["rows"][0]["fy"] == pytest.approx(
        500.0 * 6.0 / 2, rel=1e-9
    )  # half of the load on the beam
    assert damped["outputs"][1]["rows"][0]["fy"] == pytest.approx(
        [-5.0 * damped["outputs"][0]["rows"][0]["vy"]], rel=1e-12
    )
    critical = np.pi**2 * 2e11 * 0.02 * 0.01**3 / 12.0 / 4.0
    bent = 1e-3 / (1.0 - 600.0 / critical) - 1e-3
    assert abs(crooked["outputs"][0]["rows"][0]["ux"]) == pytest.approx(bent, rel=2e-4)
    # reactions of weight and force; the moment has the deflected levers
    clamp = weight["outputs"][1]["rows"][0]
    assert clamp["fy"] == pytest.approx(10.0 + 7800.0 * 1e-4 * 9.81, rel=1e-9)
    assert clamp["m"] == pytest.approx(10.0 + 7800.0 * 1e-4 * 9.81 / 2, rel=1e-3)
    # pinned string of tension T with bending: f_n = n / (2 l) sqrt(T / m) sqrt(1 + n^2 pi^2 E I / (T l^2));
    # stretched by T / (E A) its length grows and its mass per length falls
    area, second, tension = np.pi * 1e-6, np.pi * 2e-3**4 / 64, 500.0
    stretch = 1.0 + tension / (2e11 * area)
    n = np.arange(1, 4)
    length, mass = 0.65 * stretch, 7800.0 * area / stretch
    speed = np.sqrt(tension / mass * (1.0 + n**2 * np.pi**2 * 2e11 * second / (tension * length**2)))
    np.testing.assert_allclose(string["frequencies"], n / (2.0 * length) * speed, rtol=5e-5)
    # Euler's column; shear and shortening change it by about pi^2 / (4 L^2) (I / A) (1 + E / (k_s G))
    bending = 2e11 * 0.01**4 / 12
    np.testing.assert_allclose(column["load_factors"], bending * np.pi**2 / 4 * np.array([1, 9]), rtol=1e-3)
    assert [row["time"] for row in driven["outputs"][0]["rows"]] == [0.1, 0.2]
    assert driven["states"] == 21
    assert [Path(path).stat().st_size > 1000 for path in rolled["written"]] == [True]
    by_force = np.array([point["tip uy"] for point in swept["points"]]).reshape(4, 2)
    assert np.all(np.diff(by_force, axis=0) > 0.0)  # stiffer and stiffer
    ratio = by_force[:, 1] / by_force[:, 0]  # of a load ten times as large, nearer to ten the less the beam bends
    assert np.all(np.diff(ratio) > 0.0)
    assert np.all(ratio < 10.0)


def test_examples_are_right(tmp_path):
    tip = run(BASE, tmp_path)["outputs"][0]["rows"][-1]
    assert (tip["ux"], tip["uy"]) == pytest.approx((-0.38764432833, 0.71385896416), abs=5e-7)
    frame = run((ROOT / "examples" / "lee_frame.toml").read_text(), tmp_path)
    assert frame["limit_points"][0] == pytest.approx(18544.527, rel=3e-5)
    at_limit = frame["outputs"][0]["limit_points"][0]
    assert (at_limit["ux"], at_limit["uy"]) == pytest.approx((26.87833, -48.75424), abs=2e-3)
    flying = run((ROOT / "examples" / "flying_beam.toml").read_text(), tmp_path)
    ends = [flying["outputs"][i]["rows"][0] for i in (0, 1)]
    assert [(end["x"], end["y"]) for end in ends] == [
        pytest.approx((4.1597, 4.5321), abs=5e-4),
        pytest.approx((4.8973, 6.6470), abs=5e-4),
    ]
    assert flying["outputs"][2]["rows"][0]["total"] == pytest.approx(204.38, abs=0.05)
