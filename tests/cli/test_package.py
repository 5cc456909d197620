"""What importing costs, and that the studies run."""

import copy
import inspect
import json
import pickle
import re
import subprocess
import sys
from doctest import DocTestParser
from functools import cached_property
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from vtkmodules.vtkIOHDF import vtkHDFReader

import beamfem as bf
from beamfem.convergence.convergence_result import Convergence
from beamfem.sweeps.sweep import Sweep
from beamfem.view.html_page import Part, write_page
from studies import all as main_job
from studies.paper import pendulum, pendulum_figures, pendulum_page

PICTURES = ("vtkmodules", "vtk", "pyvista", "matplotlib", "h5py", "meshio")


def run(code, *arguments):
    """Return what a fresh process prints."""
    found = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True)
    assert found.stderr == ""
    return found.stdout.strip()


def test_import_loads_next_to_nothing():
    code = "import sys, beamfem; print(sorted({'numpy', 'scipy', 'skfem', 'llvmlite'} & set(sys.modules)))"
    assert run(code) == "[]"


def test_what_is_public_loads_no_pictures():
    code = f"import sys; from beamfem import *; print([m for m in sys.modules if m.split('.')[0] in {PICTURES}])"
    assert run(code) == "[]"


def test_every_public_name_is_there_in_a_fresh_process():
    names = run("from beamfem import *; import beamfem; print(all(name in globals() for name in beamfem.__all__))")
    assert names == "True"
    assert all(getattr(bf, name).__doc__ for name in bf.__all__)


def test_the_docstring_of_the_package_lists_every_public_name_once():
    table = bf.__doc__.partition("for details.")[2]
    assert sorted(re.findall(r"\b[A-Za-z_]+\b", re.sub(r"(?m)^    .{18}", "", table))) == sorted(bf.__all__)
    assert max(map(len, bf.__doc__.splitlines())) <= 120


@pytest.mark.slow
def test_type_checkers_find_what_the_package_has_and_nothing_in_examples_and_tutorials(tmp_path):
    """Examples of docstrings are parts of scripts, and use names from before."""
    root = Path(bf.__file__).parents[1]
    for path in (root / "docs" / "tutorials").glob("*.ipynb"):
        cells = json.loads(path.read_text())["cells"]
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        (tmp_path / f"{path.stem}.py").write_text("\n\n".join(code))
    for name in bf.__all__:
        lines = [example.source for example in DocTestParser().get_examples(getattr(bf, name).__doc__)]
        (tmp_path / f"example_{name}.py").write_text("".join(["import beamfem as bf\nimport numpy as np\n", *lines]))
    shown = "\n".join(f"reveal_type(bf.{name})" for name in bf.__all__)
    (tmp_path / "script.py").write_text(f"import beamfem as bf\n\n{shown}\nbf.solve_statik\nbf.__version__.upper()\n")
    command = [sys.executable, "-m", "mypy", "--config-file", "", "--follow-imports", "silent"]
    settings = ["--strict", "--ignore-missing-imports", "--cache-dir", str(tmp_path)]
    scripts = map(str, [*tmp_path.glob("*.py"), *(root / "examples").glob("*.py")])
    found = subprocess.run([*command, *settings, *scripts], capture_output=True, text=True, check=False).stdout
    assert found.count("note: Revealed type is") == len(bf.__all__)
    found = "\n".join(line for line in found.splitlines() if not line.endswith("[name-defined]"))
    assert [line for line in found.splitlines() if "error:" in line or '"Any"' in line] == [
        line for line in found.splitlines() if 'Module has no attribute "solve_statik"' in line
    ]


@pytest.mark.slow
def test_a_wheel_has_the_stub_and_the_marker_of_types(tmp_path):
    root = Path(bf.__file__).parents[1]
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(tmp_path), str(root)]
    subprocess.run(command, check=True)
    (wheel,) = tmp_path.glob("*.whl")
    assert {"beamfem/__init__.pyi", "beamfem/py.typed"} <= set(ZipFile(wheel).namelist())


def test_every_public_member_has_a_docstring():
    """Its own, or that of a base class."""
    kinds = [kind for name in bf.__all__ if inspect.isclass(kind := getattr(bf, name))]
    missing = []
    for kind in (*kinds, Convergence, Sweep):
        for name in dir(kind):
            owners = [own for own in kind.__mro__ if name in vars(own)]
            owner = next(iter(owners), object)
            item = vars(owner).get(name)
            asked = inspect.isfunction(item) or isinstance(
                item, property | cached_property | staticmethod | classmethod
            )
            documented = any(vars(own)[name].__doc__ for own in owners)
            if name[0] != "_" and owner.__module__.startswith("beamfem") and asked and not documented:
                missing.append(f"{owner.__qualname__}.{name}")
    assert missing == []


def test_a_name_that_is_not_there_is_named():
    with pytest.raises(AttributeError, match="solve_statik"):
        bf.solve_statik  # noqa: B018


def test_public_items_keep_their_place_in_other_processes():
    for name in bf.__all__:
        item = getattr(bf, name)
        assert pickle.loads(pickle.dumps(item)) is item


def test_a_solution_from_another_process_draws_before_anything_else_is_asked_of_the_package(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(order=1), bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1e3))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 1.0))]))
    (tmp_path / "a").write_bytes(pickle.dumps(solution))
    code = "import pickle, sys; print(pickle.load(open(sys.argv[1], 'rb'))._repr_html_()[:6])"
    assert run(code, str(tmp_path / "a")) == solution._repr_html_()[:6]


@pytest.mark.slow
def test_pendulum_study_draws_every_figure(tmp_path):
    runs = pendulum.main(duration=0.1, step=1e-2, meshes=(6, 12, 24, 100))
    entries = [pendulum_figures.draw(figure, runs, tmp_path) for figure in pendulum_figures.FIGURES]
    assert [figure.number for figure in pendulum_figures.FIGURES] == list(range(3, 16))
    table = pendulum_figures.table_of_times(runs, "printed")
    page = write_page(tmp_path / "index.html", "title", [Part("part", "text", entries, [table])])
    assert page.read_text().count("data:image/svg+xml") == 13


def test_the_motion_for_paraview_takes_few_files(tmp_path, monkeypatch):
    """Of 201 states 11 in a file each of bodies, axes, supports and loads; 2 in as many files for ParaView 5.11."""
    runs = pendulum.main(duration=0.1, meshes=(6, 12))
    monkeypatch.setattr(pendulum, "main", lambda second_moment: runs)
    monkeypatch.setattr(pendulum_page, "FIGURES", pendulum_figures.FIGURES[:2])
    part = pendulum_page.part("printed", tmp_path)
    assert [len(part.entries), len(part.tables)] == [3, 1]
    files = [path for path in (tmp_path / "paraview").rglob("*") if path.is_file()]
    kinds = [path.suffix for path in files]
    assert (kinds.count(".vtkhdf"), kinds.count(".pvd"), kinds.count(".vtu")) == (9, 9, 9 * 2)
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "paraview" / "ANCF.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 11
    assert sum(path.stat().st_size for path in files) < 2e6


def test_the_main_job_runs_each_part_once():
    assert sorted(main_job.LONGEST_FIRST) == sorted(main_job.PARTS)


def test_figure_12_shows_the_difference_the_paper_states():
    """The paper: about 0.0005; 100 elements, section as printed."""
    runs = {
        (element.name, 100): pendulum.fall(element, 100, pendulum.PRINTED, 1.0, 5e-4)
        for element in pendulum.ELEMENTS[1:]
    }
    figure = next(figure for figure in pendulum_figures.FIGURES if figure.number == 12)
    largest = pendulum_figures.difference(figure, runs)[0]
    assert 3.5e-4 < largest < 5.5e-4
    for run in runs.values():
        assert np.abs(run.length_of_r_y - 1.0).max() < 1e-8


def test_models_and_solutions_survive_copies_and_other_processes():
    """What a model keeps of its meshes knows beams by identity, which no copy shares."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1e5))])
    solution = bf.solve_static(model)
    for other in (pickle.loads(pickle.dumps(solution)), copy.deepcopy(solution)):
        end = other.model.beams[0].end
        assert np.array_equal(other.position(end), solution.position(beam.end))
        again = bf.solve_static(other.model)
        assert np.array_equal(again.p, solution.p)
