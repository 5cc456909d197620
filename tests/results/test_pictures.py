"""Drawings: what they show, in which units, and that they need no window."""

import os
import subprocess
import sys

import numpy as np
import pytest
from drawn import EI, SECTION, STEEL, arch, cantilever, frame, pendulum, share_of_ink
from matplotlib import image
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.quiver import Quiver

import beamfem as bf
from beamfem.results.axis_fields import section_forces
from beamfem.results.axis_points import AxisPoints
from beamfem.view import symbols
from beamfem.view.deformed_shapes import Shapes, limits
from beamfem.view.drawing import equal_axes
from beamfem.view.frames import spread_rows
from beamfem.view.load_drawing import FORCE, draw_loads
from beamfem.view.quantity_curve import plot_load_displacement
from beamfem.view.support_symbols import supports_of


@pytest.fixture(scope="module")
def bent():
    return cantilever()


@pytest.fixture(scope="module")
def falling():
    return pendulum()


@pytest.fixture(scope="module")
def framed():
    return frame()


def lines_of(axes):
    return [c for c in axes.collections if isinstance(c, LineCollection)]


def test_axes_are_labelled_and_of_equal_scale(bent, tmp_path):
    figure = bent.plot(tmp_path / "new" / "bent.png")
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [m]", "y [m]")
    box = axes.get_window_extent()
    x, y = np.diff(axes.get_xlim())[0], np.diff(axes.get_ylim())[0]
    assert box.width / x == pytest.approx(box.height / y, rel=1e-6)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["original shape", "load factor 1"]
    assert 0.005 < share_of_ink(image.imread(tmp_path / "new" / "bent.png") * 255) < 0.3


def test_shapes_go_through_the_positions_of_the_solution(falling):
    figure = falling.plot(shapes=4, undeformed=False, supports=False, loads=False)
    axes, bar = figure.axes
    tip = falling.position(falling.model.beams[0].end)
    rows = spread_rows(falling, 4)
    assert len(rows) == 4
    for row, lines in zip(rows, lines_of(axes), strict=True):
        np.testing.assert_allclose(lines.get_segments()[0][-1], tip[row], atol=1e-12)
    assert bar.get_ylabel() == "time [s]"
    assert [tick.get_text() for tick in bar.get_yticklabels()] == [f"{falling.time[row]:.3g}" for row in rows]


def test_what_is_the_same_to_three_digits_has_one_colour():
    """A ring under pressure: its normal force -p r differs by parts in a million, which are errors of interpolation."""
    low, high = limits([np.array([-50.0001, -50.0]), np.array([-50.0, -49.9999])])
    assert high - low > 50.0
    assert limits([np.array([-50.0, np.nan]), np.array([-49.0])]) == (-50.0, -49.0)


def test_colour_bar_has_the_limits_and_the_unit_of_the_field(bent):
    figure = bent.plot(colour="moment")
    bar = figure.axes[1]
    assert bar.get_ylabel() == "bending moment [N m]"
    # the largest moment is that at the clamp; 4 elements of order 3 know it to 1e-4
    low, high = bar.get_ylim()
    assert low == pytest.approx(0.0, abs=1e-3 * EI)
    assert high == pytest.approx(abs(bent.reaction(bent.model.beams[0].start)[-1, 2]), rel=1e-4)
    assert figure.axes[0].get_title() == "load factor 1"


@pytest.mark.parametrize("element", [bf.CRBF(1), bf.CRBF(3), bf.ANCFCRBF(), bf.ShearRigid()], ids=lambda e: e.name)
def test_section_forces_between_their_stations(element):
    """A force so small that the beam stays straight: V = P, M = P (L - s)."""
    load = 1e-6
    solution = cantilever(load, 4, element)
    mesh = solution.model.meshes[0]
    points = AxisPoints.spaced(mesh, 5)
    found = section_forces(points, solution, slice(None))
    s = points.arc_length
    np.testing.assert_allclose(found["moment"][-1], load * EI * (1.0 - s), atol=1e-6 * load * EI)
    np.testing.assert_allclose(found["shear"][-1], load * EI, rtol=1e-5)


@pytest.mark.parametrize(
    "name", ["normal", "shear", "rotation", "displacement", "speed", "axial_strain", "shear_angle"]
)
def test_every_field_can_be_drawn(falling, name):
    figure = falling.plot(colour=name, shapes=3)
    low, high = figure.axes[1].get_ylim()
    assert np.isfinite([low, high]).all()
    assert low < high


def test_a_field_is_right_at_the_tip(falling):
    rows = spread_rows(falling, 5)
    end = falling.model.beams[0].end
    expected = {
        "rotation": falling.rotation(end)[rows],
        "displacement": np.linalg.norm(falling.displacement(end), axis=1)[rows],
        "speed": np.linalg.norm(falling.velocity(end), axis=1)[rows],
        "shear_angle": falling.fields(end).shear_angle[rows],
    }
    for name, values in expected.items():
        np.testing.assert_allclose(Shapes(falling, rows, name).values[0][:, -1], values, atol=1e-12)


def test_rotation_of_gradients_counts_turns_where_rows_are_left_out():
    material = bf.Material(2e7, 0.3, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, bf.BilinearANCF(), bf.Rectangle(0.02, 0.02), material)
    spin = bf.RigidVelocity(angular=20.0 * np.pi)
    solution = bf.simulate(bf.Model([beam], [bf.Pin(beam.start)]), 0.25, 0.0005, velocity=spin, save_every=10)
    last = Shapes(solution, np.array([0, len(solution) - 1]), "rotation").values[0][-1]
    assert last[-1] == pytest.approx(solution.rotation(beam.end)[-1], abs=1e-9)
    assert last[-1] > 4.0 * np.pi


def test_supports_and_loads_can_be_left_out(framed):
    def drawn(**options):
        return len(framed.plot(**options).axes[0].get_children())

    everything = drawn()
    assert drawn(supports=False) < everything
    assert drawn(loads=False) < everything
    assert drawn(undeformed=False) == everything - 1


def test_rollers_roll_and_supports_stand_where_they_hold(framed):
    left, right, column = framed.model.beams
    stamps = supports_of(framed, 1, np.array([1.0, 0.0]))
    places = {tuple(np.round(at, 9)) for group in stamps.places.values() for at in group}
    roller = framed.position(right.at(0.5))[-1]
    assert np.linalg.norm(roller - [1.5, 0.0]) > 1e-3
    for point in (left.start.reference, column.end.reference, left.at(0.5).reference, roller):
        assert tuple(np.round(point, 9)) in places


def test_a_section_that_may_only_not_turn_is_drawn():
    """A guide, alone and beside a roller; held in place as well it is a clamp."""
    for held, symbol in (
        ({}, symbols.NO_TURN),
        ({"uy": 0.0}, symbols.NO_TURN),
        ({"ux": 0.0, "uy": 0.0}, symbols.CLAMP),
    ):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, STEEL)
        supports = [bf.Pin(beam.start), bf.Prescribed(beam.end, rotation=0.0, **held)]
        solution = bf.solve_static(bf.Model([beam], supports, [bf.PointMoment(beam.start, 0.1 * EI)]))
        stamps = supports_of(solution, 1, np.array([0.5, 0.0]))
        down = np.array([0.0, -1.0]) if symbol is symbols.NO_TURN else np.array([1.0, 0.0])
        outlines = [np.round(symbols.turned(outline, down), 6).tobytes() for outline in symbol]
        assert set(outlines) <= set(stamps.outlines)


def test_the_ground_of_a_symbol_lies_where_it_shall():
    for down in ((0.0, -1.0), (1.0, 0.0), (-0.6, 0.8)):
        ground = symbols.turned(symbols.PIN[1], np.array(down))
        np.testing.assert_allclose(ground @ down, 0.75, atol=1e-12)
    np.testing.assert_allclose(symbols.turned(symbols.PIN[0], np.array([0.0, -1.0])), symbols.PIN[0], atol=1e-12)


@pytest.mark.parametrize("span", [1.5 * np.pi, -1.5 * np.pi])
def test_the_arrow_of_a_moment_turns_with_its_sign(span):
    arc, head = symbols.turn(0.0, span=span)
    angle = np.unwrap(np.arctan2(arc[:, 1], arc[:, 0]))
    assert np.sign(angle[-1] - angle[0]) == np.sign(span)
    tip, base = head[0], head[1:].mean(axis=0)
    assert np.sign(np.cross(np.append(base, 0), np.append(tip, 0))[2]) == np.sign(span)


def arrows(solution, rows):
    _, axes = equal_axes(Shapes(solution, rows).box, False)
    return [drawn for drawn in draw_loads(axes, solution, rows) if isinstance(drawn, Quiver)]


def test_a_force_is_drawn_at_its_point_along_its_direction(bent):
    (arrow,) = arrows(bent, np.array([0, 1]))
    end = bent.model.beams[0].end
    np.testing.assert_allclose([arrow.X[0], arrow.Y[0]], bent.position(end)[-1], atol=1e-12)
    assert arrow.U[0] == 0.0
    assert arrow.V[0] > 0.0


@pytest.mark.parametrize("unit", [1.0, 1e5])
def test_arrows_are_as_long_as_the_root_of_their_force_whatever_its_unit(unit):
    """The largest is 30 points long; of forces 9 and 4 the shorter has two thirds of that."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Section.from_stiffness(1e9, 1e9, 1e9, 1.0, 1.0))
    loads = [bf.PointForce(beam.at(at), (0.0, size * unit)) for at, size in ((0.25, 9.0), (0.75, 4.0))]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    (drawn,) = arrows(solution, np.array([1]))
    assert np.hypot(drawn.U, drawn.V) == pytest.approx([30.0 / 72.0, 20.0 / 72.0], rel=1e-6)


def test_a_follower_turns_with_the_section():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 2 * EI), follower=True)])
    solution = bf.solve_static(model)
    (arrow,) = arrows(solution, np.array([len(solution) - 1]))
    angle = solution.rotation(beam.end)[-1] + 0.5 * np.pi
    assert np.arctan2(arrow.V[0], arrow.U[0]) == pytest.approx(angle, abs=1e-12)


def test_a_load_is_drawn_where_it_is_largest():
    """Of a ramp that comes and goes, that is neither the first nor the last row."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1e3))
    push = bf.PointForce(beam.start, (8.0, 0.0), amplitude=lambda t: float(np.interp(t, [0, 1, 2], [0, 1, 0])))
    solution = bf.simulate(bf.Model([beam], loads=[push]), 2.0, 0.1)
    (arrow,) = arrows(solution, np.array([0, 5, 10, 20]))
    np.testing.assert_allclose([arrow.X[0], arrow.Y[0]], solution.position(beam.start)[10], atol=1e-12)
    assert arrows(solution, np.array([0, 20])) == []


@pytest.mark.parametrize("kind", [bf.Pressure, bf.DistributedLoad])
def test_a_load_that_acts_between_the_arrows_is_drawn_where_it_is(kind):
    def narrow(arc_length):
        size = 0.1 * EI if 0.42 < arc_length < 0.48 else 0.0
        return size if kind is bf.Pressure else (0.0, size)

    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SECTION, STEEL)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [kind(beam, narrow)]))
    (row,) = arrows(solution, np.array([len(solution) - 1]))
    length = np.hypot(row.U, row.V)
    x = np.asarray(row.X)[length > 0.0]
    assert 0.42 < x.min() <= x.max() < 0.48


def test_loads_of_a_vibration_are_those_of_its_equilibrium():
    """About the reference none act; about the loaded state the load is there at all times."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.5 * EI, 0.0))])
    pulled = bf.solve_static(model)
    assert arrows(bf.solve_modes(model, 1).solution(), np.array([0, 3])) == []
    assert len(arrows(bf.solve_modes(model, 1, about=pulled).solution(), np.array([0, 3]))) == 1


def test_every_load_is_drawn(framed):
    axes = framed.plot().axes[0]
    # gravity, one row a distributed load and the forces, inside and at the ends
    assert sum(isinstance(child, Quiver) for child in axes.get_children()) >= 4
    colours = [c.get_edgecolor()[0] for c in axes.collections if isinstance(c, PathCollection)]
    red = np.array([int(FORCE[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    assert any(np.allclose(colour[:3], red) for colour in colours)  # the moment
    assert [text.get_text() for text in axes.texts] == ["g"]


def test_history_shows_the_curves_of_points(falling, tmp_path):
    end = falling.model.beams[0].end
    (axes,) = falling.plot_history(end, path=tmp_path / "a" / "history.svg").axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time [s]", "displacement [m]")
    for column, line in enumerate(axes.lines):
        np.testing.assert_array_equal(line.get_ydata(), falling.displacement(end)[:, column])
        np.testing.assert_array_equal(line.get_xdata(), falling.time)
    assert "<svg" in (tmp_path / "a" / "history.svg").read_text()
    (axes,) = falling.plot_history([end, falling.model.beams[0].at(0.5)], "rotation").axes
    assert [line.get_label() for line in axes.lines] == ["rotation at (1, 0)", "rotation at (0.5, 0)"]
    (axes,) = falling.plot_history(quantity="energy").axes
    assert [line.get_label() for line in axes.lines] == ["kinetic", "strain", "potential", "total"]
    np.testing.assert_array_equal(axes.lines[3].get_ydata(), falling.energy().total)


def test_history_of_a_reaction(bent):
    start = bent.model.beams[0].start
    (axes,) = bent.plot_history(start, "reaction_moment").axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("load factor [-]", "reaction moment [N m]")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), bent.reaction(start)[:, 2])


def test_path_marks_its_limit_points():
    path = arch()
    point = path.model.beams[1].at(0.2)
    (axes,) = plot_load_displacement(path, point).axes
    curve, marks = axes.lines[1], axes.lines[2]
    np.testing.assert_array_equal(curve.get_ydata(), path.load_factor)
    assert len(path.limit_points) >= 1
    np.testing.assert_allclose(marks.get_ydata(), [state.load_factor for state in path.limit_points])
    np.testing.assert_allclose(marks.get_xdata(), [state.displacement(point)[1] for state in path.limit_points])
    assert axes.texts[0].get_text() == f"{path.limit_points[0].load_factor:.5g}"
    assert axes.get_ylabel() == "load factor [-]"
    assert path.plot().axes[1].get_ylabel() == "load factor [-]"


def test_modes_carry_their_frequencies(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(3), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
    modes = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 3)
    titles = [axes.get_title() for axes in modes.plot(tmp_path / "modes.png").axes if axes.get_visible()]
    assert titles == [f"{i + 1}: {value:.4g} Hz" for i, value in enumerate(modes.frequencies)]
    free = bf.solve_modes(bf.Model([beam]), 4)
    titles = [axes.get_title() for axes in free.plot(most=3).axes if axes.get_visible()]
    assert titles == [f"{i + 1}: {free.rigid[i]}" for i in range(3)]
    column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1.0, 0.0))])
    buckling = bf.solve_buckling(column, 2)
    figure = buckling.plot()
    assert figure.axes[0].get_title() == f"1: load factor {buckling.load_factors[0]:.5g}"
    strong = lines_of(figure.axes[0])[-1].get_segments()[0]
    np.testing.assert_allclose(strong[-1], buckling.solution(0).position(beam.end)[-1], atol=1e-12)


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda s: s.plot(colour="torsion"), "no quantity 'torsion' along a beam; did you mean tension"),
        (lambda s: s.plot(shapes=0), "shapes must be at least 1"),
        (lambda s: s.plot_history(s.model.beams[0].end, "torsion"), "no history of 'torsion'"),
        (
            lambda s: s.plot_history(s.model.beams[0].end, "ay"),
            r"""no history of 'ay'; plot_curve\("load_factor", \("ay", point\)\) draws it""",
        ),
        (lambda s: s.plot_history(), "needs a point such as beam.end"),
        (lambda s: s.plot_load_displacement(s.model.beams[0].end, "ut"), '"ux", "uy" or "rotation"'),
    ],
)
def test_what_cannot_be_drawn_is_named(bent, draw, message):
    with pytest.raises(bf.InputError, match=message):
        draw(bent)


def test_load_displacement_is_for_statics(falling):
    with pytest.raises(bf.InputError, match="no load factor"):
        falling.plot_load_displacement(falling.model.beams[0].end)


def test_a_picture_needs_no_window_and_leaves_no_global_state(tmp_path):
    code = "import sys; sys.path[:0] = ['tests']; import drawn; drawn.cantilever().plot('bent.png'); "
    code += "print([name for name in ('matplotlib.pyplot', 'vtkmodules', 'pyvista') if name in sys.modules])"
    gone = {"DISPLAY", "WAYLAND_DISPLAY", "MPLBACKEND"}
    environment = {name: value for name, value in os.environ.items() if name not in gone}
    code = code.replace("'tests'", repr(os.path.dirname(os.path.dirname(__file__))))
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, env=environment, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "[]"
    assert (tmp_path / "bent.png").stat().st_size > 5000


@pytest.mark.parametrize("colour", ["stress", "utilisation"])
def test_stress_is_painted_over_the_height(colour):
    """M / W at the faces and sqrt(3) times 1.5 V / A on the axis, which was painted as the faces were."""
    force, width, height, strength = 1e3, 0.05, 0.1, 2e8
    steel = bf.Material(2e11, 0.3, 7800.0, strength=strength)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(width, height), steel)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -force))])
    shapes = Shapes(bf.solve_static(model), np.array([1]), colour)
    (strips,) = shapes.strips(0)
    size = strength if colour == "utilisation" else 1.0
    faces, field = strips[0]
    assert field[0, 0] * size == pytest.approx(6.0 * force / (width * height**2), rel=1e-4)
    assert faces[0, 0] == pytest.approx([0.0, -0.5 * height], abs=1e-12)
    faces, field = strips[len(strips) // 2]
    assert field[0, 0] * size == pytest.approx(np.sqrt(3.0) * 1.5 * force / (width * height), rel=1e-3)
    assert faces[0, 0] == pytest.approx([0.0, 0.0], abs=1e-12)
    low, high = shapes.limits
    assert low < 0.05 * high
    assert strips[-1][1][0, 1] == pytest.approx(strips[0][1][0, 0], rel=1e-6)
