"""Model files: functions, layers, tapers and axes are what they are in Python."""

import json

import numpy as np
import pytest
from test_model_file_sweeps import ARM, run, tapered_tip
from test_model_files import run as found_by

import beamfem as bf
from beamfem.cli.modelfile import ModelFileError, functions, read_model_file


def test_functions_of_time():
    ramp = functions.SmoothRamp(2.0, 3.0, 1.0)
    assert [ramp(t) for t in (0.0, 1.0, 2.0, 3.0, 9.0)] == [0.0, 0.0, 1.5, 3.0, 3.0]
    h = 1e-4  # no jump of rate and acceleration at either end
    for t in (1.0, 3.0):
        assert (ramp(t + h) - 2 * ramp(t) + ramp(t - h)) / h**2 == pytest.approx(0.0, abs=1e-2)
    assert functions.Sine(0.5, 2.0, mean=1.0)(0.5) == pytest.approx(3.0)
    table = functions.Interpolated([(0, 0), (2, 4)])
    assert [table(t) for t in (-1, 0.5, 3)] == [0.0, 1.0, 4.0]


def test_layers_chains_continuum_and_beam_outputs(tmp_path):
    text = """
    [materials.steel]
    youngs_modulus = 2e11
    poisson_ratio = 0.3
    density = 7800
    [sections.plate]
    kind = "layered"
    width = 0.1
    layers = [{ material = "steel", thickness = 0.01 }, { material = "steel", thickness = 0.01 }]
    [beams.hook]
    elements = [0.0, 0.2, 0.5, 1.0]
    element = { kind = "ANCFCRBF", forces = { kind = "continuum", plane_stress = true }, integration = "reduced" }
    section = "plate"
    curve.kind = "chain"
    curve.curves = [
      { kind = "line", start = [0, 0], end = [1, 0] },
      { kind = "arc", center = [1, 0.5], radius = 0.5, start_angle = -1.5707963267948966, end_angle = 0 },
    ]
    [[supports]]
    kind = "clamp"
    point = "hook.start"
    [[loads]]
    kind = "force"
    point = "hook.at( 1.0 )"
    vector = [0, 10]
    [[outputs]]
    beam = "hook"
    quantities = ["moment", "normal"]
    """
    job_file = tmp_path / "job.toml"
    job_file.write_text(text)
    beam = read_model_file(job_file).beams["hook"]
    assert beam.element.forces.plane_stress
    assert beam.element.integration == "reduced"
    assert beam.curve.length == pytest.approx(1.0 + np.pi / 4)
    assert beam.section.height == pytest.approx(0.02)
    row = found_by(text, tmp_path)["outputs"][0]["rows"][0]
    assert len(row["arc_length"]) == len(row["moment"]) > 3
    # at the start the moment balances the force on its lever, shorter by what the tip has moved
    assert row["arc_length"][0] == 0.0
    assert row["moment"][0] == pytest.approx(10.0 * 1.5, rel=1e-3)


def test_a_tapered_cantilever_bends_as_the_integral_says(written):
    uy = json.loads(run(written(ARM), "--json").stdout)["outputs"][0]["rows"][0]["uy"]
    assert uy == pytest.approx(tapered_tip(0.01), rel=1e-6)


def test_a_section_may_vary_by_several_numbers_and_by_functions_in_place(written):
    text = ARM.replace("width = 0.01", 'width = { kind = "table", points = [[0, 0.01], [0.4, 0.03], [1, 0.01]] }')
    job = read_model_file(written(text))
    assert job.beams["arm"].section_at(0.2).area == pytest.approx(0.02 * 0.018)
    assert job.beams["arm"].section.kinks == (0.0, 0.4, 1.0)


def test_a_varying_section_that_no_beam_has_is_checked_too(written):
    text = ARM + '[sections.other]\nkind = "rectangle"\nwidth = -0.01\nheight = "height"\n'
    with pytest.raises(ModelFileError, match="width") as caught:
        read_model_file(written(text))
    assert caught.value.key == "sections.other.width"


def test_an_axis_may_come_from_a_drawing_or_be_an_ellipse(written, tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new()
    drawing.modelspace().add_line((0, 0), (2, 1), dxfattribs={"layer": "a"})
    for height in (0, 1):
        drawing.modelspace().add_line((0, height), (2, 2), dxfattribs={"layer": "b"})
    drawing.saveas(tmp_path / "axes.dxf")
    line = 'kind = "line", start = [0, 0], end = [1, 0]'

    def axis(keys):
        return read_model_file(written(ARM.replace(line, keys))).beams["arm"].curve

    assert axis('kind = "dxf", file = "axes.dxf", layer = "a"') == bf.Line((0, 0), (2, 1))
    assert axis('kind = "dxf", file = "axes.dxf", layer = "b", number = 2') == bf.Line((0, 1), (2, 2))
    ellipse = 'kind = "elliptic-arc", center = [0, 0], first = [2, 0], second = [0, 1], start = 0, end = 1.5'
    assert axis(ellipse) == bf.elliptic_arc((0, 0), (2, 0), (0, 1), 0, 1.5)
    for keys, words in (
        ('layer = "b"', "has 2 curves there; number, from 1 to 2, chooses one"),
        ('layer = "b", number = 3', "number is 3, but axes.dxf has 2 curves"),
        ("number = 0", "number"),
    ):
        with pytest.raises(ModelFileError, match=words):
            axis(f'kind = "dxf", file = "axes.dxf", {keys}')
    with pytest.raises(ModelFileError, match=r"there is no file .*none\.dxf") as caught:
        axis('kind = "dxf", file = "none.dxf"')
    assert caught.value.key == "beams.arm.curve.file"


COLUMN = """
[beams.column]
curve = { kind = "line", start = [0, 0], end = [0, 1] }
elements = 8
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.02, height = 0.01 }
material = { youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7800.0 }
[[supports]]
kind = "clamp"
point = "column.start"
[[loads]]
kind = "force"
point = "column.end"
vector = [0, -600]
[imperfection]
size = 1e-5
[[outputs]]
name = "top"
point = "column.end"
quantities = ["x", "ux"]
"""


def test_an_imperfection_is_that_of_python_and_grows_as_it_should(tmp_path):
    """An axis that is out of line by the first mode bends on by 1 / (1 - P / P_cr); P_cr L^2 = pi^2 EI / 4."""
    (row,) = found_by(COLUMN, tmp_path)["outputs"][0]["rows"]
    critical = np.pi**2 * 2e11 * 0.02 * 0.01**3 / 12.0 / 4.0
    assert abs(row["x"]) == pytest.approx(1e-5 / (1.0 - 600.0 / critical), rel=2e-4)
    assert abs(row["x"] - row["ux"]) == pytest.approx(1e-5, rel=1e-9)
    job = read_model_file(tmp_path / "model.toml")
    crooked = job.model.with_imperfection(bf.solve_buckling(job.model, 1), 1e-5)
    tip = bf.solve_static(crooked).position(crooked.beams[0].end)[-1, 0]
    assert tip == pytest.approx(row["x"], rel=1e-9)


def test_an_imperfection_takes_part_in_sweeps(tmp_path):
    text = COLUMN + '[[sweep]]\nkey = "imperfection.size"\nvalues = [1e-5, 2e-5]\n'
    (tmp_path / "swept.toml").write_text(text)
    rows = json.loads(run(tmp_path / "swept.toml", "--json").stdout)["points"]
    assert rows[1]["top ux"] == pytest.approx(2.0 * rows[0]["top ux"], rel=1e-3)
