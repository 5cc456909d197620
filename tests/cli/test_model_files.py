"""Model files: every mistake with file, line and key; what is documented runs and is right."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import beamfem as bf
from beamfem.cli.analyses import Analysis
from beamfem.cli.app import app
from beamfem.cli.model_file import ModelFileError, read_model_file, read_source

ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "model_files.md").read_text(), re.S)
BASE = (ROOT / "examples" / "cantilever.toml").read_text()
ARM = """
[materials.steel]
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.01, height = 0.01 }
material = "steel"
[[supports]]
kind = "clamp"
point = "arm.start"
[[loads]]
kind = "force"
point = "arm.end"
vector = [0, 100]
"""
MOTION = '[analysis]\nkind = "dynamics"\nduration = 0.01\nstep = 1e-3\n'
MODES = '[analysis]\nkind = "modes"\ncount = 3\n'
AWKWARD = """# no key = here
title = "a # that is no comment, = and ]"   # but this, is,
"quoted.key" = 1
dotted . "second part" . third = '''
[not.a.table]
x = 1
'''
list = [ # comment with ]
  [1, 2], # first
  { a = 1, b = { c = "}" } },
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
    if path:
        yield path
    for key, item in value.items() if isinstance(value, dict) else enumerate(value if isinstance(value, list) else ()):
        yield from leaves(item, (*path, key))


@pytest.mark.parametrize(
    "text", [AWKWARD, AWKWARD.replace("\n", "\r\n"), *((ROOT / "examples" / f"{name}.toml").read_text() for name in
             ("cantilever", "lee_frame", "flying_beam"))]
)  # fmt: skip
def test_every_key_has_its_line(text, tmp_path):
    (tmp_path / "a.toml").write_bytes(text.encode())
    source, lines = read_source(tmp_path / "a.toml"), text.splitlines()
    for path in leaves(tomllib.loads(text)):
        line = source.error("", *path).line
        if isinstance(path[-1], str) and path[0] != "list":
            assert path[-1] in lines[line - 1]
        assert path[0] != "list" or line == 8  # where the statement begins
    if text is AWKWARD:
        assert source.error("", "array", 1, "inner", 1, "x").line == 26


# what is replaced by what; the line, key and words of the error
MISTAKES = {
    "syntax": ("width = 0.01", "width = .5", 12, None, "numbers like 0.5"),
    "a key twice": ("width = 0.01", "width = 1\nwidth = 2", 13, None, "the key is there twice"),
    "unknown table": ("[[loads]]", "[[load]]", 26, "load", "did you mean loads"),
    "unknown key": ("height = 0.01", "hight = 0.01", 13, "sections.square.hight", "did you mean height"),
    "capital letter": ("width = 0.01", "Width = 0.01", 12, "sections.square.Width", "did you mean width"),
    "missing key": ("height = 0.01\n", "", 10, "sections.square", "height is missing"),
    "unknown kind": ('"rectangle"', '"rectangel"', 11, "sections.square.kind", "did you mean rectangle"),
    "missing kind": ('kind = "rectangle"\n', "", 10, "sections.square", "kind is missing"),
    "negative length": ("height = 0.01", "height = -0.01", 13, "sections.square.height", "greater than zero"),
    "length of words": ("height = 0.01", 'height = "thin"', 13, "sections.square.height", 'the text "thin"'),
    "true as a number": ("height = 0.01", "height = true", 13, "sections.square.height", "got true"),
    "text as a number": ("density = 7800.0", 'density = "7800"', 8, "materials.steel.density", "must be a number"),
    "incompressible": ("poisson_ratio = 0.3", "poisson_ratio = 0.5", 7, "materials.steel.poisson_ratio", "between"),
    "half an element": ("elements = 4", "elements = 4.5", 17, "beams.arm.elements", "whole number"),
    "unknown section": ('"square"', '"sqare"', 19, "beams.arm.section", "did you mean square"),
    "a kind as a name": ('"square"', '"rectangle"', 19, "beams.arm.section", "width = ..., height = ... }"),
    "unknown material": ('= "steel"', '= "wood"', 20, "beams.arm.material", "known are steel"),
    "unknown preset": ('kind = "CRBF"', 'kind = "CRBFS"', 18, "beams.arm.element.kind", "did you mean CRBF"),
    "no order": (", order = 4", "", 18, "beams.arm.element", "order is missing"),
    "half an order": ("order = 4", "order = 4.5", 18, "beams.arm.element.order", "must be a whole number, got 4.5"),
    "odd integration": ("order = 4", 'order = 4, integration = "ful"', 18, "beams.arm.element.integration", "full"),
    "no length": ("end = [1, 0]", "end = [0, 0]", 16, "beams.arm.curve.start", "two different points"),
    "curve of words": ("[1, 0]", '"right"', 16, "beams.arm.curve.end", "two numbers"),
    "a kind of curve": ('{ kind = "line", start = [0, 0], end = [1, 0] }', '"line"', 16, "beams.arm.curve", "start ="),
    "point of no beam": ('"arm.start"', '"leg.start"', 24, "supports[1].point", "there is no beam 'leg'"),
    "no point": ('"arm.start"', '"arm"', 24, "supports[1].point", "arm.end"),
    "point nowhere": ('"arm.start"', '"arm.at()"', 24, "supports[1].point", "arm.at(0.5)"),
    "point beyond": ('"arm.start"', '"arm.at(1.5)"', 24, "supports[1].point", "between 0 and 1"),
    "one of several": ('point = "arm.start"', 'points = ["arm.start", "arm"]', 24, "supports[1].points[2]", "arm.end"),
    "one table of many": ("[[supports]]", "[supports]", 22, "supports", "array of tables"),
    "held twice": (
        "[[loads]]", '[[supports]]\nkind = "pin"\npoint = "arm.start"\n[[loads]]',
        26, "supports[2]", "already",
    ),
    "joined apart": (
        "[[loads]]", '[[joints]]\nkind = "hinge"\na = "arm.start"\nb = "arm.end"\n[[loads]]',
        28, "joints[1].a", "1 m apart",
    ),
    "force of three": ("[0, 833.3333333333334]", "[0, 1, 2]", 29, "loads[1].vector", "two finite numbers"),
    "scale as number": ("vector = [0, 833", "scale = 1\nvector = [0, 833", 29, "loads[1].scale", "true or false"),
    "no function": (
        "vector = [0, 833", 'amplitude = "ramp"\nvector = [0, 833',
        29, "loads[1].amplitude", "[functions.NAME]",
    ),
    "unknown quantity": ('"ux", "uy", "rotation"', '"ux", "uz"', 34, "outputs[1].quantities", "no 'uz'"),
    "reaction nowhere": ('"ux", "uy", "rotation"', '"fx"', 34, "outputs[1].quantities", "no support"),
    "odd states": ('["fx", "fy", "m"]', '["fx"]\nat = "first"', 40, "outputs[2].at", '"last", "all"'),
    "a state beyond": ('["fx", "fy", "m"]', '["fx"]\nat = [2]', 40, "outputs[2].at", "from 0 to 1"),
    "unknown analysis": ("[[loads]]", '[analysis]\nkind = "dynamic"\n[[loads]]', 27, "analysis.kind", "dynamics"),
    "no table": ("title =", 'analysis = "static"\ntitle =', 3, "analysis", "must be a table"),
    "odd tolerance": (
        "[[loads]]", "[analysis]\nnewton = { tolerance = -1 }\n[[loads]]",
        27, "analysis.newton.tolerance", "zero",
    ),
    "outputs of modes": ("[[loads]]", f"{MODES}[[loads]]", 34, "outputs[1]", "go with static"),
    "odd start": ("[[loads]]", f'{MOTION}start = "rest"\n[[loads]]', 30, "analysis.start", '"static"'),
    "until of nothing": (
        "[[loads]]", '[analysis]\nkind = "path"\nuntil = { point = "arm.end", quantity = "uz" }\n[[loads]]', 28,
        "analysis.until.quantity", '"ux", "uy" or "rotation"',
    ),
    "dropped key": ("title =", 'code = "parts.py"\ntitle =', 3, "code", "unknown key"),
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


def test_mistakes_that_the_analysis_finds_have_their_key_too(tmp_path):
    (tmp_path / "a.toml").write_text(ARM + MOTION.replace("1e-3", "2"))
    with pytest.raises(ModelFileError, match="must not exceed") as caught:
        read_model_file(tmp_path / "a.toml").solve()
    assert caught.value.key == "analysis.step"
    (tmp_path / "a.toml").write_text(ARM + MODES + "mode = 4\n")
    with pytest.raises(ModelFileError, match="between 1 and 3") as caught:
        read_model_file(tmp_path / "a.toml").solve()
    assert caught.value.key == "analysis.mode"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "no such file"),
        (b'title = "\xfc"', "not a text in UTF-8; model files are TOML"),
        (b"\x89HDF\r\n\xff", "a results file, which beamfem info, plot and export read"),
        (b"", "at least one beam"),
        (b"#" * 5_000_001, "more than 5 MB"),
    ],
)
def test_other_files_are_named(content, words, tmp_path):
    if content is not None:
        (tmp_path / "a.toml").write_bytes(content)
    with pytest.raises(ModelFileError, match=words):
        read_model_file(tmp_path / "a.toml")
    with pytest.raises(ModelFileError, match="folder"):
        read_model_file(tmp_path)


def run(text, tmp_path, *options):
    file = tmp_path / "model.toml"
    file.write_text(text)
    result = CliRunner().invoke(app, ["run", str(file), "--json", *options])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_documented_files_are_right(tmp_path):
    weight, string, column, driven = (run(block, tmp_path) for block in BLOCKS)
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


def test_functions_of_time_and_of_the_arc_length(tmp_path):
    ramp = '{ kind = "smooth-ramp", duration = 2, size = 3, start = 1 }'
    sine = '{ kind = "sine", frequency = 0.5, size = 2, mean = 1 }'
    held = f'[[supports]]\nkind = "prescribed"\npoint = "arm.end"\nux = {ramp}\nuy = {sine}\n'
    (tmp_path / "a.toml").write_text(ARM + held)
    support = read_model_file(tmp_path / "a.toml").model.supports[1]
    assert [support.ux(t) for t in (0.0, 1.0, 2.0, 3.0, 9.0)] == [0.0, 0.0, 1.5, 3.0, 3.0]
    h = 1e-4  # no jump of rate and acceleration at either end
    for t in (1.0, 3.0):
        assert (support.ux(t + h) - 2 * support.ux(t) + support.ux(t - h)) / h**2 == pytest.approx(0.0, abs=1e-2)
    assert support.uy(0.5) == pytest.approx(3.0)


def test_a_tapered_cantilever_bends_as_the_integrals_of_bending_and_shear(tmp_path):
    height = '{ kind = "table", points = [[0, 0.02], [1, 0.01]] }'
    text = ARM.replace("height = 0.01", f"height = {height}").replace("[0, 100]", "[0, -1e-3]")
    tip = run(text + '[[outputs]]\npoint = "arm.end"\nquantities = ["uy"]\n', tmp_path)["outputs"][0]["rows"][0]
    x = np.linspace(0.0, 1.0, 20001)
    heights = 0.02 - 0.01 * x
    shear, bending = 5 / 6 * 2e11 / 2.6 * 0.01 * heights, 2e11 * 0.01 * heights**3 / 12
    assert tip["uy"] == pytest.approx(-1e-3 * np.trapezoid((1 - x) ** 2 / bending + 1 / shear, x), rel=1e-6)
    assert read_model_file(tmp_path / "model.toml").model.beams[0].section.kinks == (0.0, 1.0)


LAWS = {
    'kind = "elastic-plastic", yield_stress = 2.5e8, hardening = 1e9': bf.ElasticPlastic(2e11, 2.5e8, 0.3, 7800.0, 1e9),
    'kind = "ramberg-osgood", proof_stress = 2e8, exponent = 7': bf.RambergOsgood(2e11, 2e8, 7.0, 0.3, 7800.0),
    'kind = "maxwell", branches = [[0.3, 0.01], [0.2, 1]]': bf.Maxwell(2e11, [(0.3, 0.01), (0.2, 1.0)], 0.3, 7800.0),
}


@pytest.mark.parametrize(("keys", "law"), LAWS.items(), ids=lambda item: type(item).__name__)
def test_sections_of_fibres_are_those_of_python(keys, law, tmp_path):
    text = f"""
    [beams.bar]
    curve = {{ kind = "line", start = [0, 0], end = [1, 0] }}
    elements = 2
    element = {{ kind = "CRBF", order = 3 }}
    section.kind = "fibres"
    section.shape = {{ kind = "tube", diameter = 0.02, thickness = 0.002 }}
    section.law = {{ {keys}, youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7800 }}
    section.points = 12
    [[supports]]
    kind = "clamp"
    points = ["bar.start"]
    [analysis]
    kind = "static"
    """
    (tmp_path / "a.toml").write_text(text)
    (beam,) = read_model_file(tmp_path / "a.toml").model.beams
    assert beam.section == bf.Fibres(bf.Tube(0.02, 0.002), law, 12)


@pytest.mark.parametrize(
    ("keys", "section"),
    [
        ('{ kind = "profile", name = "UPN 200", weak = true }', bf.Profile("UPN 200", weak=True)),
        ('{ kind = "polygon", corners = [[0, 0], [1, 0, 0.1], [0, 1]] }', bf.Polygon([(0, 0), (1, 0, 0.1), (0, 1)])),
    ],
)
def test_profiles_and_polygons_in_a_model_file(tmp_path, keys, section):
    text = f"""
    [materials.steel]
    youngs_modulus = 2e11
    poisson_ratio = 0.3
    density = 7800
    [beams.bar]
    curve = {{ kind = "line", start = [0, 0], end = [1, 0] }}
    elements = 2
    element = {{ kind = "CRBF", order = 3 }}
    material = "steel"
    section = {keys}
    [[supports]]
    kind = "clamp"
    points = ["bar.start"]
    [analysis]
    kind = "static"
    """
    (tmp_path / "a.toml").write_text(text)
    (beam,) = read_model_file(tmp_path / "a.toml").model.beams
    assert beam.section == section


def test_parts_by_name_and_in_place_are_those_of_python(tmp_path):
    text = """
    [materials.steel]
    youngs_modulus = 2e11
    poisson_ratio = 0.3
    density = 7800
    [beams.hook]
    elements = { kind = "graded", elements = 4, ratio = 2 }
    element = { kind = "ANCFCRBF", forces = { kind = "continuum", plane_stress = true }, integration = "reduced" }
    section.kind = "layered"
    section.width = 0.1
    section.layers = [{ material = "steel", thickness = 0.01 }, { material = "steel", thickness = 0.02 }]
    curve.kind = "chain"
    curve.curves = [
      { kind = "line", start = [0, 0], end = [1, 0] },
      { kind = "arc", center = [1, 0.5], radius = 0.5, start_angle = -1.5707963267948966, end_angle = 0 },
    ]
    [[supports]]
    kind = "clamp"
    points = ["hook.start", "hook.at(0.5)"]
    [analysis]
    kind = "static"
    newton = { tolerance = 1e-9 }
    """
    (tmp_path / "a.toml").write_text(text)
    job = read_model_file(tmp_path / "a.toml")
    (beam,) = job.model.beams
    assert beam.element.forces == bf.ContinuumMechanics(plane_stress=True)
    assert beam.element.integration == "reduced"
    assert beam.curve.length == pytest.approx(1.0 + np.pi / 4)
    assert beam.section.height == pytest.approx(0.03)
    assert np.diff(beam.elements).max() / np.diff(beam.elements).min() == pytest.approx(2.0)
    assert [support.point.fraction for support in job.model.supports] == [0.0, 0.5]
    assert job.analysis.keys == {"newton": bf.Newton(tolerance=1e-9)}


def test_quantities_are_those_of_python(tmp_path):
    at_point = ["x", "vy", "shear_angle", "strain_xx", "stress_xy", "rotation"]
    of_beam, of_model = ["moment", "shear_stress", "von_mises"], ["kinetic", "py", "angular_momentum"]
    outputs = [("arm.at(0.3)", at_point), (None, of_beam), ("", of_model)]
    text = ARM + MOTION
    for place, names in outputs:
        where = f'point = "{place}"\n' if place else 'beam = "arm"\n' if place is None else ""
        text += f'[[outputs]]\n{where}quantities = {json.dumps(names)}\nat = "all"\n'
    (tmp_path / "a.toml").write_text(text)
    job = read_model_file(tmp_path / "a.toml")
    solution = job.solve().solution
    beam = solution.model.beams[0]
    point, fields = beam.at(0.3), solution.fields(beam.at(0.3))
    expected = [
        [solution.position(point)[:, 0], solution.velocity(point)[:, 1], fields.shear_angle,
         fields.green_strain.xx, fields.stress.xy, solution.rotation(point)],
        [solution.section_forces(beam).moment, solution.stresses(beam).shear, solution.stresses(beam).von_mises],
        [solution.energy().kinetic, solution.linear_momentum()[:, 1], solution.angular_momentum()],
    ]  # fmt: skip
    for output, columns in zip(job.outputs, expected, strict=True):
        rows = output.rows(solution)
        for name, column in zip(output.quantities, columns, strict=True):
            np.testing.assert_array_equal([row[name] for row in rows], column)


def test_the_same_results_as_python_saves(tmp_path):
    run(ARM, tmp_path, "--out", str(tmp_path / "a.h5"))
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 100))])
    np.testing.assert_array_equal(bf.load(tmp_path / "a.h5").p, bf.solve_static(model).p)


@pytest.mark.parametrize("steps", [4, 10])
def test_steps_of_a_static_analysis_are_rows(steps, tmp_path):
    run(f'{ARM}\n[analysis]\nkind = "static"\nsteps = {steps}\n', tmp_path, "--out", str(tmp_path / "a.h5"))
    np.testing.assert_allclose(bf.load(tmp_path / "a.h5").load_factor, np.linspace(0, 1, steps + 1), atol=1e-12)


DRIVEN = """
[beams.tip]
curve = { kind = "line", start = [1, 0], end = [1.5, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.01, height = 0.01 }
material = "steel"
[[joints]]
kind = "hinge"
a = "arm.end"
b = "tip.start"
[[loads]]
kind = "motor"
at = ["arm.end", "tip.start"]
speed = { kind = "sine", frequency = 2 }
[[supports]]
kind = "roller"
point = "tip.end"
"""


def test_motors_in_hinges_and_at_points(tmp_path):
    file = tmp_path / "motor.toml"
    file.write_text(ARM + DRIVEN + '[analysis]\nkind = "dynamics"\nduration = 0.1\nstep = 1e-3\n')
    assert CliRunner().invoke(app, ["run", str(file), "--out", str(tmp_path / "a.h5"), "--quiet"]).exit_code == 0
    motion = bf.load(tmp_path / "a.h5")
    arm, tip = motion.model.beams
    turn = motion.rotation(tip.start) - motion.rotation(arm.end)
    assert turn == pytest.approx((1 - np.cos(4 * np.pi * motion.time)) / (4 * np.pi), abs=1e-6)
    told = CliRunner().invoke(app, ["info", str(tmp_path / "a.h5"), "--json"]).stdout
    assert json.loads(told)["model"]["loads"][1] == "Motor: at Hinge: a arm.end, b tip.start, speed a function rad/s"
    file.write_text((ARM + DRIVEN).replace('["arm.end", "tip.start"]', '"tip.end"').replace("speed", "torque"))
    model = read_model_file(file).model
    assert model.loads[1].at == model.beams[1].end
    file.write_text((ARM + DRIVEN).replace('["arm.end", "tip.start"]', '["arm.end"]'))
    with pytest.raises(ModelFileError, match="must be a point, or the two points of a hinge"):
        read_model_file(file)


@pytest.mark.parametrize("keys", [{}, {"accuracy": 1e-6}, {"accuracy": 1e-6, "at": [0.5, 1.0]}])
@pytest.mark.parametrize("asked", [(), (0.37,)])
def test_static_analyses_of_files_refine_meshes_left_to_them(keys, asked):
    found = []
    for mesh in ({}, {"elements": 12, "element": bf.CRBF(8)}):
        steel = bf.Material(2e11, 0.3, 7800.0)
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=bf.Rectangle(0.02, 0.01), material=steel, **mesh)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 5e4))])
        solution = Analysis("static", keys if not mesh else {}).run(model, asked).solution
        assert all(np.any(solution.at == load_factor) for load_factor in asked)
        assert mesh or solution.error() < 1e-4
        found.append(solution.displacement(beam.end)[-1])
    assert np.linalg.norm(found[0] - found[1]) < 1e-4


def test_bodies_of_model_files(tmp_path):
    (tmp_path / "a.toml").write_text(
        """
[materials.steel]
youngs_modulus = 2.1e11
poisson_ratio = 0.3
density = 7850.0

[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.01, height = 0.01 }
material = "steel"

[bodies.head]
point = "arm.end"
mass = 2.0
inertia = 0.01
offset = [0.2, 0.1]

[[supports]]
kind = "clamp"
point = "arm.start"

[[supports]]
kind = "roller"
point = "head.at(0.2, -0.1)"

[[loads]]
kind = "force"
point = "head.at(0.2, -0.1)"
vector = [10, 0]
"""
    )
    job = read_model_file(tmp_path / "a.toml")
    assert (len(job.model.beams), len(job.model.masses)) == (2, 1)
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), steel)
    body = bf.RigidBody(beam.end, 2.0, 0.01, offset=(0.2, 0.1))
    place = body.at(0.2, -0.1)
    supports = [bf.Clamp(beam.start), bf.Roller(place)]
    solution = bf.solve_static(bf.Model([beam], supports, [bf.PointForce(place, (10.0, 0.0))], masses=[body]))
    assert bf.solve_static(job.model).p[-1] == pytest.approx(solution.p[-1], abs=1e-14)
    for wrong, message in (
        ("hed.at(0.2, -0.1)", "there is no body 'hed' with points at .*did you mean head"),
        ("head.at(0.2)", r"must be a point of a body such as .head.at\(0, 0.1\)"),
        ("head.end", r"must be a point of a body such as .head.at\(0, 0.1\)"),
    ):
        file = tmp_path / "b.toml"
        file.write_text((tmp_path / "a.toml").read_text().replace("head.at(0.2, -0.1)", wrong))
        with pytest.raises(bf.InputError, match=message):
            read_model_file(file)


def test_floating_bodies_of_model_files(tmp_path):
    """A body of two beams; what acts on its interfaces acts on the body."""
    head, arm = ARM.partition("[[supports]]")[0], ARM.partition("[[supports]]")[2]
    tip = head.partition("[beams.arm]")[2].replace("[0, 0], end = [1, 0]", "[1, 0], end = [1.5, 0]")
    body = """[bodies.wing]
kind = "floating-body"
beams = ["arm", "tip"]
joints = [["arm.end", "tip.start"]]
interfaces = ["arm.start", "tip.end"]
modes = 2
"""
    output = '[[outputs]]\npoint = "tip.end"\nquantities = ["uy"]\n'
    file, whole = tmp_path / "a.toml", f"{head}[beams.tip]{tip}{body}[[supports]]{arm.replace('arm.end', 'tip.end')}"
    file.write_text(f"{whole}{output}")
    job = read_model_file(file)
    steel, square = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    beams = [bf.Beam(bf.Line((x, 0), (y, 0)), 4, bf.CRBF(3), square, steel) for x, y in ((0, 1), (1, 1.5))]
    frame, ends = bf.Model(beams, joints=[bf.Rigid(beams[0].end, beams[1].start)]), (beams[0].start, beams[1].end)
    wing = bf.reduce(frame, ends, 2).floating_body()
    root, end = wing.points
    assert job.model.masses[0].numbers == pytest.approx(wing.numbers, rel=1e-12)
    expected = bf.solve_static(bf.Model([], [bf.Clamp(root)], [bf.PointForce(end, (0.0, 100.0))], masses=[wing]))
    found = job.outputs[0].rows(job.solve().solution)[-1]["uy"]
    assert found == pytest.approx(expected.displacement(end)[-1, 1], rel=1e-12)
    file.write_text(whole.replace('"tip.end"\nvector', '"tip.at(0.5)"\nvector'))
    with pytest.raises(bf.InputError, match=r"a.toml:\d+: loads\[1\].point: the beam 'tip' is part of a floating body"):
        read_model_file(file)


def test_redundant_links_of_a_file_are_solved_on_request(tmp_path):
    other = (
        ARM.partition("[beams.arm]")[2].replace("arm", "leg").replace("[0, 0], end = [1, 0]", "[0, 1], end = [1, 1]")
    )
    link = '[[connectors]]\nkind = "link"\na = "arm.end"\nb = "leg.end"\n'
    file = tmp_path / "links.toml"
    file.write_text(f"{ARM}[beams.leg]{other}{2 * link}")
    with pytest.raises(bf.InputError, match=r"link. at .* are redundant"):
        read_model_file(file).solve()
    file.write_text('redundant_conditions = "least_norm"\n' + file.read_text())
    job = read_model_file(file)
    one, two = (job.solve().solution.multipliers(tie)[-1, 0] for tie in job.model.connectors)
    assert one == pytest.approx(two, rel=1e-9)


def test_a_table_of_a_file_is_the_law_of_a_spring(tmp_path):
    file = tmp_path / "spring.toml"
    table = '{ kind = "table", points = [[-1.0, -4e3], [0.0, 0.0], [1.0, 4e3]] }'
    found = []
    for stiffness in (table, "4e3"):
        spring = f'[[connectors]]\nkind = "spring-damper"\na = "arm.end"\nb = [1.0, 1.0]\nstiffness = {stiffness}\n'
        file.write_text(ARM + spring)
        found.append(read_model_file(file).solve().solution.p[-1])
    assert found[0] == pytest.approx(found[1], abs=1e-10)
