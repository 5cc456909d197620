"""What model files print and write: quantities as Python has them, files with their options."""

import numpy as np
import pytest
import pyvista
from model_file_pairs import ARM, LIFT, arm, held
from test_cli import invoke
from test_model_file_alike import require_refused

import beamfem as bf
from beamfem.cli.modelfile import read_model_file

STRONG = ARM.replace("density = 7800.0", "density = 7800.0\nstrength = 2.35e8")
MOTION = '[analysis]\nkind = "dynamics"\nduration = 0.01\nstep = 1e-3\n'
MODES = '[analysis]\nkind = "modes"\ncount = 3\n'


def rows(tmp_path, text, output):
    """Return the rows of an output, the solution, and its beam."""
    (tmp_path / "a.toml").write_text(f"{text}[[outputs]]\n{output}\n")
    job = read_model_file(tmp_path / "a.toml")
    solution = job.solve().solution
    return job.outputs[0].rows(solution), solution, job.beams["arm"]


def test_quantities_of_a_point(tmp_path):
    names = [f"{kind}_{part}" for kind in ("strain", "stress") for part in ("xx", "yy", "xy")]
    output = f'point = "arm.at(0.3)"\nquantities = {["shear_angle", *names]}\nat = "all"'
    found, solution, beam = rows(tmp_path, STRONG + LIFT, output)
    fields = solution.fields(beam.at(0.3))
    assert [row["shear_angle"] for row in found] == fields.shear_angle.tolist()
    for name in names:
        kind, part = name.split("_")
        expected = getattr(fields.green_strain if kind == "strain" else fields.stress, part)
        np.testing.assert_array_equal([row[name] for row in found], expected)


def test_stresses_of_a_beam(tmp_path):
    names = ["lower", "upper", "tension", "compression", "von_mises", "utilisation"]
    found, solution, beam = rows(tmp_path, STRONG + LIFT, f'beam = "arm"\nquantities = {[*names, "shear_stress"]}')
    stresses = solution.stresses(beam)
    assert found[0]["arc_length"] == stresses.arc_length.tolist()
    assert found[0]["shear_stress"] == stresses.shear[-1].tolist()
    for name in names:
        assert found[0][name] == getattr(stresses, name)[-1].tolist()


def test_quantities_of_the_model(tmp_path):
    found, solution, _ = rows(
        tmp_path, ARM + LIFT + MOTION, 'quantities = ["px", "py", "angular_momentum"]\nat = "all"'
    )
    np.testing.assert_array_equal([[row["px"], row["py"]] for row in found], solution.linear_momentum())
    assert [row["angular_momentum"] for row in found] == solution.angular_momentum().tolist()
    found, solution, _ = rows(tmp_path, ARM + LIFT, 'quantities = ["stable"]\nat = "all"')
    assert [row["stable"] for row in found] == solution.stable.tolist() == [True, True]


FILES = {
    "results": 'file = "a.h5"',
    "vtk": 'file = "a.vtkhdf"\ngeometry = "reference"\nfields = ["displacement"]\nsingle = true\nevery = 2',
    "plot": 'file = "a.svg"\ncolour = "moment"\nshapes = 3\nundeformed = false\nsupports = false\nloads = false',
    "film": 'file = "a.gif"\nfps = 5\nseconds = 1\ncolour = "speed"\nundeformed = false\nsupports = false\n'
    "loads = false\ndpi = 50",
    "page": 'file = "a.html"\ntitle = "How it moves"\nframes = 4',
    "body": 'file = "a.png"\nrow = 3\ncolour = "moment"\nsize = [160, 120]',
    "history": 'file = "a.svg"\npoints = ["arm.end", "arm.at(0.5)"]\nquantity = "velocity"',
    "load-displacement": 'file = "a.svg"\npoint = "arm.end"\nquantity = "ux"',
    "mode-shapes": 'file = "a.svg"\nmost = 2',
    "model": 'file = "a.pdf"',
}
METHODS = {
    "results": "save",
    "plot": "plot",
    "film": "animate",
    "page": "to_html",
    "body": "picture",
    "history": "plot_history",
    "load-displacement": "plot_load_displacement",
    "vtk": "to_vtk",
}


@pytest.mark.filterwarnings("ignore:VTK cannot render here:UserWarning")  # then it is drawn flat
@pytest.mark.parametrize("kind", FILES)
def test_a_file_is_written_with_its_options(kind, tmp_path):
    analysis = {"load-displacement": "", "mode-shapes": MODES}.get(kind, MOTION)
    (tmp_path / "a.toml").write_text(f'{ARM}{LIFT}{analysis}[[files]]\nkind = "{kind}"\n{FILES[kind]}\n')
    done = invoke("run", tmp_path / "a.toml")
    assert done.exit_code == 0, done.stderr
    (target,) = [path for path in tmp_path.iterdir() if path.stem == "a" and path.suffix != ".toml"]
    assert f"wrote {target}" in done.stdout
    assert target.stat().st_size > 1000


def given_to(monkeypatch, method):
    """Return a list that gets what a method of a solution is called with."""
    calls = []
    monkeypatch.setattr(bf.Solution, method, lambda self, *given, **options: calls.append((given, options)))
    return calls


@pytest.mark.parametrize("kind", METHODS)
def test_options_come_to_where_python_takes_them(kind, tmp_path, monkeypatch):
    calls = given_to(monkeypatch, METHODS[kind])
    analysis = "" if kind == "load-displacement" else MOTION
    (tmp_path / "a.toml").write_text(f'{ARM}{LIFT}{analysis}[[files]]\nkind = "{kind}"\n{FILES[kind]}\n')
    job = read_model_file(tmp_path / "a.toml")
    job.files[0].write(job.solve())
    ((given, options),) = calls
    asked = {name: value for name, value in vars(job.files[0]).items() if name != "file"}
    arm_end = job.beams["arm"].end
    expected = {
        "vtk": ((), {"geometry": "reference", "fields": ["displacement"], "single": True}),
        "body": ((), {"row": 2, "colour": "moment", "size": (160, 120)}),
        "history": (([arm_end, job.beams["arm"].at(0.5)], "velocity"), {}),
        "load-displacement": ((arm_end, "ux"), {}),
    }.get(kind, ((), asked))
    paths = [item for item in given if item == job.files[0].file]
    assert len(paths) == 1
    assert (tuple(item for item in given if item is not paths[0]), options) == expected


def test_files_for_paraview_have_what_was_asked_for(tmp_path):
    text = FILES["vtk"].replace("vtkhdf", "pvd")
    (tmp_path / "a.toml").write_text(f'{ARM}{LIFT}{MOTION}[[files]]\nkind = "vtk"\n{text}\n')
    assert invoke("run", tmp_path / "a.toml").exit_code == 0
    files = sorted((tmp_path / "a").iterdir())
    assert len(files) == 6  # every second of 11 states
    mesh = pyvista.read(files[-1])
    assert sorted(mesh.point_data) == ["displacement"]
    assert mesh.points.dtype == np.float32


# kind, what is replaced by what, the analysis; the key and words of the error
MISTAKES = {
    "unknown kind": ('"plot"', '"plt"', MOTION, ".kind", "did you mean plot"),
    "unknown key": ("shapes", "shape", MOTION, ".shape", "did you mean shapes"),
    "wrong suffix": ("a.svg", "a.gif", MOTION, ".file", "must end in .png, .svg or .pdf"),
    "unknown colour": ('"moment"', '"momnet"', MOTION, ".colour", "did you mean moment"),
    "no flag": ("supports = false", "supports = 0", MOTION, ".supports", "must be true or false"),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_in_a_file_to_write_is_named(case, tmp_path):
    old, new, analysis, key, words = MISTAKES[case]
    text = f'{ARM}{LIFT}{analysis}[[files]]\nkind = "plot"\n{FILES["plot"]}\n'
    require_refused(tmp_path / "a.toml", text.replace(old, new), f"files[1]{key}", words)


OTHERS = {
    "fields that are not there": (
        'kind = "vtk"\nfile = "a.pvd"\nfields = ["displacemnt"]',
        MOTION,
        ".fields",
        "displaceme",
    ),
    "velocity of equilibria": ('kind = "vtk"\nfile = "a.pvd"\nfields = ["velocity"]', "", ".fields", "is not there"),
    "odd geometry": ('kind = "vtk"\nfile = "a.pvd"\ngeometry = "reverence"', MOTION, ".geometry", "reference"),
    "history of nothing": ('kind = "history"\nfile = "a.svg"', MOTION, "", "points are needed"),
    "history of a point": ('kind = "history"\nfile = "a.svg"\npoints = "arm.end"', MOTION, ".points", "a list such as"),
    "odd history": (
        'kind = "history"\nfile = "a.svg"\npoints = ["arm.end"]\nquantity = "uz"',
        MOTION,
        ".quantity",
        "known are displacement",
    ),
    "history of modes": ('kind = "history"\nfile = "a.svg"\npoints = ["arm.end"]', MODES, "", "go with static"),
    "load of a motion": (
        'kind = "load-displacement"\nfile = "a.svg"\npoint = "arm.end"',
        MOTION,
        "",
        "has no load factor",
    ),
    "modes of a motion": ('kind = "mode-shapes"\nfile = "a.svg"', MOTION, "", "finds no modes"),
    "odd size": ('kind = "body"\nfile = "a.png"\nsize = [100]', MOTION, ".size", "two numbers of pixels"),
    "row of words": ('kind = "body"\nfile = "a.png"\nrow = "last"', MOTION, ".row", "whole number"),
    "no film": ('kind = "film"\nfile = "a.avi"', MOTION, ".file", "must end in .gif or .mp4"),
    "no page": ('kind = "page"\nfile = "a.htm"', MOTION, ".file", "must end in .html"),
    "written twice": (
        'kind = "page"\nfile = "a.html"\n[[files]]\nkind = "page"\nfile = "a.html"',
        MOTION,
        None,
        "is written twice",
    ),
}


@pytest.mark.parametrize("case", OTHERS)
def test_a_file_that_cannot_be_filled_is_refused_before_the_solve(case, tmp_path):
    text, analysis, key, words = OTHERS[case]
    where = "files[2].file" if key is None else f"files[1]{key}"
    require_refused(tmp_path / "a.toml", f"{ARM}{LIFT}{analysis}[[files]]\n{text}\n", where, words)


def test_a_row_that_is_not_there(tmp_path):
    (tmp_path / "a.toml").write_text(f'{ARM}{LIFT}{MOTION}[[files]]\nkind = "body"\nfile = "a.png"\nrow = 99\n')
    done = invoke("run", tmp_path / "a.toml")
    assert done.exit_code == 2
    assert "row is 99, but there are 11 states" in done.stderr


def test_stability_is_of_equilibria(tmp_path):
    output = '[[outputs]]\nquantities = ["stable"]\n'
    require_refused(tmp_path / "a.toml", ARM + LIFT + MOTION + output, "outputs[1].quantities", "equilibria")


def test_sweeps_write_no_files(tmp_path):
    sweep = '[[sweep]]\nkey = "sections.a"\nvalues = [1]\n[[files]]\nkind = "page"\nfile = "a.html"\n'
    text = ARM.replace('section = { kind = "rectangle", width = 0.01, height = 0.01 }', 'section = "a"')
    text += '[sections.a]\nkind = "circle"\ndiameter = 0.01\n' + LIFT + sweep
    (tmp_path / "a.toml").write_text(text.replace('"sections.a"\n', '"sections.a.diameter"\n', 1))
    done = invoke("run", tmp_path / "a.toml")
    assert done.exit_code == 2
    assert "has [[files]], which are of one solution" in done.stderr


def test_the_same_results_as_python_saves(tmp_path):
    (tmp_path / "a.toml").write_text(f'{ARM}{LIFT}[[files]]\nkind = "results"\nfile = "a.h5"\n')
    assert invoke("run", tmp_path / "a.toml").exit_code == 0
    np.testing.assert_array_equal(bf.load(tmp_path / "a.h5").p, bf.solve_static(held(arm())).p)


@pytest.mark.parametrize("name", ["/tmp/other/a.html", "../a.html", "out/../../a.html"])
@pytest.mark.parametrize("section", ["files", "curves"])
def test_a_model_file_writes_only_below_its_folder(tmp_path, name, section):
    """A model file from somebody else could replace any .h5, .png or .html of the one who runs it."""
    keys = f'kind = "page"\nfile = "{name}"' if section == "files" else f'file = "{name}"\nx = "time"\ny = "kinetic"'
    (tmp_path / "below").mkdir()
    key = "files[1].file" if section == "files" else "curves[1].file"
    text = f"{ARM}{LIFT}{MOTION}[[{section}]]\n{keys}\n"
    require_refused(tmp_path / "below" / "a.toml", text, key, "is not below the folder of the model file")
