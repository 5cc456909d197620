"""Python beside a model file: connectors, sections, curves, functions and integrators of the user's."""

import numpy as np
import pytest
from model_file_pairs import ARM, LIFT, STEEL, arm, held, require_same
from test_cli import invoke
from test_model_file_alike import require_refused

import beamfem as bf
from beamfem.cli.modelfile import read_model_file

OWN = """from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from connectors import RigidLink, SpringDamper
from integrators import Radau
from section_laws import RambergOsgood

import beamfem as bf


@dataclass(frozen=True)
class Several:
    points: tuple[bf.Point, ...]
    stiffness: float
    unknowns = 0
    conservative = True

    def force(self, at):
        return (self.stiffness * (at.q - at.reference)).ravel()

    def energy(self, at):
        return 0.0, 0.5 * self.stiffness * float(((at.q - at.reference) ** 2).sum())


@dataclass(frozen=True)
class Gust:
    strength: float
    course: Callable[[float], float] | None = None

    def __call__(self, time):
        return self.strength * (time**2 if self.course is None else self.course(time))


class Flow:
    def __call__(self, arc_length):
        return 0.0, -100.0 * arc_length


@dataclass(frozen=True)
class Taper:
    width: float

    def __call__(self, arc_length):
        return bf.Rectangle(self.width, 0.01 - 0.002 * arc_length)


def sandwich(face: bf.Material, core: bf.Material, sizes: tuple[float, float]):
    return bf.Layered([bf.Layer(face, sizes[0]), bf.Layer(core, sizes[1]), bf.Layer(face, sizes[0])], 0.01)


def spiral(u):
    return np.array([np.sin(u), 1.0 - np.cos(u)]).T * (1 + 0.1 * np.array([u, u]).T)


def hump(arc_length):
    return 0.01 if arc_length < 0.5 else 0.008


def spin(position):
    return -2.0 * position[1], 2.0 * position[0]


def bent(state):
    return bool(state.displacement(state.model.beams[0].end)[1] > 0.3)


def broken(size: float):
    return 1 / 0
"""


@pytest.fixture
def file(tmp_path):
    """Return a place for a model file beside `own.py`."""
    (tmp_path / "own.py").write_text(OWN)
    return tmp_path / "a.toml"


CODE = 'code = "own.py"\n'
FLAT = 'section = { kind = "rectangle", width = 0.01, height = 0.01 }'
LINE = '{ kind = "line", start = [0, 0], end = [1, 0] }'


def solved(file, text):
    """Return what the analysis of a text finds, its model, and the module that it names."""
    file.write_text(CODE + text)
    job = read_model_file(file)
    return job, job.solve(), job.root.source.code.module


CONNECTORS = """
[connectors.strut]
class = "SpringDamper"
a = "arm.at(0.25)"
b = "arm.end"
stiffness = 1000.0
[connectors.bed]
class = "Several"
points = ["arm.at(0.5)", "arm.end"]
stiffness = 50
[[outputs]]
connector = "bed"
quantities = ["fx", "fy", "m"]
"""


def test_connectors(file):
    job, found, own = solved(file, ARM + LIFT + CONNECTORS)
    beam = arm()
    strut, bed = own.SpringDamper(beam.at(0.25), beam.end, 1000.0), own.Several((beam.at(0.5), beam.end), 50)
    expected = bf.solve_static(held(beam, connectors=[strut, bed]))
    require_same(found.solution, expected)
    (row,) = job.outputs[0].rows(found.solution)
    assert row["point"] == [1, 2]
    np.testing.assert_array_equal([row[name] for name in ("fx", "fy", "m")], expected.connector_force(bed)[-1].T)


def test_multipliers_of_a_connector(file):
    link = """[connectors.link]
class = "RigidLink"
a = "arm.at(0.25)"
b = "arm.end"
[analysis]
kind = "dynamics"
duration = 0.01
step = 1e-3
[[outputs]]
connector = "link"
quantities = ["multiplier"]
at = "all"
"""
    job, found, own = solved(file, ARM + LIFT.replace("vector", "scale = false\nvector") + link)
    beam = arm()
    link = own.RigidLink(beam.at(0.25), beam.end)
    model = held(beam, [bf.PointForce(beam.end, (0, 100), scale=False)], connectors=[link])
    expected = bf.simulate(model, 0.01, 1e-3)
    require_same(found.solution, expected)
    rows = job.outputs[0].rows(found.solution)
    np.testing.assert_array_equal([row["multiplier"] for row in rows], expected.multipliers(link))


def test_a_crooked_model_keeps_its_connectors(file):
    crooked = '[imperfection]\nsize = 0.01\nof = "modes"\n'
    file.write_text(CODE + ARM + LIFT + CONNECTORS + crooked)
    job = read_model_file(file).imperfect()
    assert job.outputs[0].connector is job.model.connectors[1]
    assert len(job.outputs[0].rows(job.solve().solution)[0]["fy"]) == 2


def test_a_section_with_a_law(file):
    law = "axial = 2e7, shear = 6e6, bending = 166.0, mass = 0.78, rotary_inertia = 6.5e-6, knee = 60.0"
    text = ARM.replace(FLAT, f'section = {{ class = "RambergOsgood", {law} }}').replace('material = "steel"\n', "")
    _, found, own = solved(file, text + LIFT)
    section = own.RambergOsgood(2e7, 6e6, 166.0, 0.78, 6.5e-6, knee=60.0)
    require_same(found.solution, bf.solve_static(held(arm(section=section, material=None))))


def test_sections_of_the_arc_length_and_of_materials_by_name(file):
    _, found, own = solved(file, ARM.replace(FLAT, 'section = { class = "Taper", width = 0.02 }') + LIFT)
    require_same(found.solution, bf.solve_static(held(arm(section=own.Taper(0.02)))))
    foam = "{ youngs_modulus = 1e9, poisson_ratio = 0.2, density = 60 }"
    sandwich = f'section = {{ class = "sandwich", face = "steel", core = {foam}, sizes = [0.001, 0.008] }}'
    text = ARM.replace(FLAT, sandwich).replace('material = "steel"\n[[', "[[")
    _, found, own = solved(file, text + LIFT)
    section = own.sandwich(STEEL, bf.Material(1e9, 0.2, 60), (0.001, 0.008))
    require_same(found.solution, bf.solve_static(held(arm(section=section, material=None))))


def test_parametric_curves(file):
    spiral = '{ kind = "parametric", function = "spiral", start = 0, end = 2.0 }'
    _, found, own = solved(file, ARM.replace(LINE, spiral) + LIFT)
    require_same(found.solution, bf.solve_static(held(arm(curve=bf.Parametric(own.spiral, 0, 2.0)))))


def test_functions(file):
    text = """
[functions.gust]
class = "Gust"
strength = 2.0
course = { kind = "smooth-ramp", duration = 0.5 }
[functions.hump]
kind = "piecewise"
function = "hump"
kinks = [0.5]
[[loads]]
kind = "distributed"
beam = "arm"
vector = { class = "Flow" }
amplitude = "gust"
"""
    section = 'section = { kind = "rectangle", width = 0.01, height = "hump" }'
    job, found, own = solved(file, ARM.replace(FLAT, section) + text)
    hump = bf.Piecewise(lambda s: bf.Rectangle(0.01, own.hump(s)), [0.5])
    beam = arm(section=hump)
    gust = job.model.loads[0].amplitude
    assert (gust.strength, gust(0.25)) == (2.0, 1.0)
    expected = bf.solve_static(held(beam, [bf.DistributedLoad(beam, own.Flow(), gust)]))
    require_same(found.solution, expected)


def test_motions_by_code(file):
    text = """[analysis]
kind = "dynamics"
duration = 0.01
step = 1e-3
velocity = { function = "spin" }
integrator = { class = "Radau" }
"""
    free = ARM.split("[[supports]]")[0]
    _, found, own = solved(file, free + text)
    require_same(found.solution, bf.simulate(bf.Model([arm()]), 0.01, 1e-3, own.Radau(), velocity=own.spin))


def test_paths_that_end_by_code(file):
    _, found, own = solved(file, ARM + LIFT + '[analysis]\nkind = "path"\nuntil = { function = "bent" }\n')
    require_same(found.solution, bf.trace_equilibrium(held(arm()), own.bent))


def test_a_sweep_runs_code_once(file):
    (file.parent / "own.py").write_text(OWN + '\nwith open(__file__ + ".runs", "a") as runs:\n    runs.write("x")\n')
    out = '[[outputs]]\nname = "tip"\npoint = "arm.end"\nquantities = ["uy"]\n'
    sweep = '[[sweep]]\nkey = "connectors.strut.stiffness"\nvalues = [0.0, 1000.0]\n'
    file.write_text(CODE + ARM + LIFT + CONNECTORS.split("[[")[0] + out + sweep)
    done = invoke("run", file, "--json")
    assert done.exit_code == 0, done.stderr
    assert (file.parent / "own.py.runs").read_text() == "x"


def test_what_cannot_be_saved_is_refused_before_the_solve(file, monkeypatch):
    file.write_text(CODE + ARM + LIFT + CONNECTORS)
    monkeypatch.setattr("beamfem.cli.modelfile.read.Job.solve", None)
    done = invoke("run", file, "--out", file.with_suffix(".h5"))
    assert done.exit_code == 2
    assert "a SpringDamper cannot be saved" in done.stderr
    require_refused(
        file,
        CODE + ARM + LIFT + CONNECTORS + '[[files]]\nkind = "results"\nfile = "a.h5"\n',
        "files[1]",
        "cannot be saved",
    )


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
def test_a_mistake_is_named(case, file):
    (file.parent / "wrong.py").write_text("import beamfem\nx + 1\n")
    (file.parent / "odd.py").write_text("class\n")
    (file.parent / "needs.py").write_text("import nowhere\n")
    for name in ("json", "numpy"):
        (file.parent / f"{name}.py").write_text("raise SystemExit\n")
    text, key, words = MISTAKES[case]
    require_refused(file, text, key, words)
