"""What importing costs, and that the studies run."""

import copy
import pickle
import subprocess
import sys

import numpy as np

import beamfem as bf
from beamfem.view.page import Part, write_page
from studies.paper import pendulum, pendulum_figures


def test_import_loads_no_pictures():
    code = "import sys, beamfem; print([m for m in sys.modules if m.split('.')[0] in ('vtkmodules', 'vtk', 'pyvista', "
    code += "'matplotlib', 'h5py', 'meshio')])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
    assert found.stderr == ""


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
