"""Numbers and places in pictures of curves: they cover nothing and have no round-off."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.text import Text

import beamfem as bf
from beamfem.view.labels import place, write_labels
from beamfem.view.plots import new_figure


def boxes(figure):
    figure.canvas.draw()
    # without the line to the point
    return [Text.get_window_extent(text) for text in figure.axes[0].texts]


@pytest.fixture(scope="module")
def sine_arch():
    """A clamped shallow arch: bifurcations within one per cent of its limit points."""
    arch = bf.Beam(
        bf.Parametric(lambda t: (t, 5.0 * np.sin(np.pi * t / 100.0)), 0, 100),
        12,
        bf.CRBF(3),
        bf.Rectangle(10.0, 0.5),
        bf.Material(2.1e5, 0.3, 7.85e-9),
    )
    supports = [bf.Clamp(arch.start), bf.Clamp(arch.end)]
    model = bf.Model([arch], supports, [bf.PointForce(arch.at(0.5), (0.0, -1.0))], units="N, mm")
    return arch.at(0.5), bf.trace_equilibrium(model, until=lambda s: s.displacement(arch.at(0.5))[1] < -11.0)


def test_labels_of_critical_points_do_not_overlap(sine_arch, tmp_path):
    """30.407 and 30.379 lay on each other, and the diamond hid the circle."""
    crown, path = sine_arch
    figure = path.plot_load_displacement(crown, path=tmp_path / "path.png")
    shown = boxes(figure)
    assert len(shown) == len(path.limit_points) + len(path.bifurcations) == 4
    assert not any(one.overlaps(other) for one, other in combinations(shown, 2))
    axes = figure.axes[0]
    rings, diamonds = axes.lines[2], axes.lines[3]
    assert rings.get_markerfacecolor() == "none"
    assert rings.get_markersize() > diamonds.get_markersize()
    dots = [axes.transData.transform(line.get_xydata()) for line in (rings, diamonds)]
    for box in shown:
        assert not any(box.contains(*dot) for dot in np.concatenate(dots))
    assert {text.get_text() for text in axes.texts} == {
        f"{state.at:.5g}" for state in (*path.limit_points, *path.bifurcations)
    }


def test_many_labels_at_one_place_stand_apart_and_equal_ones_are_one():
    figure, axes = new_figure()
    axes.plot([0.0, 1.0], [0.0, 1.0])
    points = [(0.5 + 1e-3 * i, 0.5) for i in range(8)]
    texts = ["1.0000", "1.0000", *(f"{1.0 + 0.01 * i:.4f}" for i in range(2, 8))]
    write_labels(axes, points, texts, ["black"] * 8, np.array([[0.0, 0.0], [1.0, 1.0]]))
    shown = boxes(figure)
    assert len(shown) == 7
    assert not any(one.overlaps(other) for one, other in combinations(shown, 2))
    frame = axes.get_window_extent()
    assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in shown)


def test_places_have_no_round_off():
    """A quarter circle ends at (6e-18, 0.04), not at (0, 0.04)."""
    arc = bf.Beam(
        bf.Arc((0, 0), 0.04, 0.0, 0.5 * np.pi), 4, bf.CRBF(3), bf.Circle(1e-3), bf.Material(2e11, 0.3, 7800.0)
    )
    model = bf.Model([arc], [bf.Clamp(arc.start)], [bf.PointForce(arc.end, (0.0, -1.0))])
    solution = bf.solve_static(model)
    assert arc.end.reference[0] != 0.0
    assert place(model, arc.end.reference) == "(0, 0.04)"
    curve = solution.plot_curve(("uy", arc.end), "load_factor").axes[0].get_xlabel()
    load = solution.plot_load_displacement(arc.end).axes[0].get_xlabel()
    assert curve == load == "displacement uy at (0, 0.04) [m]"
    lines = solution.plot_history([arc.end, arc.start], "rotation").axes[0].lines
    assert [line.get_label() for line in lines] == ["rotation at (0, 0.04)", "rotation at (0.04, 0)"]
