"""Where figures are seen: in axes of the user, in windows, below the cells of notebooks."""

import numpy as np
import pytest
from drawn import arch, cantilever, frame, pendulum

import beamfem as bf
from beamfem.view import plots

plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture
def axes():
    figure, axes = plt.subplots(2, 2)
    yield axes
    plt.close(figure)


NAMES = ("shape", "field", "motion", "history", "curve", "path", "model", "envelope", "study", "sweep", "mode")


def _pictures():
    bent, fallen, path, model = cantilever(), pendulum(), arch(), frame().model
    beam, crown = bent.model.beams[0], path.model.beams[1].at(0.2)
    return {
        "shape": bent.plot,
        "field": lambda **where: bent.plot(colour="moment", **where),
        "motion": fallen.plot,
        "history": lambda **where: fallen.plot_history(fallen.model.beams[0].end, **where),
        "curve": lambda **where: bent.plot_curve("load_factor", ("uy", beam.end), **where),
        "path": lambda **where: path.plot_load_displacement(crown, **where),
        "model": model.plot,
        "envelope": lambda **where: bf.envelope([bent]).plot(beam, **where),
        "study": bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[1, 2, 4]).plot,
        "sweep": bf.sweep(lambda load: {"sag": 2.0 * load}, load=[1.0, 2.0]).plot,
        "mode": lambda **where: bf.solve_modes(bent.model, 1).plot(**where),
    }


@pytest.mark.parametrize("name", NAMES)
def test_a_picture_is_drawn_in_given_axes_and_nowhere_else(name, axes):
    draw = _pictures()[name]
    assert draw(ax=axes[0, 1]) is axes[0, 1].figure
    drawn = [bool(item.lines or item.collections) for item in axes.flat]
    assert drawn == [False, True, False, False]
    axes[0, 1].figure.canvas.draw()
    with pytest.raises(bf.InputError, match=r"needs one axes, such as plt.gca\(\), got 4 axes"):
        draw(ax=axes)
    with pytest.raises(bf.InputError, match=r"needs one axes, such as plt.gca\(\), got 7"):
        draw(ax=7)


def test_modes_and_responses_need_as_many_axes_as_they_draw(axes):
    solution = cantilever()
    modes = bf.solve_modes(solution.model, 4)
    modes.plot(ax=axes)
    assert [item.get_title()[:2] for item in axes.flat] == ["1:", "2:", "3:", "4:"]
    with pytest.raises(bf.InputError, match=r"needs 3 axes, such as plt.subplots\(3\)\[1\], got 4 axes"):
        modes.plot(most=3, ax=axes)
    end = solution.model.beams[0].end
    response = bf.frequency_response(solution.model, solution.model.loads[0], ("uy", end), np.linspace(1.0, 50.0, 9))
    response.plot(ax=axes[:, 0])
    assert axes[1, 0].get_ylabel() == "phase [deg]"


def test_the_box_of_a_shape_is_inside_of_given_axes(axes):
    cantilever().plot(ax=axes[1, 1])
    (left, right), (low, high) = axes[1, 1].get_xlim(), axes[1, 1].get_ylim()
    assert left < 0.0
    assert right > 1.0
    assert low < 0.0
    assert high > 0.7
    assert axes[1, 1].get_aspect() == 1.0


@pytest.mark.parametrize("display", [False, True])
def test_a_figure_is_one_of_pyplot_where_there_is_a_display(display, monkeypatch, tmp_path):
    monkeypatch.setattr(plots, "has_display", lambda: display)
    plt.close("all")
    solution = cantilever()
    figure = solution.plot()
    assert (plt.get_fignums() == [1]) == display
    assert not display or plt.gcf() is figure
    solution.plot(tmp_path / "written.png")
    assert len(plt.get_fignums()) == display
    plt.close("all")


def test_figures_are_displayed_below_cells_once_each():
    """At the end of a cell, before other lines, in a loop, and again when the figure is asked for later."""
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    model = [
        "import beamfem as bf",
        "steel = bf.Material(2e11, 0.3, 7800.0)",
        "beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, section=bf.Rectangle(0.01, 0.01), material=steel)",
        "model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 10.0))])",
        "solution = bf.solve_static(model)",
    ]
    cells = {
        "\n".join(model): 0,
        "solution.plot()": 1,
        "solution.plot();": 1,
        "figure = solution.plot()\nprint('after')": 1,
        "figure": 1,
        "for colour in ('moment', 'shear'):\n    solution.plot(colour=colour)": 2,
        "import matplotlib.pyplot as plt\nfor _ in range(2):\n    solution.plot()\n    plt.show()": 2,
    }
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    nbclient.NotebookClient(notebook, timeout=100, kernel_name="python3").execute()
    shown = [sum("image/png" in output.get("data", {}) for output in cell.outputs) for cell in notebook.cells]
    assert shown == list(cells.values())
