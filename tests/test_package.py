"""What importing costs, what README promises, and that the studies run."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pendulum
import pendulum_figures

from beamfem.view.page import Part, write_page

ROOT = Path(__file__).parent.parent


def test_import_loads_no_pictures():
    code = "import sys, beamfem; print([m for m in sys.modules if m.split('.')[0] in ('vtkmodules', 'vtk', 'pyvista', "
    code += "'matplotlib', 'h5py', 'meshio')])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
    assert found.stderr == ""


def test_readme_code_runs(tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    assert blocks
    for block in blocks:
        done = subprocess.run(
            [sys.executable, "-c", block], cwd=tmp_path, capture_output=True, text=True, env={**os.environ}
        )
        assert done.returncode == 0, done.stderr
        for line in re.findall(r"#> (.*)", block):
            assert line in done.stdout


def test_pendulum_study_draws_every_figure(tmp_path):
    runs = pendulum.main(duration=0.1, step=1e-2, meshes=(6, 12, 24, 100))
    entries = [pendulum_figures.draw(figure, runs, tmp_path) for figure in pendulum_figures.FIGURES]
    assert [figure.number for figure in pendulum_figures.FIGURES] == list(range(3, 16))
    table = pendulum_figures.table_of_times(runs)
    page = write_page(tmp_path / "index.html", "title", [Part("part", "text", entries, [table])])
    assert page.read_text().count("data:image/svg+xml") == 13


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
