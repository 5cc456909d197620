"""Python beside a model file: connectors, sections, curves, functions and integrators of the user's."""

import sys

import numpy as np
import pytest
from model_file_code import CODE, CONNECTORS, FLAT, LINE, OWN
from model_file_pairs import ARM, LIFT, STEEL, arm, held, require_same
from test_cli import invoke
from test_model_file_alike import require_refused

import beamfem as bf
from beamfem.cli.modelfile import read_model_file

LOCAL = """
def local(a: bf.Point, b: bf.Point, stiffness: float):
    class Local(SpringDamper):
        pass

    return Local(a, b, stiffness)
"""
PARTS = """
@dataclass(frozen=True)
class HalfWave(bf.LineLoad):
    beam: bf.Beam
    size: float
    axes = "plane"

    def forces(self, arc_length):
        wave = np.sin(np.pi * arc_length / self.beam.curve.length)
        return np.column_stack([np.zeros_like(wave), self.size * wave])


@dataclass(frozen=True)
class Guide(bf.PointSupport):
    point: bf.Point
    stiffness: float

    def prescribed(self):
        return {"ux": 0.0, "rotation": 0.0}

    def springs(self):
        return {"uy": self.stiffness}
"""


@pytest.fixture
def file(tmp_path):
    """Return a place for a model file beside `own.py`."""
    (tmp_path / "own.py").write_text(OWN)
    return tmp_path / "a.toml"


def solved(file, text):
    """Return what the analysis of a text finds, its model, and the module that it names."""
    file.write_text(CODE + text)
    job = read_model_file(file)
    return job, job.solve(), job.root.source.code.module


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


def test_loads_and_supports(file):
    (file.parent / "own.py").write_text(OWN + PARTS)
    parts = """[[loads]]
class = "HalfWave"
beam = "arm"
size = -20.0
[[supports]]
class = "Guide"
point = "arm.end"
stiffness = 100.0
"""
    _, found, own = solved(file, ARM + LIFT + parts)
    beam = arm()
    loads = [bf.PointForce(beam.end, (0, 100)), own.HalfWave(beam, -20.0)]
    supports = [bf.Clamp(beam.start), own.Guide(beam.end, 100.0)]
    require_same(found.solution, bf.solve_static(bf.Model([beam], supports, loads)))


def test_what_cannot_be_saved_is_refused_before_the_solve(file, monkeypatch):
    (file.parent / "own.py").write_text(OWN + LOCAL)
    file.write_text(CODE + ARM + LIFT + CONNECTORS.replace('class = "SpringDamper"', 'class = "local"'))
    monkeypatch.setattr("beamfem.cli.modelfile.read.Job.solve", None)
    done = invoke("run", file, "--out", file.with_suffix(".h5"))
    assert done.exit_code == 2
    assert "a Local cannot be saved" in done.stderr
    require_refused(
        file,
        file.read_text() + '[[files]]\nkind = "results"\nfile = "a.h5"\n',
        "files[1]",
        "cannot be saved",
    )


def test_results_are_saved_and_loaded_once_the_python_file_is_imported(file, monkeypatch):
    (file.parent / "own.py").write_text(OWN + PARTS)
    file.write_text(f'{CODE}{ARM}{LIFT}[[supports]]\nclass = "Guide"\npoint = "arm.end"\nstiffness = 100.0\n')
    path = file.with_suffix(".h5")
    assert invoke("run", file, "--out", path).exit_code == 0
    assert type(bf.load(path).model.supports[1]).__name__ == "Guide"
    monkeypatch.delitem(sys.modules, "own")
    with pytest.raises(bf.InputError, match="a Guide of the module own: import that module before loading"):
        bf.load(path)
    moving = f'[analysis]\nkind = "dynamics"\nduration = 0.01\nstep = 0.01\nstart = {{ file = "{path.name}" }}\n'
    words = "of the module own: name its Python file, or one that imports it, at the top of the model file: code = "
    require_refused(file, ARM + LIFT + moving, "analysis.start.file", words)
