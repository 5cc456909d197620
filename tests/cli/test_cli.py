"""The command `beamfem`: what it prints, the files it writes, its exit codes."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista
from scipy.optimize import brentq
from typer.testing import CliRunner

import beamfem as bf
from beamfem.cli import commands
from beamfem.cli.app import app
from beamfem.cli.report import plain

ROOT = Path(__file__).parents[2]
CANTILEVER = ROOT / "examples" / "cantilever.toml"
TIP = 0.71385896416  # Reissner beam, P L^2 / (E I) = 5, k_s = 5/6, L / h = 100


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "new" / "results.h5"
    done = invoke(
        "run", CANTILEVER, "--out", path, "--plot", path.with_suffix(".png"), "--vtk", path.with_suffix(".pvd")
    )
    assert done.exit_code == 0, done.output
    return path, done.stdout


def test_run_prints_what_is_asked_for_and_writes_the_files(results):
    path, printed = results
    assert "Cantilever, P L^2 / (E I) = 5" in printed
    row = printed.split("\ntip\n")[1].splitlines()[2].split()
    assert float(row[2]) == pytest.approx(TIP, abs=5e-7)
    assert f"wrote {path}" in printed
    solution = bf.load(path)
    tip = solution.displacement(solution.model.beams[0].end)[-1]
    assert tip[1] == pytest.approx(TIP, abs=5e-7)
    assert path.with_suffix(".png").stat().st_size > 5000
    assert path.with_suffix(".pvd").read_text().count("<DataSet") == len(solution)


def test_run_as_json_and_quiet(tmp_path):
    done = invoke("run", CANTILEVER, "--json")
    found = json.loads(done.stdout)
    assert (done.exit_code, found["analysis"], found["load_factor"]) == (0, "static", [0.0, 1.0])
    assert found["coordinates"] == 51
    tip, clamp = found["outputs"]
    assert tip["rows"] == [{"load_factor": 1.0, "ux": pytest.approx(-0.38764432833, abs=5e-7),
                            "uy": pytest.approx(TIP, abs=5e-7), "rotation": tip["rows"][0]["rotation"]}]  # fmt: skip
    force = 2e11 * 0.01**4 / 12 * 5
    lever = 1.0 + tip["rows"][0]["ux"]
    assert clamp["rows"][0]["fy"] == pytest.approx(-force, rel=1e-9)
    assert clamp["rows"][0]["m"] == pytest.approx(-force * lever, rel=1e-7)
    quiet = invoke("run", CANTILEVER, "--quiet", "--out", tmp_path / "a.h5")
    assert (quiet.exit_code, quiet.output) == (0, "")
    assert (tmp_path / "a.h5").exists()


def test_bad_input_ends_with_2_and_names_the_line(tmp_path):
    file = tmp_path / "model.toml"
    file.write_text(CANTILEVER.read_text().replace("height = 0.01", "height = -0.01"))
    done = invoke("run", file)
    assert (done.exit_code, done.stdout) == (2, "")
    message = f"{file}:13: sections.square.height: height of Rectangle must be greater than zero, got -0.01"
    assert done.stderr.strip() == f"error: {message}"
    found = json.loads(invoke("run", file, "--json").stdout)
    assert found["exit_code"] == 2
    assert found["error"] == {
        "type": "ModelFileError",
        "message": "height of Rectangle must be greater than zero, got -0.01",
        "file": str(file),
        "line": 13,
        "key": "sections.square.height",
    }
    assert invoke("run", tmp_path / "none.toml").exit_code == 2
    assert invoke("run").exit_code == 2
    assert invoke("walk").exit_code == 2


@pytest.mark.parametrize(
    ("option", "path", "words"),
    [
        ("--out", "a.txt", "must end in .h5"),
        ("--vtk", "a.vtu", "a.pvd would be right"),
        ("--plot", "a.xyz", "a.png would be right"),
        ("--plot", "folder.png", "is a folder"),
        ("--out", "file.txt/a.h5", "no files can be created"),
    ],
)
def test_what_cannot_be_written_is_refused_before_the_solve(option, path, words, tmp_path, monkeypatch):
    monkeypatch.setattr("beamfem.cli.analyses.solve_through", lambda *_: pytest.fail("solved"))
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "file.txt").touch()
    done = invoke("run", CANTILEVER, option, tmp_path / path)
    assert done.exit_code == 2
    assert words in done.stderr


def test_a_missing_package_is_named_with_the_pip_command(tmp_path, monkeypatch):
    monkeypatch.setattr("beamfem.extras.find_spec", lambda name: None)
    done = invoke("run", CANTILEVER, "--out", tmp_path / "a.h5")
    assert done.exit_code == 2
    assert 'pip install "beamfem[store]"' in done.stderr


def test_a_failed_solve_ends_with_1_and_keeps_the_states_found(tmp_path):
    """A bar of St. Venant-Kirchhoff material carries at most E A / (3 sqrt 3) in compression, at a third of its square.

    N = E A (s^2 - 1) s / 2 with nu = 0 and the stretch s; dN/ds = 0 at s^2 = 1/3.
    """
    text = CANTILEVER.read_text().replace("poisson_ratio = 0.3", "poisson_ratio = 0.0")
    text = text.replace('{ kind = "CRBF", order = 4 }', '"ANCF"').replace("[0, 833.3333333333334]", "[-5e6, 0]")
    file, out = tmp_path / "bar.toml", tmp_path / "bar.h5"
    file.write_text(text)
    done = invoke("run", file, "--out", out, "--json")
    found = json.loads(done.stdout)
    assert done.exit_code == found["exit_code"] == 1
    assert "a limit point at load factor 0.7698" in found["error"]["message"]
    solution = bf.load(out)
    reached = solution.load_factor[-1]
    assert reached * 5e6 == pytest.approx(2e11 * 1e-4 / (3.0 * np.sqrt(3.0)), rel=1e-5)
    note = f"The states found before, up to load factor {reached:g}, are saved in {out}."
    assert found["error"]["notes"] == [note]
    force = 2.0 * 5e6 / (2e11 * 1e-4) * reached
    stretch = brentq(lambda s: s - s**3 - force, 1.0 / np.sqrt(3.0), 1.0, xtol=1e-14)
    assert solution.position(solution.model.beams[0].end)[-1, 0] == pytest.approx(stretch, abs=1e-8)
    assert invoke("run", file).stderr.startswith("error: a limit point")


def test_info_of_a_results_file(results, tmp_path):
    path, _ = results
    found = json.loads(invoke("info", path, "--json").stdout)
    assert (found["kind"], found["states"], found["load_factor"]) == ("static", 2, [0.0, 1.0])
    assert found["statistics"]["iterations"] > 1
    assert found["model"]["supports"] == ["Clamp: point arm.start"]
    assert "4 x CRBF-4 (structural)" in found["model"]["beams"][0]
    text = invoke("info", path).stdout
    assert "load factor  0 to 1\n" in text
    assert "PointForce: point arm.end, vector (0, 833.333) N" in text
    assert "outcome      completed: the " in text
    assert "Newton iterations in 1 step\n" in text
    assert " digits of the forces are reliable\n" in text
    assert (
        "arm: Line, 1 m long, 4 x CRBF-4 (structural), rectangle 0.01 x 0.01 m, material E = 2e+11 Pa, nu = 0.3" in text
    )
    for raw in ("Status.", "\niterations", "[]", "None", "Section("):
        assert raw not in text
    assert "joints: none" in text
    assert invoke("export", path, tmp_path / "a.vtk").exit_code == 2
    for command in ("info", "export", "plot"):
        more = [] if command == "info" else [tmp_path / ("b.pvd" if command == "export" else "b.png")]
        done = invoke(command, tmp_path / "none.h5", *more)
        assert done.exit_code == 2
        assert "there is no file" in done.stderr
        assert invoke(command, CANTILEVER, *more).exit_code == 2


@pytest.mark.parametrize("ending", ["html", "gif", "svg"])
def test_plot_draws_pictures_pages_and_films(results, tmp_path, ending):
    target = tmp_path / f"a.{ending}"
    colour = [] if ending == "html" else ["--colour", "moment"]
    done = invoke("plot", results[0], target, *colour)
    assert (done.exit_code, done.stdout) == (0, f"wrote {target}\n")
    begin = {"html": b"<!", "gif": b"GIF8", "svg": b"<?xml"}[ending]
    assert target.read_bytes().startswith(begin)
    assert ending != "svg" or "moment" in target.read_text()
    assert json.loads(invoke("plot", results[0], target, "--json").stdout) == {"written": [str(target)]}


def test_a_colour_that_nobody_knows_is_named(results, tmp_path):
    done = invoke("plot", results[0], tmp_path / "a.png", "--colour", "momnet")
    assert done.exit_code == 2
    assert "did you mean moment" in done.stderr
    assert "did you mean moment" in invoke("plot", results[0], tmp_path / "a.html", "--colour", "momnet").stderr
    assert invoke("plot", results[0], tmp_path / "a.html", "--colour", "moment").exit_code == 0
    assert '"colour":"moment"' in (tmp_path / "a.html").read_text()


def test_export_takes_what_one_chooses(results, tmp_path):
    options = ["--reference", "--field", "displacement", "--field", "rotation", "--every", 2, "--single"]
    target = tmp_path / "x" / "a.pvd"
    assert invoke("export", results[0], target).exit_code == 0
    assert target.read_text().count("<DataSet") == 2
    done = invoke("export", results[0], target, *options)
    assert (done.exit_code, done.stdout) == (0, f"wrote {target}\n")
    solution = bf.load(results[0])
    files = sorted(target.with_suffix("").iterdir())
    assert len(files) == len(solution[::2])
    mesh = pyvista.read(files[-1])
    assert sorted(mesh.point_data) == ["displacement", "rotation"]
    assert mesh.points.dtype == np.float32
    np.testing.assert_allclose(mesh.points, pyvista.read(files[0]).points)
    refused = invoke("export", results[0], tmp_path / "b.pvd", "--field", "displacemnt")
    assert refused.exit_code == 2
    assert "did you mean displacement" in refused.stderr


def test_doctor(monkeypatch):
    done = invoke("doctor", "--json")
    found = json.loads(done.stdout)
    assert done.exit_code == 0
    assert found["versions"]["numpy"] == np.__version__
    assert found["cache"]["writable"]
    assert json.loads(invoke("doctor", "--json").stdout)["cache"]["compiled_kernels"] > 0
    assert found["first_solve"]["deflection"] == pytest.approx(TIP, abs=5e-7)
    assert found["first_solve"]["right"]
    assert isinstance(found["rendering"], str)
    assert found["missing"]["store"] == []
    version = commands._version
    monkeypatch.setattr("beamfem.view.rendering.can_render", lambda: False)
    monkeypatch.setattr(commands, "_version", lambda name: None if name == "h5py" else version(name))
    monkeypatch.setattr(commands, "writable", lambda folder: False)
    text = invoke("doctor").stdout
    assert "VTK cannot render here; on Debian" in text
    assert 'missing h5py: pip install "beamfem[store]"' in text
    assert "cannot be written to" in text


def test_plain_values():
    assert plain(bf.Status.ROUND_OFF) == "round off"
    assert plain({("a", 1): np.array([1.0, np.nan]), "b": (np.int64(2), 1 + 2j, Path("x"))}) == {
        "a, 1": [1.0, None],
        "b": [2, [1.0, 2.0], "x"],
    }


def test_a_real_process(tmp_path):
    code = "import sys; import beamfem.cli.app; "
    code += "print({name.split('.')[0] for name in sys.modules} & set(sys.argv[1:]))"
    slow = ("matplotlib", "pyvista", "vtkmodules", "h5py", "meshio", "tomllib")
    done = subprocess.run([sys.executable, "-c", code, *slow], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
    command = [sys.executable, "-m", "beamfem", "run", "none.toml"]
    wrong = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert wrong.stderr == "error: none.toml: there is no such file\n"
    assert invoke("--version").stdout.startswith("beamfem 0.")
    assert "Exit codes: 0 success" in invoke("--help").stdout


LEE = (ROOT / "examples" / "lee_frame.toml").read_text()


def test_remedies_of_the_library_are_worded_in_the_kinds_of_model_files(tmp_path):
    static = re.sub("until = .*", "", LEE.replace('kind = "path"', 'kind = "static"').replace("-1.0]", "-25000.0]"))
    (tmp_path / "lee.toml").write_text(static)
    done = invoke("run", tmp_path / "lee.toml")
    assert done.exit_code == 1
    assert '`kind = "path"` follows the path around it' in done.stderr
    assert "trace_equilibrium" not in done.stderr
    free = CANTILEVER.read_text().replace('kind = "clamp"', 'kind = "pin"').replace('"fx", "fy", "m"', '"fx"')
    (tmp_path / "free.toml").write_text(free)
    assert invoke("run", tmp_path / "free.toml").stderr.startswith(
        f"error: {tmp_path / 'free.toml'}: beam 'arm' can move"
    )
    done = invoke("run", tmp_path / "free.toml", "--json")
    assert done.exit_code == 2
    error = json.loads(done.stdout)["error"]
    assert error["message"].startswith("beam 'arm' can move freely")
    assert 'a "clamp"' in error["message"]
    assert "simulate" not in error["message"]


def test_warnings_are_printed_once_and_without_lines_of_python(tmp_path):
    text = CANTILEVER.read_text().replace("[0, 833.3333333333334]", "[-5000, 0]")
    (tmp_path / "column.toml").write_text(text)
    command = [sys.executable, "-m", "beamfem", "run", str(tmp_path / "column.toml")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    (line,) = done.stderr.splitlines()
    assert re.match(r"warning: \d of \d rows are unstable equilibria", line)
    assert '`kind = "path"` finds the bifurcations' in line
    assert "; the equilibrium is unstable" in done.stdout


@pytest.mark.filterwarnings("ignore::beamfem.UnitsWarning")
def test_tables_have_the_units_of_the_file(tmp_path):
    (tmp_path / "lee.toml").write_text(LEE.replace('"N, cm"', '"N, mm"'))
    printed = invoke("run", tmp_path / "lee.toml").stdout
    assert re.search(r"load_factor +ux \[mm\] +uy \[mm\]\n", printed)
