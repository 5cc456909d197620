"""Python beside a model file that is not what it should be: refused with line, key and what would be right."""

import pytest
from model_file_code import CODE, CONNECTORS, FLAT, LINE, OWN
from model_file_pairs import ARM
from test_model_file_alike import require_refused

# what the file is, the key and words of its error
MISTAKES = {
    "no code": (ARM + CONNECTORS, "connectors.strut.class", 'at the top: code = "FILE.py"'),
    "no file": ('code = "owl.py"\n' + ARM, "code", "there is no owl.py in"),
    "other folder": ('code = "../own.py"\n' + ARM, "code", "must be the name of a Python file beside"),
    "no Python": ('code = "own"\n' + ARM, "code", 'such as "parts.py"'),
    "code of a number": ("code = 3\n" + ARM, "code", "must be a text"),
    "name of a module": ('code = "json.py"\n' + ARM, "code", "has the name of an installed module"),
    "name of a package": ('code = "numpy.py"\n' + ARM, "code", "has the name of an installed module"),
    "mistake in code": ('code = "wrong.py"\n' + ARM, "code", "wrong.py cannot be run: line 2: NameError: name 'x'"),
    "no Python inside": ('code = "odd.py"\n' + ARM, "code", "odd.py cannot be run: SyntaxError"),
    "needs a package": ('code = "needs.py"\n' + ARM, "code", "line 1: ModuleNotFoundError: No module named 'nowhere'"),
    "unknown class": (
        CODE + ARM + CONNECTORS.replace("Several", "Sevral"),
        "connectors.bed.class",
        "own.py has no class or function 'Sevral'; did you mean Several?",
    ),
    "no class": (CODE + ARM + CONNECTORS.replace('class = "Several"', ""), "connectors.bed", "class is missing"),
    "kind in place of class": (
        CODE + ARM + CONNECTORS.replace('class = "Several"', 'kind = "Several"'),
        "connectors.bed",
        "the key class is missing",
    ),
    "unknown key": (
        CODE + ARM + CONNECTORS.replace("stiffness = 50", "stifness = 50"),
        "connectors.bed.stifness",
        "did you mean stiffness",
    ),
    "missing key": (
        CODE + ARM + CONNECTORS.replace("stiffness = 50", ""),
        "connectors.bed",
        "the key stiffness is missing; needed are points, stiffness",
    ),
    "unknown point": (
        CODE + ARM + CONNECTORS.replace('"arm.at(0.5)"', '"leg.end"'),
        "connectors.bed.points[1]",
        "there is no beam 'leg'",
    ),
    "one point for a list": (
        CODE + ARM + CONNECTORS.replace('["arm.at(0.5)", "arm.end"]', '"arm.end"'),
        "connectors.bed.points",
        "must be an array",
    ),
    "a point twice": (
        CODE + ARM + CONNECTORS.replace('"arm.at(0.5)"', '"arm.end"'),
        "connectors.bed",
        "Several lists a point twice",
    ),
    "number of words": (
        CODE + ARM + CONNECTORS.replace("stiffness = 50", 'stiffness = "soft"'),
        "connectors.bed.stiffness",
        'must be a number, got the text "soft"',
    ),
    "no connector": (CODE + ARM + "[connectors.a]\nclass = 'hump'\narc_length = 0.1", "connectors.a", "cannot hold"),
    "class that fails": (
        CODE + ARM + "[connectors.a]\nclass = 'broken'\nsize = 0.1",
        "connectors.a",
        "broken cannot be made: ZeroDivisionError: division by zero",
    ),
    "connectors without names": (
        CODE + ARM + "[[connectors]]\nclass = 'Several'",
        "connectors",
        "must be tables with a name, each headed [connectors.NAME]",
    ),
    "types that are lost": (
        CODE + ARM + "[connectors.a]\nclass = 'lost'\npoint = 'arm.end'",
        "connectors.a.class",
        "the parameters of lost cannot be read: name 'Nowhere' is not defined",
    ),
    "unknown connector": (
        CODE + ARM + CONNECTORS.replace('connector = "bed"', 'connector = "bad"'),
        "outputs[1].connector",
        "did you mean bed",
    ),
    "quantity of a connector": (
        CODE + ARM + CONNECTORS.replace('"fx"', '"ux"'),
        "outputs[1].quantities",
        "known are fx, fy, m, multiplier of a connector",
    ),
    "multipliers beside forces": (
        CODE + ARM + CONNECTORS.replace('"fx"', '"multiplier"'),
        "outputs[1].quantities",
        "in another output",
    ),
    "no section": (CODE + ARM.replace(FLAT, 'section = { class = "Flow" }'), "beams.arm.section", "must be a section"),
    "unknown function": (
        CODE + ARM.replace(LINE, '{ kind = "parametric", function = "spirl", start = 0, end = 1 }'),
        "beams.arm.curve.function",
        "did you mean spiral",
    ),
    "velocity by what is none": (
        CODE + ARM + '[analysis]\nkind = "dynamics"\nduration = 1\nstep = 0.1\nvelocity = { function = "spinn" }\n',
        "analysis.velocity.function",
        "did you mean spin",
    ),
    "integrator that is none": (
        CODE + ARM + '[analysis]\nkind = "dynamics"\nduration = 1\nstep = 0.1\nintegrator = { class = "Flow" }\n',
        "analysis.integrator",
        "step(motion, begin, end)",
    ),
    "integrator and its number": (
        CODE
        + ARM
        + '[analysis]\nkind = "dynamics"\nduration = 1\nstep = 0.1\nrho_inf = 1.0\nintegrator = { class = "Radau" }\n',
        "analysis.integrator",
        "rho_inf are given",
    ),
    "until besides a function": (
        CODE + ARM + '[analysis]\nkind = "path"\nuntil = { function = "bent", above = 1.0 }\n',
        "analysis.until.above",
        "unknown key",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_named(case, tmp_path):
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "wrong.py").write_text("import beamfem\nx + 1\n")
    (tmp_path / "odd.py").write_text("class\n")
    (tmp_path / "needs.py").write_text("import nowhere\n")
    for name in ("json", "numpy"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit\n")
    text, key, words = MISTAKES[case]
    require_refused(tmp_path / "a.toml", text, key, words)
