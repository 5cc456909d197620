"""Which states a picture of shapes shows, what its legend explains, and where a field has its extreme value."""

import numpy as np
import pytest
from drawn import SECTION, STEEL, arch, cantilever, frame, pendulum
from matplotlib.collections import LineCollection

import beamfem as bf
from beamfem.results.beam_stress import PARTS
from beamfem.view.frames import moment_of, spread_rows
from beamfem.view.support_symbols import PRESCRIBED, supports_of

# the same numbers under the names of several units
pytestmark = pytest.mark.filterwarnings("ignore::beamfem.UnitsWarning")


@pytest.fixture(scope="module")
def bent():
    return cantilever()


@pytest.fixture(scope="module")
def falling():
    return pendulum()


def names(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def solid(figure):
    """Ends of the axes that are drawn as shapes, dashed ones left out."""
    lines = [c for c in figure.axes[0].collections if isinstance(c, LineCollection)]
    return [c.get_segments()[0][-1] for c in lines if c.get_linestyle()[0][1] is None]


def test_one_shape_is_the_last():
    """It was the first, which carries no load: linspace(0, n - 1, 1) is 0."""
    for solution in (cantilever(), pendulum(), arch()):
        assert spread_rows(solution, 1).tolist() == [len(solution) - 1]
        end = solution.model.beams[0].end
        (drawn,) = solid(solution.plot(shapes=1))
        np.testing.assert_allclose(drawn, solution.position(end)[-1], atol=1e-12)


def test_statics_show_their_last_state_beside_the_original_shape(bent, falling):
    figure = bent.plot()
    assert names(figure) == ["original shape", "load factor 1"]
    assert len(solid(figure)) == 1
    assert len(solid(falling.plot())) == 9
    path = arch()
    assert len(solid(path.plot())) == min(9, len(path))


def test_what_is_dashed_is_explained_in_every_picture(bent, falling, tmp_path):
    column = bf.Model([bent.model.beams[0]], bent.model.supports, [bf.PointForce(bent.model.beams[0].end, (-1.0, 0.0))])
    buckling, modes = bf.solve_buckling(column, 1), bf.solve_modes(column, 1)
    figures = [bent.plot(), bent.plot(colour="moment"), bent.plot(shapes=2), falling.plot(), falling.plot(shapes=2)]
    for figure in (*figures, buckling.plot(), modes.plot()):
        assert names(figure)[0] == "original shape"
    assert "original shape" not in names(bent.plot(undeformed=False, shapes=2))
    assert "Dashed: the original shape" in bent.to_html(tmp_path / "page.html").read_text()


def test_legend_and_title_are_above_each_other_inside_the_figure(bent):
    figure = bent.plot(colour="stress")
    figure.canvas.draw()
    axes, (legend,) = figure.axes[0], figure.legends
    title, below = axes.title.get_window_extent(), legend.get_window_extent()
    assert below.y0 >= axes.get_window_extent().y1
    assert title.y0 >= below.y1 - 4.0
    assert title.y1 <= figure.bbox.y1


@pytest.mark.parametrize("options", [{}, {"colour": "stress"}, {"shapes": 2}, {"shapes": 3, "colour": "outer"}])
def test_the_legend_of_a_narrow_picture_fits_into_it(options):
    """A mast far away from the origin: its places are long texts."""
    mast = bf.Beam(bf.Line((-1234.5, 0), (-1234.5, 5678.9)), 4, bf.CRBF(3), bf.Rectangle(100.0, 100.0), STEEL)
    model = bf.Model([mast], [bf.Clamp(mast.start)], [bf.PointForce(mast.at(0.37), (1e4, 0.0))], units="N, mm")
    for solution in (bf.solve_static(model, steps=4), bf.trace_equilibrium(model, until=1.0)):
        figure = solution.plot(**options)
        figure.canvas.draw()
        (legend,), whole = figure.legends, figure.bbox
        box = legend.get_window_extent()
        assert whole.x0 <= box.x0
        assert max(box.x1 - whole.x1, box.y1 - whole.y1) <= 0.0
        title = figure.axes[0].title
        if title.get_text():
            assert title.get_window_extent().y0 >= box.y1 - 4.0
            assert title.get_window_extent().y1 <= whole.y1


def test_a_buckling_mode_and_its_critical_state_are_told_apart():
    """Both are at the same load factor: the legend read the same twice."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SECTION, STEEL)
    column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1.0, 0.0))])
    buckling = bf.solve_buckling(column)
    _, first, last = names(buckling.solution().plot(shapes=2))
    assert first != last
    assert names(buckling.plot())[1:] == ["critical state", "with the mode"]
    assert moment_of(cantilever(), 1) == "load factor 1"


@pytest.mark.parametrize("name", ["stress", "von_mises", "upper", "lower", "outer", "tension", "compression"])
def test_the_extreme_of_a_stress_is_that_of_the_beam(bent, name):
    own = bent.model.beams[0]
    part = {"stress": "von_mises", "outer": "upper"}.get(name, name)
    peak = bent.stresses(own).peak(part)
    figure = bent.plot(colour=name)
    said = names(figure)[-1]
    assert said == f"extreme {1e-6 * peak.value:.4g} MPa at 0 m"
    assert figure.axes[1].get_ylabel().endswith("[MPa]")
    mark = figure.axes[0].lines[-1]
    np.testing.assert_allclose(np.ravel(mark.get_xydata()), [0.0, 0.0], atol=1e-12)


def test_shear_stress_has_its_own_colour(bent):
    """Three halves of the mean of a rectangle."""
    shear = np.abs(bent.section_forces(bent.model.beams[0]).shear[-1]).max()
    assert bent.plot(colour="shear_stress").axes[1].get_ylim()[1] == pytest.approx(1.5e-6 * shear / 1e-4, rel=1e-3)


def test_an_extreme_of_several_shapes_says_when(falling):
    figure = falling.plot(colour="speed", shapes=4)
    end = falling.model.beams[0].end
    rows = spread_rows(falling, 4)
    speeds = np.linalg.norm(falling.velocity(end), axis=1)[rows]
    when = falling.time[rows[speeds.argmax()]]
    assert names(figure)[-1] == f"extreme {speeds.max():.4g} m/s at 1 m, t = {when:.3g} s"


def test_a_field_that_is_even_has_no_extreme():
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, STEEL)
    solution = bf.solve_static(bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointForce(bar.end, (3.0, 0.0))]))
    assert names(solution.plot(colour="normal"))[-1] == "3 N everywhere"


def test_unknown_colours_say_what_may_be_meant(bent):
    for wrong, meant in (("mises", "von_mises"), ("bending_moment", "moment"), ("shear stress", "shear_stress")):
        with pytest.raises(bf.InputError, match=f"did you mean {meant}?"):
            bent.plot(colour=wrong)
    assert set(PARTS) - {"shear"} <= set(bf.results.axis_fields.QUANTITIES)


def test_the_arrow_of_a_prescribed_motion_starts_at_its_point():
    solution = frame()
    (support,) = (own for own in solution.model.supports if isinstance(own, bf.Prescribed))
    stamps = supports_of(solution, len(solution) - 1, np.zeros(2))
    arrows = {key: at for (key, colour, *_), at in stamps.places.items() if colour == PRESCRIBED}
    shafts = [key for key in arrows if len(stamps.outlines[key]) == 2]
    assert any(np.allclose(stamps.outlines[key][0], 0.0) for key in shafts)
    for places in arrows.values():
        np.testing.assert_allclose(places, [solution.position(support.point)[-1]], atol=1e-12)


def test_a_model_says_that_nothing_is_solved(bent):
    assert bent.model.plot().axes[0].get_title() == "reference shape, full loads"
