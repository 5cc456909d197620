"""Curves of DXF files that ezdxf writes here: where they run, and what is refused."""

import builtins
import math

import numpy as np
import pytest
from scipy.special import ellipeinc

from beamfem.curves import Arc, BSpline, Chain, Line, Polyline
from beamfem.errors import BeamfemError, InputError
from beamfem.io.cad import read_dxf

ezdxf = pytest.importorskip("ezdxf")
BELOW = {"extrusion": (0, 0, -1)}


@pytest.fixture
def read(tmp_path):
    """Read what a function draws."""

    def written(draw, layer=None):
        drawing = ezdxf.new()
        draw(drawing.modelspace())
        drawing.saveas(tmp_path / "drawing.dxf")
        return read_dxf(tmp_path / "drawing.dxf", layer)

    return written


def along(curve, count=33):
    return curve.position(np.linspace(0.0, curve.length, count))


def one(curves, kind):
    (curve,) = curves
    assert isinstance(curve, kind)
    return curve


def test_a_line(read):
    assert read(lambda space: space.add_line((1, 2), (3, -4))) == (Line((1, 2), (3, -4)),)


def test_arcs_and_a_circle(read):
    def draw(space):
        space.add_arc((1, 2), 3, 350, 20)
        space.add_arc((1, 2), 3, 350, 20, dxfattribs=BELOW)
        space.add_circle((1, 2), 3)

    arc, mirrored, circle = read(draw)
    assert arc.length == pytest.approx(3 * math.radians(30), rel=1e-14)
    assert np.allclose(along(arc)[0], (1 + 3 * math.cos(math.radians(-10)), 2 - 3 * math.sin(math.radians(10))))
    assert np.abs(along(mirrored) - along(arc) * (-1, 1)).max() < 1e-14
    assert circle.length == pytest.approx(6 * np.pi, rel=1e-15)
    assert isinstance(circle, Arc)


def test_a_polyline_of_straight_pieces(read):
    points = [(0, 0), (1, 0), (1, 0), (1, 2)]

    def draw(space):
        space.add_lwpolyline(points)
        space.add_lwpolyline(points, close=True)
        space.add_polyline2d(points)
        space.add_polyline3d([(x, y, 0) for x, y in points])

    light, closed, flat, spatial = read(draw)
    assert light == flat == spatial == Polyline(((0, 0), (1, 0), (1, 2)))
    assert closed == Polyline(((0, 0), (1, 0), (1, 2), (0, 0)))


def test_the_control_frame_of_a_smoothed_polyline_is_not_drawn(read):
    def draw(space):
        polyline = space.add_polyline2d([(0, 0), (1, 9), (1, 1), (2, 0)])
        polyline.vertices[1].dxf.flags |= 16

    assert read(draw) == (Polyline(((0, 0), (1, 1), (2, 0))),)


@pytest.mark.parametrize("kind", ["add_lwpolyline", "add_polyline2d"])
def test_a_polyline_with_bulges(read, kind):
    """A slot: straight, half a circle to the left, straight back, half a circle that closes it."""
    slot = [(0, 0, 0), (4, 0, 1), (4, 2, 0), (0, 2, 1)]

    def draw(space):
        getattr(space, kind)(slot, format="xyb", close=True)
        getattr(space, kind)(slot, format="xyb", close=True, dxfattribs=BELOW)

    curve, mirrored = read(draw)
    assert isinstance(curve, Chain)
    assert curve.length == pytest.approx(8 + 2 * np.pi, rel=1e-15)
    assert curve.corners == ()
    s = np.array([2, 4 + np.pi / 2, 6 + np.pi, 8 + 1.5 * np.pi])
    expected = np.array([(2, 0), (5, 1), (2, 2), (-1, 1)])
    assert np.abs(curve.position(s) - expected).max() < 1e-14
    assert np.abs(mirrored.position(s) - expected * (-1, 1)).max() < 1e-14


@pytest.mark.parametrize("bulge", [1e-12, 1e-8, 0.9e-4, 1.1e-4, 0.5, -0.5, 3.0])
def test_an_arc_of_any_bulge(read, bulge):
    """Sagitta: bulge times half the chord; circle: the same distance to the center everywhere."""
    curve = one(read(lambda space: space.add_lwpolyline([(1, 1, bulge), (1, 3, 0)], format="xyb")), (Arc, BSpline))
    assert np.abs(along(curve)[[0, -1]] - [(1, 1), (1, 3)]).max() < 1e-11
    assert along(curve, 3)[1] == pytest.approx((1 + bulge, 2), rel=1e-11)
    assert curve.length == pytest.approx(2 * math.atan(bulge) * (1 + bulge**2) / bulge, rel=1e-11)


def test_a_spline_keeps_its_numbers(read):
    knots = (0, 0, 0, 0, 0.3, 1, 1, 1, 1)
    points = ((0, 0), (1, 2), (2, -1), (3, 1), (4, 0))

    def draw(space):
        space.add_open_spline([(x, y, 0) for x, y in points], knots=knots)
        space.add_rational_spline([(x, y, 0) for x, y in points], weights=(1, 2, 1, 3, 1), knots=knots)

    plain, rational = read(draw)
    assert plain == BSpline(3, knots, points)
    assert rational == BSpline(3, knots, points, (1, 2, 1, 3, 1))


def test_a_spline_of_fit_points_goes_through_them(read):
    points = np.array([(0, 0), (1, 1), (2, 0), (4, 1)])
    curve = one(read(lambda space: space.add_spline([(x, y, 0) for x, y in points])), BSpline)
    dense = along(curve, 4001)
    assert max(np.hypot(*(dense - point).T).min() for point in points) < curve.length / 4000
    assert np.abs(dense[[0, -1]] - points[[0, -1]]).max() < 1e-14


def test_ellipses(read):
    """Axis of 3 along (0.6, 0.8), half as high; a part, its mirror image, and the whole."""

    def draw(space):
        space.add_ellipse((1, 2), (1.8, 2.4), 0.5, 5.0, 7.0)
        space.add_ellipse((1, 2), (1.8, 2.4), 0.5, 5.0, 7.0, dxfattribs=BELOW)
        space.add_ellipse((1, 2), (1.8, 2.4), 0.5)

    part, mirrored, whole = read(draw)
    m = 0.75
    assert part.length == pytest.approx(3 * (ellipeinc(np.pi / 2 - 5, m) - ellipeinc(np.pi / 2 - 7, m)), rel=1e-14)
    assert whole.length == pytest.approx(3 * (ellipeinc(2 * np.pi, m)), rel=1e-14)
    assert whole.corners == ()
    first, second = np.array([0.6, 0.8]), np.array([-0.8, 0.6])
    for curve, sense in ((part, 1), (mirrored, -1)):
        local = along(curve) - (1, 2)
        assert np.abs((local @ first / 3) ** 2 + (local @ second / 1.5) ** 2 - 1).max() < 1e-14
        for row, angle in ((0, 5.0), (-1, 7.0)):
            expected = 3 * math.cos(angle) * first + sense * 1.5 * math.sin(angle) * second
            assert np.abs(local[row] - expected).max() < 1e-14


def test_only_one_layer(read):
    def draw(space):
        space.add_line((0, 0), (1, 0), dxfattribs={"layer": "Axes"})
        space.add_line((0, 1), (1, 1), dxfattribs={"layer": "Ties"})

    assert read(draw, "axes") == (Line((0, 0), (1, 0)),)
    assert len(read(draw)) == 2
    with pytest.raises(InputError, match=r"nothing is drawn in layer 'beams'; known are Axes, Ties"):
        read(draw, "beams")


def annotate(space):
    """Write beside a curve what drawings hold."""
    here = {"layer": "notes"}
    space.add_text("a beam", dxfattribs=here)
    space.add_mtext("of steel", dxfattribs=here)
    space.add_linear_dim(base=(0, 2), p1=(0, 0), p2=(3, 0), dxfattribs=here).render()
    space.add_radius_dim(center=(0, 0), radius=2, angle=45, dxfattribs=here).render()
    space.add_leader([(0, 0), (1, 1)], dxfattribs=here)
    space.add_hatch(dxfattribs=here).paths.add_polyline_path([(0, 0), (1, 0), (1, 1)])


def test_texts_and_dimensions_are_passed_over(read):
    def draw(space):
        annotate(space)
        space.add_line((0, 0), (3, 0))
        annotate(space)

    assert read(draw) == (Line((0, 0), (3, 0)),)
    with pytest.raises(InputError, match=r"nothing is drawn in layer 'notes'"):
        read(draw, "notes")
    with pytest.raises(InputError, match=r"nothing is drawn in its modelspace, only annotation"):
        read(annotate)


TILTED = {"extrusion": (0, 0.6, 0.8)}
BAD = {
    "nothing": (lambda space: None, "nothing is drawn"),
    "line off the plane": (lambda space: space.add_line((0, 0, 0), (1, 0, 1)), r"LINE on layer '0'.* z = 1"),
    "tilted arc": (lambda space: space.add_arc((0, 0), 1, 0, 90, dxfattribs=TILTED), "ARC .*normal is .0, 0.6, 0.8"),
    "circle off the plane": (lambda space: space.add_circle((0, 0, 2), 1), "CIRCLE .* z = 2"),
    "polyline off the plane": (
        lambda space: space.add_lwpolyline([(0, 0), (1, 0)], dxfattribs={"elevation": 3}),
        "LWPOLYLINE .*reaches z = 3",
    ),
    "old polyline off the plane": (
        lambda space: space.add_polyline2d([(0, 0), (1, 0)], dxfattribs={"elevation": (0, 0, 3)}),
        "POLYLINE .* z = 3",
    ),
    "polyline in space": (lambda space: space.add_polyline3d([(0, 0, 0), (1, 0, 1)]), "POLYLINE .* z = 1"),
    "polyline of one point": (lambda space: space.add_lwpolyline([(0, 0), (0, 0)]), "at least two points"),
    "surface": (lambda space: space.add_polyface(), "not a curve"),
    "spline in space": (lambda space: space.add_spline([(0, 0, 0), (1, 0, 1), (2, 0, 0)]), "SPLINE .* z = 1"),
    "ellipse in space": (lambda space: space.add_ellipse((0, 0, 1), (1, 0, 0), 0.5), "ELLIPSE .* z = 1"),
    "line without length": (lambda space: space.add_line((1, 1), (1, 1)), "LINE .*two different points"),
    "spline with a cusp": (
        lambda space: space.add_open_spline([(0, 0), (1, 1), (0, 1), (1, 0)]),
        "SPLINE on layer '0', handle .*stands still",
    ),
    "point": (lambda space: space.add_point((0, 0)), r"POINT on layer '0', handle [0-9A-F]+, is no curve"),
    "empty block": (lambda space: (space.doc.blocks.new("B"), space.add_blockref("B", (0, 0))), "nothing is drawn"),
    "block in itself": (
        lambda space: (space.doc.blocks.new("B").add_blockref("B", (0, 0)), space.add_blockref("B", (0, 0))),
        "recursion",
    ),
}


def test_blocks_are_read_where_they_are_inserted(read):
    def draw(space):
        inner = space.doc.blocks.new("INNER")
        inner.add_line((0, 0), (1, 0))
        inner.add_text("a note")
        outer = space.doc.blocks.new("OUTER")
        outer.add_arc((0, 0), 1.0, 0.0, 90.0, dxfattribs={"layer": "arcs"})
        outer.add_blockref("INNER", (2, 0), dxfattribs={"rotation": 90})
        space.add_blockref("OUTER", (10, 0), dxfattribs={"xscale": 2, "yscale": 2, "layer": "axes"})
        space.add_blockref("INNER", (0, 5), dxfattribs={"column_count": 3, "column_spacing": 4.0})

    arc, line, *row = read(draw)
    np.testing.assert_allclose(along(arc, 3), [(12, 0), (10 + 2**0.5, 2**0.5), (10, 2)], atol=1e-9)
    np.testing.assert_allclose([line.start, line.end], [(14, 0), (14, 2)], atol=1e-9)
    np.testing.assert_allclose([one.start for one in row], [(0, 5), (4, 5), (8, 5)], atol=1e-9)
    assert len(read(draw, "axes")) == 1  # what is on layer 0 of a block is on the layer of its insert
    assert isinstance(one(read(draw, "arcs"), Arc), Arc)


@pytest.mark.parametrize("case", BAD)
def test_bad_drawings_are_named(read, case):
    draw, words = BAD[case]
    with pytest.raises(InputError, match=words):
        read(draw)


def test_no_file_and_no_drawing(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"no file .*none\.dxf"):
        read_dxf(tmp_path / "none.dxf")
    (tmp_path / "text.dxf").write_text("a letter")
    with pytest.raises(InputError, match="not a DXF file"):
        read_dxf(tmp_path / "text.dxf")


def test_without_ezdxf_the_message_says_what_to_install(monkeypatch, tmp_path):
    original = builtins.__import__

    def without(name, *rest, **options):
        if name.split(".")[0] == "ezdxf":
            raise ModuleNotFoundError(name=name)
        return original(name, *rest, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(BeamfemError, match=r'pip install "beamfem\[cad\]"'):
        read_dxf(tmp_path / "none.dxf")
