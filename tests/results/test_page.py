"""The page with a slider: complete, offline, small, and right."""

import base64
import json
import re
import shutil
import subprocess

import numpy as np
import pytest
from drawn import arch, cantilever, frame, pendulum

import beamfem as bf
from beamfem.view import player


def data_of(path):
    return json.loads(re.search(r'<script id="data"[^>]*>(.*?)</script>', path.read_text(), re.S).group(1))


def positions(data):
    """Corners of the bodies (rows, points, sides, 2) [m]."""
    numbers = np.frombuffer(base64.b64decode(data["points"]), "<i2").reshape(len(data["labels"]), -1, data["sides"], 2)
    return (numbers + 0.5 * data["levels"]) / data["levels"] * data["size"] + data["low"]


@pytest.fixture(scope="module")
def falling():
    return pendulum()


def test_steps_and_positions_are_those_of_the_solution(falling, tmp_path):
    data = data_of(falling.to_html(tmp_path / "new" / "fall.html", frames=10))
    assert len(data["labels"]) == 10
    assert data["axis"] == "time [s]"
    assert data["at"][-1] == pytest.approx(falling.time[-1])
    # both faces at the end of the beam, to one of 65534 levels
    tip = positions(data)[-1, -1].mean(axis=0)
    end = falling.model.beams[0].end
    np.testing.assert_allclose(tip, falling.position(end)[-1], atol=data["size"] / data["levels"])
    assert data["moved"][-1] == pytest.approx(np.linalg.norm(falling.displacement(end)[-1]), rel=1e-4)


def test_the_curve_has_peaks_between_the_steps_shown(falling, tmp_path, monkeypatch):
    data = data_of(falling.to_html(tmp_path / "fall.html", frames=3))
    at, moved = np.array(data["curve"])
    (beam,) = falling.model.beams
    each = [np.linalg.norm(falling.displacement(beam.at(x)), axis=1) for x in np.linspace(0.0, 1.0, 100)]
    np.testing.assert_allclose(at, falling.time, rtol=1e-6)
    np.testing.assert_allclose(moved, np.max(each, axis=0), rtol=1e-5, atol=1e-12)
    monkeypatch.setattr(player, "_CURVE", 5)
    swing = bf.solve_modes(falling.model, 2).solution(1, amplitude=0.1, frames=41)
    at, moved = np.array(data_of(swing.to_html(tmp_path / "swing.html", frames=4))["curve"])
    assert len(at) < 20
    assert at[[0, -1]] == pytest.approx(swing.time[[0, -1]])
    assert max(moved) == pytest.approx(0.1, rel=0.05)


def test_fields_have_their_limits_and_units(tmp_path):
    solution = cantilever()
    data = data_of(solution.to_html(tmp_path / "bent.html"))
    fields = {field["name"]: field for field in data["fields"]}
    assert fields["moment"]["label"] == "bending moment [N m]"
    clamp = abs(solution.reaction(solution.model.beams[0].start)[-1, 2])
    assert fields["moment"]["high"] == pytest.approx(clamp, rel=1e-4)
    values = np.frombuffer(base64.b64decode(fields["moment"]["values"]), np.uint8).reshape(2, -1)
    assert values[-1, 0] == 255
    assert "speed" not in fields
    assert "speed" in {field["name"] for field in data_of(pendulum().to_html(tmp_path / "fall.html"))["fields"]}


def test_stresses_are_colours_where_sections_have_them(tmp_path):
    """A beam by its stiffness beside one of steel: what is not known is level 0."""
    steel = bf.Material(2e11, 0.3, 7800.0, strength=2e8)
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.04), steel)
    other = bf.Beam(bf.Line((1, 0), (2, 0)), 2, bf.CRBF(3), bf.Section.from_stiffness(1e8, 1e8, 1e5, 1.0, 1.0))
    joints, loads = [bf.Rigid(own.end, other.start)], [bf.PointForce(other.end, (0.0, -10.0))]
    solution = bf.solve_static(bf.Model([own, other], [bf.Clamp(own.start)], loads, joints))
    data = data_of(solution.to_html(tmp_path / "two.html"))
    fields = {field["name"]: field for field in data["fields"]}
    assert {"stress", "upper", "lower", "utilisation"} <= set(fields)
    assert fields["stress"]["label"] == "von Mises stress, largest over the height [MPa]"
    with pytest.warns(bf.UnknownStressWarning, match="1 of 2 beams"):
        assert fields["stress"]["high"] == pytest.approx(1e-6 * solution.peak_stress().value, rel=1e-9)
    values = np.frombuffer(base64.b64decode(fields["stress"]["values"]), np.uint8).reshape(2, -1)
    first = data["beams"][0]
    assert (values[-1, :first].max(), values[-1, :first].min()) == (255, values[-1, :first][-1])
    assert (values[:, first:] == 0).all()
    alone = bf.solve_static(bf.Model([other], [bf.Clamp(other.start)], loads))
    names = {field["name"] for field in data_of(alone.to_html(tmp_path / "one.html"))["fields"]}
    assert names == {"moment", "normal", "shear", "rotation", "displacement"}


def test_page_is_complete_in_itself(falling, tmp_path):
    path = falling.to_html(tmp_path / "fall.html", title="Fall & <rise>")
    text = path.read_text()
    assert not re.search(r"https?://|<link|src=|@import|url\(", text)
    assert "<h1>Fall &amp; &lt;rise&gt;</h1>" in text
    assert f"<td>{len(falling)}</td>" in text
    assert f"{falling.statistics.iterations} Newton iterations in {falling.statistics.steps} steps" in text
    assert not re.search(r"@[A-Z]+@", text)


def test_sixty_frames_of_a_large_model_stay_below_a_megabyte(tmp_path):
    """As many rows as there are frames, of a solution that was not computed."""
    small = cantilever(elements=700, element=bf.CRBF(2), load=1e-3)
    rows = np.linspace(0.0, 1.0, 60)
    p = small.p[0] + rows[:, None] * (small.p[-1] - small.p[0])
    rest = np.zeros_like(p)
    solution = bf.Solution(small.model, True, rows, p, rest, rest, small.statistics)
    path = solution.to_html(tmp_path / "large.html")
    assert path.stat().st_size < 1_000_000
    data = data_of(path)
    assert data["sides"] == 1
    assert len(data["labels"]) >= 40


def test_supports_move_only_where_they_roll(tmp_path):
    data = data_of(cantilever().to_html(tmp_path / "bent.html"))
    assert len(data["places"]) == 1
    data = data_of(frame().to_html(tmp_path / "frame.html"))
    assert len(data["places"]) == 2
    assert len(data["places"][0]) == len(data["outlines"])


def test_loads_are_those_of_each_row(tmp_path):
    solution = cantilever()
    first, last = data_of(solution.to_html(tmp_path / "bent.html"))["loads"]
    assert first == {"forces": [], "moments": [], "gravity": []}
    (arrow,) = last["forces"]
    np.testing.assert_allclose(arrow[:2], solution.position(solution.model.beams[0].end)[-1], rtol=1e-5)
    (load,) = solution.model.point_loads
    np.testing.assert_allclose(arrow[2:4], 40.0 * np.array(load.vector) / np.linalg.norm(load.vector), atol=0.1)
    portal = frame()
    acting = data_of(portal.to_html(tmp_path / "frame.html"))["loads"][-1]
    assert len(acting["forces"]) > 20
    ((*place, sense),) = acting["moments"]
    (moment,) = (load for load in portal.model.loads if isinstance(load, bf.PointMoment))
    np.testing.assert_allclose(place, portal.position(moment.point)[-1], rtol=1e-5, atol=1e-6)
    assert sense == np.sign(moment.moment)
    assert acting["gravity"][1] == -40.0


def test_a_path_names_its_rows(tmp_path):
    path = arch()
    data = data_of(path.to_html(tmp_path / "arch.html"))
    assert data["labels"][3] == f"load factor {path.at[3]:.4g}, row 3"


def test_other_suffixes_are_refused(falling, tmp_path):
    with pytest.raises(bf.InputError, match=r'fall\.html" would be right'):
        falling.to_html(tmp_path / "fall.pdf")


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("chromium") is None, reason="needs a browser")
def test_browser_draws_the_step_of_the_address(falling, tmp_path):
    path = falling.to_html(tmp_path / "fall.html", frames=10)
    command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'browser'}"]
    done = subprocess.run(
        [*command, "--dump-dom", f"file://{path}#4:moment"], capture_output=True, text=True, timeout=60
    )
    assert f'<output id="now">{data_of(path)["labels"][4]}</output>' in done.stdout


DRIVEN = """<script>
const said = [], write = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
  said.push(text); write.call(this, text, ...place);
};
const corner = view.getBoundingClientRect();
const middle = [0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom)];
const send = (Kind, name, x, y, more) => view.dispatchEvent(
  new Kind(name, {clientX: corner.left + view.clientLeft + x, clientY: corner.top + view.clientTop + y,
                  cancelable: true, pointerType: "touch", ...more}));
// where the end of the beam is, when all is seen
const end = [0, 1].map(axis => place(points, ((+slider.value + 1) * total - 1) * 2 * data.sides + axis));
const at = [middle[0] + (end[0] - 0.5 * (data.high[0] - data.low[0])) * frame.scale,
            middle[1] - (end[1] - 0.5 * (data.high[1] - data.low[1])) * frame.scale];
const before = frame.scale;
for (let i = 0; i < 4; i++) send(WheelEvent, "wheel", ...at, {deltaY: -1});
said.length = 0;
send(PointerEvent, "pointermove", ...at);
document.body.append(Object.assign(document.createElement("pre"),
  {id: "said", textContent: JSON.stringify({zoomed: frame.scale / before, said})}));
</script></body>"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("chromium") is None, reason="needs a browser")
def test_browser_tells_values_where_one_points_and_zooms_about_the_pointer(falling, tmp_path):
    path = falling.to_html(tmp_path / "fall.html", frames=10)
    path.write_text(path.read_text().replace("</body>", DRIVEN))
    command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'browser'}"]
    done = subprocess.run(
        [*command, "--dump-dom", f"file://{path}#9:moment"], capture_output=True, text=True, timeout=60
    )
    found = json.loads(re.search(r'<pre id="said">(.*?)</pre>', done.stdout, re.S)[1])
    assert found["zoomed"] == pytest.approx(1.2**4)
    end = falling.model.beams[0].end
    told = {text.split(" ")[0]: [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", text)] for text in found["said"]}
    # four digits of positions that a page keeps in 65534 levels
    np.testing.assert_allclose(told["x"], falling.position(end)[-1], rtol=5e-4, atol=1e-4)
    np.testing.assert_allclose(told["ux"], falling.displacement(end)[-1], rtol=5e-4, atol=1e-4)
    assert any(text.startswith("bending moment [N m]: about ") for text in found["said"])
