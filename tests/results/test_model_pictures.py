"""Pictures of models that nothing is solved of yet."""

from collections import Counter

import numpy as np
import pytest
from drawn import SECTION, STEEL, frame, share_of_ink
from matplotlib.collections import LineCollection
from matplotlib.quiver import Quiver

import beamfem as bf


@pytest.fixture(scope="module")
def framed():
    return frame()


def test_a_model_is_drawn_before_any_solve(framed, tmp_path):
    """As it is described: bodies in their reference, with the symbols that a solution has, at full load."""
    (axes,) = framed.model.plot(tmp_path / "model.svg").axes
    (solved,) = framed.plot(shapes=1, undeformed=False).axes
    assert (tmp_path / "model.svg").stat().st_size > 1000
    drawn, expected = (Counter(type(part) for part in one.get_children()) for one in (axes, solved))
    assert not expected - drawn
    assert drawn[Quiver] > 0
    places = np.concatenate([mesh.position for mesh in framed.model.meshes])
    lines = [one for one in axes.collections if isinstance(one, LineCollection)]
    points = np.concatenate([segment for one in lines for segment in one.get_segments()])
    distances = np.linalg.norm(places[:, None] - points, axis=2).min(axis=1)
    assert distances.max() < 1e-9


def test_a_model_that_cannot_be_solved_is_drawn():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(order=2), SECTION, STEEL)
    model = bf.Model([beam], loads=[bf.PointForce(beam.end, (0, 1e9))])
    with pytest.raises(bf.FreeMotionError):
        bf.solve_static(model)
    figure = model.plot()
    figure.canvas.draw()
    assert share_of_ink(figure.canvas.buffer_rgba()) > 0.01


def test_actuation_and_heat_are_named_beside_their_beams():
    steel = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
    arm = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), bf.Rectangle(0.01, 0.01), steel)
    loads = [bf.Actuation(arm, curvature=1.5), bf.Temperature(arm, lambda s: 10.0 * s, gradient=2000.0)]
    model = bf.Model([arm], [bf.Clamp(arm.start)], loads)
    for figure in (model.plot(), bf.solve_static(model).plot()):
        words = {text.get_text().replace("\n", " ") for text in figure.axes[0].texts}
        assert {"actuation: curvature 1.5 1/m", "temperature: change varies, gradient 2000 K/m"} <= words


@pytest.mark.parametrize("curvature", [0.2, -0.2, 1e-6])
@pytest.mark.parametrize("end", [(0.0, 1.0), (0.3, 3.0), (1.0, 0.0)])
def test_words_of_actuation_stay_inside_the_axes_and_beside_each_other(curvature, end):
    """On an upright beam they ran over the beam, the edge of the axes and the colour bar."""
    arm = bf.Beam(bf.Line((0, 0), end), 4, bf.CRBF(order=3), SECTION, STEEL)
    loads = [bf.Actuation(arm, curvature=curvature, stretch=1e-4), bf.Actuation(arm, shear=1e-4)]
    model = bf.Model([arm], [bf.Clamp(arm.start)], loads)
    figure = bf.solve_static(model).plot(colour="moment")
    axes = figure.axes[0]
    one, other = (text.get_window_extent() for text in axes.texts if text.get_text().startswith("actuation"))
    assert not one.overlaps(other)
    room = axes.get_window_extent()
    for box in (one, other):
        assert room.x0 < box.x0
        assert box.x1 < room.x1


@pytest.mark.parametrize("height", [0.2, 5.0])
def test_what_names_the_shapes_fits_into_the_picture(height):
    """Of a tall model the names of three load factors ran out of the picture on both sides: a bar tells them then."""
    column = bf.Beam(bf.Line((0.0, 0.0), (1.0, height)), 4, bf.CRBF(2), SECTION, STEEL)
    model = bf.Model([column], [bf.Clamp(column.start)], [bf.PointForce(column.end, (5.0, 0.0))])
    figure = bf.solve_static(model, steps=2).plot(shapes=3)
    figure.canvas.draw()
    whole, (legend,) = figure.bbox, figure.legends
    assert len(legend.get_texts()) == (4 if height < 1.0 else 1)
    box = legend.get_window_extent()
    assert whole.x0 <= box.x0
    assert box.x1 <= whole.x1
    assert len(figure.axes) == (1 if height < 1.0 else 2)
