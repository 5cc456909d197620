"""Model files: sweeps and curves as in Python; mistakes have file and key."""

import csv
import json

import numpy as np
import pytest
from typer.testing import CliRunner

from beamfem.cli.app import app
from beamfem.cli.modelfile import ModelFileError, read_model_file
from beamfem.cli.modelfile.sweep import solve_sweep

ARM = """
[functions.height]
kind = "table"
points = [[0, 0.02], [1, 0.01]]
[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.01, height = "height" }
material = { youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7800.0 }
[[supports]]
kind = "clamp"
point = "arm.start"
[[loads]]
kind = "force"
point = "arm.end"
vector = [0, -1e-3]
[[outputs]]
name = "tip"
point = "arm.end"
quantities = ["uy"]
"""
SWEEP = """
[[sweep]]
key = "loads[1].vector[2]"
values = [-1e-3, -2e-3]
[[sweep]]
key = "functions.height.points[2][2]"
values = [0.01, 0.015, 0.02]
"""


def run(file, *options, code=0):
    result = CliRunner().invoke(app, ["run", str(file), *map(str, options)])
    assert result.exit_code == code, result.output
    return result


def tapered_tip(end, force=1e-3, modulus=2e11, width=0.01, start=0.02):
    """Return the deflection of a cantilever whose height falls linearly, by integrals of bending and shear."""
    x = np.linspace(0.0, 1.0, 20001)
    height = start + (end - start) * x
    shear = 5 / 6 * modulus / 2.6 * width * height
    bending = modulus * width * height**3 / 12
    return -force * np.trapezoid((1 - x) ** 2 / bending + 1 / shear, x)


def test_a_sweep_has_a_row_a_combination(written, tmp_path):
    job = read_model_file(written(ARM + SWEEP))
    found = solve_sweep(job)
    assert found.shape == (2, 3)
    assert job.root.values["loads"][0]["vector"] == [0, -1e-3]  # the file stays what it is
    expected = [tapered_tip(end, force) for force in (1e-3, 2e-3) for end in (0.01, 0.015, 0.02)]
    np.testing.assert_allclose(found["tip uy"], expected, rtol=1e-5)
    table, picture = tmp_path / "table.csv", tmp_path / "picture.png"
    said = run(tmp_path / "model.toml", "--out", table, "--plot", picture).stdout
    assert "6 points, 6 computed now, 0 failed" in said
    with open(table, newline="") as file:
        assert [float(row["tip uy"]) for row in csv.DictReader(file)] == found["tip uy"].tolist()
    assert picture.stat().st_size > 1000
    points = json.loads(run(tmp_path / "model.toml", "--json").stdout)["points"]
    assert [point["tip uy"] for point in points] == found["tip uy"].tolist()


@pytest.mark.parametrize(("kind", "column"), [("buckling", "load factor"), ("modes", "frequency [Hz]")])
def test_a_sweep_of_critical_loads_or_modes_numbers_what_it_finds(written, kind, column):
    own = f'[analysis]\nkind = "{kind}"\ncount = 2\n[[sweep]]\nkey = "beams.arm.elements"\nvalues = [4, 8]\n'
    text = ARM[: ARM.index("[[outputs]]")].replace("[0, -1e-3]", "[-1.0, 0]")
    found = solve_sweep(read_model_file(written(text + own)))
    np.testing.assert_allclose(found[f"{column} 1"], found[f"{column} 1"][0], rtol=1e-3)
    assert np.all(found[f"{column} 2"] > found[f"{column} 1"])


def test_a_point_that_fails_ends_the_command_with_1_and_the_others_stand(written):
    text = ARM.replace("uy = ", "") + '[[sweep]]\nkey = "loads[1].vector"\nvalues = [[0, -1e-3], [0, 1e30]]\n'
    said = run(written(text), "--json", code=1).stdout
    result = json.loads(said)
    assert len(result["failures"]) == 1
    assert result["points"][0]["tip uy"] == pytest.approx(tapered_tip(0.01), rel=1e-6)
    assert result["points"][1]["tip uy"] is None


MISTAKES = {
    "a key that is not there": ('key = "beams.arm.order"\nvalues = [1]', "sweep[1].key", "is not in the file"),
    "no key of a file": ('key = "beams..arm"\nvalues = [1]', "sweep[1].key", "must be a key such as"),
    "no values": ('key = "beams.arm.elements"\nvalues = []', "sweep[1].values", "must be an array of the values"),
    "values missing": ('key = "beams.arm.elements"', "sweep[1]", "the key values is missing"),
    "unknown": ('keys = "beams.arm.elements"\nvalues = [1]', "sweep[1].keys", "did you mean key"),
    "a bad value": (
        'key = "beams.arm.elements"\nvalues = [1, -1]',
        "beams.arm.elements",
        "(with beams.arm.elements = -1)",
    ),
    "an output": ('key = "outputs[1].at"\nvalues = ["last"]', "sweep[1].key", "outputs cannot be varied"),
    "one in the other": (
        'key = "loads[1].vector"\nvalues = [[0, 1]]\n[[sweep]]\nkey = "loads[1].vector[1]"\nvalues = [1]',
        "sweep[2].key",
        "vary the same key",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_in_a_sweep_is_named_before_anything_is_solved(written, case):
    text, key, words = MISTAKES[case]
    with pytest.raises(ModelFileError) as caught:
        solve_sweep(read_model_file(written(f"{ARM}[[sweep]]\n{text}\n")))
    assert caught.value.key == key
    assert words in caught.value.message


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('point = "arm.end"\nquantities = ["uy"]', 'beam = "arm"\nquantities = ["moment"]', "not along a beam"),
        ('["uy"]', '["uy"]\nat = "all"', "single state"),
        (
            "[[outputs]]",
            '[[outputs]]\nname = "tip"\nquantities = ["strain"]\n[[outputs]]',
            "two outputs are called 'tip'",
        ),
    ],
)
def test_outputs_of_a_sweep_are_single_numbers_with_names(written, old, new, words):
    with pytest.raises(ModelFileError, match=words):
        solve_sweep(read_model_file(written(ARM.replace(old, new) + SWEEP)))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--out", "x.h5"), "must end in .csv"),
        (("--vtk", "x.pvd"), "--vtk is for one solution"),
        (("--colour", "moment"), "--colour is for one solution"),
        (("--plot", "x.html"), "must end in .png, .svg or .pdf"),
    ],
)
def test_files_of_one_solution_are_refused_for_a_sweep(written, options, words):
    assert words in " ".join(run(written(ARM + SWEEP), *options, code=2).stderr.split())


def test_a_sweep_over_vectors_alone_cannot_be_drawn_and_is_not_solved(written, tmp_path):
    file = written(ARM + '[[sweep]]\nkey = "loads[1].vector"\nvalues = [[0, -1e-3], [0, -2e-3]]\n')
    said = run(file, "--plot", tmp_path / "a.png", code=2)
    assert "--plot draws over a key whose values are numbers" in " ".join(said.stderr.split())
    assert not said.stdout


CURVE = """
[[curves]]
file = "curves/curve.png"
x = { point = "arm.end", quantity = "uy" }
y = "load_factor"
"""


def test_curves_are_drawn_beside_the_model_file(written, tmp_path, monkeypatch):
    file = written(ARM + CURVE)
    monkeypatch.chdir("/")
    result = json.loads(run(file, "--json").stdout)
    assert result["written"] == [str(tmp_path / "curves" / "curve.png")]
    assert (tmp_path / "curves" / "curve.png").stat().st_size > 1000


@pytest.mark.parametrize("quantity", ["moment", "stress", "fy"])
def test_a_curve_of_a_section_over_an_energy_is_drawn(written, tmp_path, quantity):
    curve = CURVE.replace('"load_factor"', '"strain"').replace("arm.end", "arm.start").replace('"uy"', f'"{quantity}"')
    run(written(ARM + curve))
    assert (tmp_path / "curves" / "curve.png").stat().st_size > 1000


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ('"load_factor"', '"time"', "curves[1].y", 'must be "load_factor" or { point'),
        ('"uy"', '"uz"', "curves[1].x.quantity", "there is no quantity 'uz' of a point"),
        ('"uy"', '"fx"', "curves[1].x.quantity", "there is no support"),
        ("curve.png", "curve.csv", "curves[1]", "must end in .png, .svg or .pdf"),
        ('y = "load_factor"', "", "curves[1]", "the key y is missing"),
        ("[[curves]]", '[analysis]\nkind = "modes"\n[[curves]]', "curves[1]", "no states to draw a curve of"),
    ],
)
def test_a_mistake_in_a_curve_is_named(written, old, new, key, words):
    text = ARM[: ARM.index("[[outputs]]")] if "modes" in new else ARM
    with pytest.raises(ModelFileError) as caught:
        read_model_file(written(text + CURVE.replace(old, new)))
    assert caught.value.key == key
    assert words in caught.value.message
