"""Files that the command `beamfem` writes: model files to begin with, pictures, pages and films."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import pyvista
from test_cli import CANTILEVER, invoke

import beamfem as bf
from beamfem.cli import bundled_examples as examples
from beamfem.cli.model_file import read_model_file


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "results.h5"
    assert invoke("run", CANTILEVER, "--out", path, "--quiet").exit_code == 0
    return path


def test_a_new_model_file_runs_as_it_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = invoke("new", "bracket.toml")
    assert (done.exit_code, done.stdout) == (0, "wrote bracket.toml; solve it with: beamfem run bracket.toml\n")
    found = json.loads(invoke("run", "bracket.toml", "--json").stdout)
    end, foot = (output["rows"][0] for output in found["outputs"])
    assert foot["fy"] == pytest.approx(10.0, rel=1e-9)
    assert foot["m"] == pytest.approx(10.0 * (0.4 + end["ux"]), rel=1e-9)
    assert -0.3 < end["uy"] < 0.0


@pytest.mark.parametrize(("name", "words"), [("a.txt", "a.toml would be right"), ("there.toml", "already exists")])
def test_a_new_model_file_takes_no_place_of_another(tmp_path, name, words):
    (tmp_path / "there.toml").write_text("mine")
    done = invoke("new", tmp_path / name)
    assert done.exit_code == 2
    assert words in done.stderr
    assert (tmp_path / "there.toml").read_text() == "mine"


def test_everything_that_the_template_mentions_can_be_read(tmp_path):
    """The lines behind a comment sign too, one analysis after the other."""
    text = Path(examples.__file__).with_name("template.toml").read_text()
    begin, analyses, rest = re.split(r"^# -+ (?:one \[analysis\]|outputs to print).*\n", text, flags=re.MULTILINE)
    begin = re.sub(r"^# (?=\w+ = |\[)", "", begin, flags=re.MULTILINE)
    kinds = []
    for analysis in re.split(r"^(?:# )?\[analysis\]\n", analyses, flags=re.MULTILINE)[1:]:
        own = "[analysis]\n" + re.sub(r"^# ", "", analysis, flags=re.MULTILINE)
        kinds.append(re.search(r'kind = "(\w+)"', own)[1])
        asked = rest if kinds[-1] in ("static", "path", "dynamics") else ""
        asked = re.sub(r"^# (?=\w+ = |\[\[)", "", asked, flags=re.MULTILINE)
        (tmp_path / "model.toml").write_text(begin + own + asked)
        assert len(read_model_file(tmp_path / "model.toml").model.loads) == 2
    tapered = re.search(r"height = \S+ # tapered: (\{.*\})", begin)[1]
    (tmp_path / "model.toml").write_text(re.sub(r"height = .*", f"height = {tapered}", begin))
    assert read_model_file(tmp_path / "model.toml").model.beams[1].section_at(0.2).area == pytest.approx(0.03 * 0.0015)
    assert kinds == ["static", "path", "buckling", "modes", "dynamics"]


@pytest.mark.parametrize("ending", ["html", "gif", "svg"])
def test_plot_draws_pictures_pages_and_films(saved, tmp_path, ending):
    target = tmp_path / f"a.{ending}"
    colour = [] if ending == "html" else ["--colour", "moment"]
    done = invoke("plot", saved, target, *colour)
    assert (done.exit_code, done.stdout) == (0, f"wrote {target}\n")
    begin = {"html": b"<!", "gif": b"GIF8", "svg": b"<?xml"}[ending]
    assert target.read_bytes().startswith(begin)
    assert ending != "svg" or "moment" in target.read_text()


def test_a_colour_that_nobody_knows_is_named(saved, tmp_path):
    done = invoke("plot", saved, tmp_path / "a.png", "--colour", "momnet")
    assert done.exit_code == 2
    assert "did you mean moment" in done.stderr
    assert "has its own choice of colours" in invoke("plot", saved, tmp_path / "a.html", "--colour", "moment").stderr


def test_export_takes_what_one_chooses(saved, tmp_path):
    options = ["--reference", "--field", "displacement", "--field", "rotation", "--every", 2, "--single"]
    done = invoke("export", saved, tmp_path / "a.pvd", *options)
    assert (done.exit_code, done.stdout) == (0, f"wrote {tmp_path / 'a.pvd'}\n")
    solution = bf.load(saved)
    files = sorted((tmp_path / "a").iterdir())
    assert len(files) == len(solution[::2])
    mesh = pyvista.read(files[-1])
    assert sorted(mesh.point_data) == ["displacement", "rotation"]
    assert mesh.points.dtype == np.float32
    np.testing.assert_allclose(mesh.points, pyvista.read(files[0]).points)
    refused = invoke("export", saved, tmp_path / "b.pvd", "--field", "displacemnt")
    assert refused.exit_code == 2
    assert "did you mean displacement" in refused.stderr
