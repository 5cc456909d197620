"""Loads that vary along a beam: closed forms, kinks, what makes no sense, model files and results files."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.cli.model_file import ModelFileError, read_model_file

STIFF = bf.Section.from_stiffness(1e9, 1e9, 1e3, 1.0, 1.0)


def spread(load, element=None, elements=5):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element or bf.CRBF(2), STIFF)
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [load(beam)])
    return beam, bf.solve_static(model)


def test_a_triangular_load_bends_a_simple_beam():
    """q x / L: reactions q L / 6 and q L / 3, M(x) = q (L x - x^3 / L) / 6."""
    beam, solution = spread(lambda b: bf.DistributedLoad(b, lambda s: (0.0, -0.1 * s)), bf.CRBF(4))
    assert solution.reaction(beam.start)[-1, 1] == pytest.approx(0.1 / 6, rel=1e-7)
    assert solution.reaction(beam.end)[-1, 1] == pytest.approx(0.1 / 3, rel=1e-7)
    sag = solution.displacement(beam.at(0.5))[-1, 1]
    assert sag == pytest.approx(-0.1 * 5 / 768 / 1e3 - 0.1 / 16 / 1e9, rel=1e-7)


def test_a_load_on_a_part_of_a_beam_ends_where_it_says():
    """q on the first a of a simple beam: reaction q a^2 / 2 at the far end, rotation q a^2 (2 - a^2) / 24 EI there."""
    a, q = 0.37, 0.1
    for function in (lambda s: (0.0, -q if s < a else 0.0), bf.Piecewise(lambda s: (0.0, -q * (s < a)), [a])):
        beam, solution = spread(lambda b, f=function: bf.DistributedLoad(b, f))
        assert np.abs(solution.model.meshes[0].vertices - a).min() < 1e-11
        assert solution.reaction(beam.end)[-1, 1] == pytest.approx(q * a**2 / 2, rel=1e-8)
        assert solution.rotation(beam.end)[-1] == pytest.approx(q * a**2 * (2 - a**2) / 24 / 1e3, rel=1e-6)


def test_a_table_of_pressures_ends_elements_at_its_points():
    table = bf.Interpolated([(0.0, 0.0), (0.25, 4.0), (1.0, 1.0)])
    beam, solution = spread(lambda b: bf.Pressure(b, table), elements=2)
    assert solution.model.meshes[0].vertices == pytest.approx([0.0, 0.25, 0.5, 1.0])
    total = 0.25 * 2.0 + 0.75 * 2.5
    assert solution.reaction(beam.start)[-1, 1] + solution.reaction(beam.end)[-1, 1] == pytest.approx(-total, rel=1e-4)


def test_the_potential_of_a_load_that_varies_is_minus_its_work():
    """Linear statics: the work of loads that grow slowly is half of the load times its way, the strain energy."""
    _, solution = spread(lambda b: bf.DistributedLoad(b, lambda s: (0.0, -1e-3 * np.sin(np.pi * s))))
    energy = solution.energy()
    assert energy.potential[-1] == pytest.approx(-2.0 * energy.strain[-1], rel=1e-6)


BAD = {
    "text": (lambda b: bf.Pressure(b, "high"), "value of Pressure must be a number"),
    "a pair": (lambda b: bf.Pressure(b, (0.0, 1.0)), "value of Pressure must be a number"),
    "no pair": (
        lambda b: bf.DistributedLoad(b, lambda s: s),
        "vector of DistributedLoad at arc length 0 must be two",
    ),
    "not finite": (lambda b: bf.Pressure(b, lambda s: 1.0 / s if s else np.inf), "at arc length 0 must be finite"),
    "two arguments": (lambda b: bf.Pressure(b, lambda x, y: 1.0), "function of arc length alone"),
    "a point": (lambda b: bf.Pressure(b.end, lambda s: 1.0), "beam of Pressure must be a Beam"),
}


@pytest.mark.parametrize("name", BAD)
def test_loads_along_a_beam_that_make_no_sense_are_refused(name):
    make, message = BAD[name]
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), STIFF)
    with pytest.raises(bf.InputError, match=message):
        make(beam)


def test_results_with_pressures_and_varying_loads_come_back_from_a_file(tmp_path):
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2.0), 4, bf.CRBF(3), STIFF)
    loads = [
        bf.Pressure(beam, 30.0),
        bf.Pressure(beam, lambda s: 10.0 * s if s < 0.7 else 3.0),
        bf.Pressure(beam, bf.Interpolated([(0.0, 1.0), (0.9, 4.0), (2.0, 2.0)])),
        bf.DistributedLoad(beam, lambda s: (np.sin(s), -4.0), follower=True),
        bf.DistributedLoad(beam, lambda s: (1.0, s**2), amplitude=lambda factor: factor**2),
    ]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    solution.save(tmp_path / "pressed.h5")
    loaded = bf.load(tmp_path / "pressed.h5")
    assert np.array_equal(loaded.p, solution.p)
    assert loaded.energy().potential == pytest.approx(solution.energy().potential, rel=1e-12)
    assert loaded.reaction(loaded.model.beams[0].start) == pytest.approx(solution.reaction(beam.start), abs=1e-9)
    for own, others in zip(solution.model.loads, loaded.model.loads, strict=True):
        at = np.linspace(0.0, 2.0, 9)
        assert others.values(at) == pytest.approx(own.values(at), abs=1e-9)


MODEL_FILE = """
[materials.steel]
youngs_modulus = 1e12
poisson_ratio = 0.3
density = 1.0

[sections.bar]
kind = "rectangle"
width = 0.1
height = 0.1

[functions.water]
kind = "table"
points = [[0.0, 30.0], [1.0, 0.0]]

[beams.wall]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = "bar"
material = "steel"

[[supports]]
kind = "clamp"
point = "wall.start"

[[loads]]
kind = "pressure"
beam = "wall"
value = LOAD

[[loads]]
kind = "distributed"
beam = "wall"
vector = [1.0, { kind = "table", points = [[0.0, 0.0], [0.25, -8.0], [1.0, -2.0]] }]
"""


@pytest.mark.parametrize(("load", "force"), [('"water"', 15.0), ("40.0", 40.0)])
def test_pressures_and_functions_of_the_arc_length_in_a_model_file(load, force, tmp_path):
    """Reactions are what the tables hold: 1 N along x, and -(1 + 3.75) N less the pressure across.

    A sag of 5e-7 m turns 2e-5 N of the pressure along x.
    """
    path = tmp_path / "wall.toml"
    path.write_text(MODEL_FILE.replace("LOAD", load))
    model = read_model_file(path).model
    solution = bf.solve_static(model)
    assert solution.reaction(model.beams[0].start)[-1, :2] == pytest.approx((-1.0, 4.75 - force), rel=5e-5)
    assert model.meshes[0].elements == 4


@pytest.mark.parametrize("load", ['"wate"', '"water', "[1.0, 2.0]", "true"])
def test_a_pressure_that_makes_no_sense_is_named_in_a_model_file(load, tmp_path):
    path = tmp_path / "wall.toml"
    path.write_text(MODEL_FILE.replace("LOAD", load))
    with pytest.raises(ModelFileError, match=r"wall.toml"):
        read_model_file(path)
