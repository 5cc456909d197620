"""Curves: closed forms of arc length and tangent, splines, and data that describes no curve."""

import itertools
import json
import math
import pickle
from dataclasses import fields

import numpy as np
import pytest
from scipy.interpolate import BSpline as Spline
from scipy.special import ellipeinc

from beamfem.curves import (
    Arc,
    BSpline,
    Chain,
    Curve,
    Line,
    Parametric,
    Polyline,
    elliptic_arc,
    spline_through_hermite,
    without_removable_knots,
)
from beamfem.errors import InputError, SeveralTurnsWarning

QUARTER = BSpline(2, (0, 0, 0, 1, 1, 1), ((2, 0), (2, 2), (0, 2)), (1, math.sqrt(0.5), 1))
WAVE = BSpline(3, (0, 0, 0, 0, 0.2, 0.7, 1, 1, 1, 1), ((0, 0), (1, 2), (2, -1), (3, 1), (4, 0), (5, 1)))
UNCLAMPED = BSpline(3, (-3, -2.5, -1, 0, 1, 1.5, 3, 4, 5), ((0, 0), (1, 2), (2, -1), (3, 1), (4, 0)))
ANGULAR = BSpline(2, (0, 0, 0, 0.5, 0.5, 1, 1, 1), ((0, 0), (1, 0), (1, 1), (2, 1), (2, 3)))
with pytest.warns(SeveralTurnsWarning):
    COIL = Arc((1, 2), 0.7, 0.3, -13.0)
CURVES = {
    "line": Line((1, 2), (4, -2)),
    "arc": Arc((1, 2), 0.7, 0.3, 4.0),
    "clockwise arc of two turns": COIL,
    "polyline": Polyline(((0, 0), (1, 0), (2, 0), (2, 3))),
    "wave": WAVE,
    "unclamped": UNCLAMPED,
    "rational": QUARTER,
    "spline with a corner": ANGULAR,
    "chain": Chain((Line((0, 0), (1, 0)), Arc((1, 1), 1, -np.pi / 2, 0), Polyline(((2, 1), (2, 2), (3, 2))))),
    "function": Parametric(lambda u: (u, np.sin(3 * u)), 0.0, 2.0),
    "function of one number, backwards": Parametric(lambda u: (u, math.exp(u)), 1.0, -1.0),
}


@pytest.fixture(params=CURVES)
def curve(request) -> Curve:
    return CURVES[request.param]


def stations(curve, reach):
    """Arc lengths at which differences do not reach over an end, a corner or a jump of a higher derivative."""
    rough = list(curve.corners)
    if isinstance(curve, BSpline):
        rough += list(curve._arc_length.at(curve.breaks))
    if isinstance(curve, Chain):
        rough += np.cumsum([part.length for part in curve.curves]).tolist()
    s = np.linspace(2 * reach, curve.length - 2 * reach, 97)
    return s[[all(abs(each - place) > 2 * reach for place in rough) for each in s]]


def test_tangents_are_unit_vectors(curve):
    tangent = curve.tangent(np.linspace(0.0, curve.length, 101))
    assert np.abs(np.hypot(*tangent.T) - 1.0).max() < 1e-15 * 4


def test_the_tangent_is_the_derivative_by_arc_length(curve):
    """Central differences of sixth order; round-off of positions of 1e-15 over the step, truncation below it."""
    step = 2e-4 * curve.length
    s = stations(curve, 3 * step)
    weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    rate = sum(w * (curve.position(s + k * step) - curve.position(s - k * step)) for k, w in weights.items()) / step
    assert np.abs(rate - curve.tangent(s)).max() < 2e-11
    assert np.abs(np.hypot(*rate.T) - 1.0).max() < 2e-11


@pytest.mark.filterwarnings("ignore::beamfem.errors.SeveralTurnsWarning")
def test_saved_members_make_the_same_curve(curve):
    if isinstance(curve, Parametric):
        curve = curve.spline()
    if isinstance(curve, Chain):
        curve = curve.curves[1]
    members = {field.name: getattr(curve, field.name) for field in fields(curve)}
    assert type(curve)(**json.loads(json.dumps(members))) == curve
    assert pickle.loads(pickle.dumps(curve)) == curve


def test_questions_without_points_have_answers_without_points(curve):
    assert curve.position(np.array([])).shape == curve.tangent(np.array([])).shape == (0, 2)


def test_full_turns_of_an_arc():
    with pytest.warns(SeveralTurnsWarning):
        arc = Arc((1.0, 2.0), 0.5, np.pi / 2, -5 * np.pi)
    assert arc.length == pytest.approx(0.5 * 5.5 * np.pi, rel=1e-15)
    quarter = 0.25 * np.pi
    assert np.allclose(arc.position(np.array([0.0, quarter, 9 * quarter])), [(1, 2.5), (1.5, 2), (1.5, 2)], atol=1e-15)
    assert np.allclose(arc.tangent(np.array([0.0, quarter])), [(1, 0), (0, -1)], atol=1e-15)


@pytest.mark.parametrize(
    ("make", "what"),
    [
        (lambda turn: Arc((0, 0), 1, 0, turn), "arc"),
        (lambda turn: Arc((0, 0), 1, end_angle=0, start_angle=turn), "arc"),
        (lambda turn: elliptic_arc((0, 0), (1, 0), (0, 2), 0, turn), "elliptic arc"),
    ],
)
def test_degrees_in_place_of_radians_are_warned_of(make, what):
    with pytest.warns(SeveralTurnsWarning) as caught:
        make(90)
    (warning,) = caught
    said = "turns by 90 rad, more than one full turn; angles are in radians: for 90 degrees give np.radians(90)"
    assert str(warning.message) == f"the {what} {said}"
    assert warning.filename == __file__
    make(2 * np.pi)  # a whole turn, and one by sums with round-off, are none
    make(sum([0.1 * np.pi] * 20))


def test_quarter_circle_as_a_rational_spline_is_the_arc():
    arc = Arc((0, 0), 2.0, 0.0, np.pi / 2)
    s = np.linspace(0.0, arc.length, 57)
    assert QUARTER.length == pytest.approx(arc.length, rel=1e-14)
    assert np.abs(QUARTER.position(s) - arc.position(s)).max() < 1e-13
    assert np.abs(QUARTER.tangent(s) - arc.tangent(s)).max() < 1e-13
    assert elliptic_arc((0, 0), (2, 0), (0, 2), 0, np.pi / 2) == BSpline(
        2, QUARTER.knots, elliptic_arc((0, 0), (2, 0), (0, 2), 0, np.pi / 2).control_points, QUARTER.weights
    )


def parabola(x):
    """Arc length of y = x^2 from the origin."""
    return x * math.sqrt(1 + 4 * x * x) / 2 + math.asinh(2 * x) / 4


def ellipse(a, b, start, end):
    """Arc length of (a cos t, b sin t), a > b."""
    m = 1 - b * b / a / a
    return a * (ellipeinc(np.pi / 2 - start, m) - ellipeinc(np.pi / 2 - end, m))


CLOSED_FORMS = {
    "circle": (Parametric(lambda u: (np.cos(u), np.sin(u)), 0, 2 * np.pi), 2 * np.pi),
    "parabola": (Parametric(lambda u: (u, u * u), 0, 1.5), parabola(1.5)),
    "parabola, derivative given": (Parametric(lambda u: (u, u**2), 0, 1.5, lambda u: (1, 2 * u)), parabola(1.5)),
    "parabola as a spline": (BSpline(2, (0, 0, 0, 1.5, 1.5, 1.5), ((0, 0), (0.75, 0), (1.5, 2.25))), parabola(1.5)),
    "ellipse": (Parametric(lambda u: (3 * math.cos(u), math.sin(u)), 0.3, 4.0), ellipse(3, 1, 0.3, 4.0)),
    "ellipse as a spline": (elliptic_arc((1, 2), (3, 0), (0, 1), 0.3, 4.0), ellipse(3, 1, 0.3, 4.0)),
    "flat ellipse": (elliptic_arc((1, 2), (3, 0), (0, 0.01), 0.0, 2 * np.pi), ellipse(3, 0.01, 0, 2 * np.pi)),
    "line, then parabola": (Parametric(lambda u: (u, np.maximum(u - 0.3, 0) ** 2), 0, 1), 0.3 + parabola(0.7)),
}


@pytest.mark.parametrize("case", CLOSED_FORMS)
def test_arc_length_in_closed_form(case):
    curve, length = CLOSED_FORMS[case]
    assert curve.length == pytest.approx(length, rel=2e-15 * 4)


def test_positions_at_arc_lengths_in_closed_form():
    """Logarithmic spiral r = e^(u): s = sqrt(2) (e^u - 1); over e^3 in speed."""
    spiral = Parametric(lambda u: (np.exp(u) * np.cos(u), np.exp(u) * np.sin(u)), 0.0, 3.0)
    s = np.linspace(0.0, spiral.length, 301)
    u = np.log1p(s / math.sqrt(2))
    expected = np.exp(u)[:, None] * np.stack([np.cos(u), np.sin(u)], axis=1)
    assert np.abs(spiral.position(s) - expected).max() < 1e-13 * spiral.length
    angle = u + np.pi / 4
    assert np.abs(spiral.tangent(s) - np.stack([np.cos(angle), np.sin(angle)], axis=1)).max() < 1e-12


def test_a_function_as_a_spline_is_the_same_curve():
    curve = CURVES["function"]
    spline = curve.spline()
    s = np.linspace(0.0, curve.length, 201)
    assert spline.length == pytest.approx(curve.length, rel=1e-14)
    assert np.abs(spline.position(s) - curve.position(s)).max() < 1e-13
    assert np.abs(spline.tangent(s) - curve.tangent(s)).max() < 1e-11
    assert spline.corners == ()


@pytest.mark.parametrize(
    "spline",
    [
        BSpline(1, (0, 0, 1, 1), ((1, 2), (4, -2))),
        BSpline(1, (0, 0, 0.1, 0.4, 1, 1), ((1, 2), (1.3, 1.6), (3.1, -0.8), (4, -2))),
        BSpline(3, (0, 0, 0, 0, 0.3, 1, 1, 1, 1), ((1, 2), (1.3, 1.6), (2.2, 0.4), (3.7, -1.6), (4, -2))),
        BSpline(2, (0, 0, 0, 1, 1, 1), ((1, 2), (1.6, 1.2), (4, -2)), (1, 5, 2)),
    ],
    ids=["degree 1", "degree 1 in pieces", "cubic", "rational"],
)
def test_a_straight_spline_is_the_line(spline):
    line = Line((1, 2), (4, -2))
    s = np.linspace(0.0, line.length, 211)
    assert spline.length == pytest.approx(line.length, rel=1e-15)
    assert np.abs(spline.position(s) - line.position(s)).max() < 1e-14
    assert np.abs(spline.tangent(s) - line.tangent(s)).max() < 1e-14
    assert spline.corners == ()


def test_an_unclamped_spline_is_the_one_of_scipy():
    reference = Spline(np.array(UNCLAMPED.knots), np.array(UNCLAMPED.control_points), 3)
    ends = UNCLAMPED.position(np.array([0.0, UNCLAMPED.length]))
    assert np.abs(ends - reference([0.0, 1.5])).max() < 1e-14


def test_a_double_knot_at_the_end_of_an_unclamped_spline():
    """The span before the last knot is empty; the limit from inside counts."""
    spline = BSpline(2, (0, 1, 2, 3, 3, 4), ((0, 0), (1, 1), (2, 0)))
    reference = Spline(np.array(spline.knots), np.array(spline.control_points), 2)
    assert spline.length > 0
    assert np.abs(spline.position(np.array([spline.length])) - reference([np.nextafter(3, 2)])).max() < 1e-15


def sides(curve, corner):
    return curve.tangent(np.array([corner - 1e-12 * curve.length, corner, corner + 1e-12 * curve.length]))


@pytest.mark.parametrize(
    ("name", "corners", "before", "after"),
    [
        ("polyline", (2.0,), (1, 0), (0, 1)),
        ("chain", (2 + np.pi / 2,), (0, 1), (1, 0)),
        ("spline with a corner", (parabola(1.0),), (0, 1), (1, 0)),
    ],
)
def test_corners_and_the_tangents_beside_them(name, corners, before, after):
    curve = CURVES[name]
    if name == "spline with a corner":
        # from (0, 0) over (1, 0) to (1, 1): half of sqrt(2) times a parabola y = x^2 on both sides of its vertex
        corners = (math.sqrt(2) * parabola(0.5) * 2,)
    assert curve.corners == pytest.approx(corners, rel=1e-14)
    assert np.abs(sides(curve, curve.corners[0]) - [before, after, after]).max() < 1e-11


def test_a_degree_one_spline_is_a_polyline():
    points = ((0, 0), (1, 0), (3, 0), (3, 2), (1, 3))
    spline, polyline = BSpline(1, (0, 0, 1, 3, 4, 5, 5), points), Polyline(points)
    s = np.linspace(0, polyline.length, 83)
    assert spline.corners == pytest.approx(polyline.corners, rel=1e-15)
    assert polyline.corners == (3.0, 5.0)
    assert np.abs(spline.position(s) - polyline.position(s)).max() < 1e-14
    assert np.abs(sides(spline, spline.corners[1]) - sides(polyline, polyline.corners[1])).max() < 1e-14


def random_cubic(rng, multiplicities, weights=None):
    u = np.cumsum(rng.uniform(0.2, 2.0, len(multiplicities) + 2))
    knots = np.repeat(u, [4, *multiplicities, 4])
    control = np.column_stack([np.arange(len(knots) - 4), rng.uniform(-1, 1, len(knots) - 4)])
    return BSpline(3, knots, control, weights)


@pytest.mark.parametrize("seed", range(20))
def test_a_cubic_spline_survives_the_road_through_hermite(seed):
    rng = np.random.default_rng(seed)
    multiplicities = [[1] * 6, [2] * 6, [1, 2, 1, 1, 2, 2, 1], []][seed % 4]
    spline = random_cubic(rng, multiplicities)
    u, r, r_u = spline.hermite()
    exact = spline_through_hermite(u, r, r_u)
    assert exact.knots == tuple(np.repeat(u, [4, *[2] * (len(u) - 2), 4]))
    back = without_removable_knots(exact)
    assert back.knots == spline.knots
    assert np.abs(np.array(back.control_points) - spline.control_points).max() < 1e-13
    s = np.linspace(0.0, spline.length, 101)
    assert np.abs(exact.position(s) - spline.position(s)).max() < 1e-13


def test_hermite_data_are_the_cubic_on_every_span():
    u, r, r_u = WAVE.hermite()
    reference = Spline(np.array(WAVE.knots), np.array(WAVE.control_points), 3)
    assert np.abs(r - reference(u)).max() < 1e-15
    assert np.abs(r_u - reference(u, nu=1)).max() < 1e-14
    x = 0.37  # xi of a span; Hermite polynomials
    h = np.diff(u)[:, None]
    values = (
        (1 - 3 * x**2 + 2 * x**3) * r[:-1]
        + h * (x - 2 * x**2 + x**3) * r_u[:-1]
        + (3 * x**2 - 2 * x**3) * r[1:]
        + h * (x**3 - x**2) * r_u[1:]
    )
    assert np.abs(values - reference(u[:-1] + x * h[:, 0])).max() < 1e-14


def test_a_knot_with_a_small_jump_of_the_second_derivative_stays():
    u, r, r_u = WAVE.hermite()
    r_u[1, 0] += 1e-9
    assert without_removable_knots(spline_through_hermite(u, r, r_u)).multiplicity(u[1]) == 2


def test_the_advice_for_other_splines_makes_a_close_cubic():
    s = np.linspace(0.0, QUARTER.length, 17)
    cubic = spline_through_hermite(s, QUARTER.position(s), QUARTER.tangent(s))
    # error of cubic Hermite interpolation: h^4 / 384 |r''''|, here r'''' = 1 / R^3
    limit = s[1] ** 4 / 384 / 8
    middle = QUARTER.length * np.linspace(0, 1, 101)
    assert np.abs(np.hypot(*cubic.position(middle).T) - 2.0).max() < limit
    assert len(cubic.hermite()[0]) == 17


def test_one_arc_length_gives_one_point_and_one_tangent(curve):
    at = 0.3 * curve.length
    for method in (curve.position, curve.tangent):
        one = method(at)
        assert one.shape == (2,)
        assert np.array_equal(one, method(np.array([at]))[0])
        assert np.array_equal(method([0, at]), method(np.array([0.0, at])))


@pytest.mark.parametrize("beyond", [-0.01, 1.01, math.nan])
def test_arc_lengths_beyond_the_ends_are_refused(curve, beyond):
    """A line would go on, a spline stay at its end: neither is a point of the beam."""
    s = beyond * curve.length
    for method, given in itertools.product((curve.position, curve.tangent), (s, np.array([0.0, s]))):
        with pytest.raises(InputError, match=f"arc lengths along this {type(curve).__name__} go from 0 to "):
            method(given)
    with pytest.raises(InputError, match=r"arc_length must be a number, or an array \(n,\) of numbers, got 'end'"):
        curve.position("end")


def test_arc_lengths_at_the_ends_may_have_round_off(curve):
    last = curve.length * (1.0 + 1e-15)
    assert curve.position(last) == pytest.approx(curve.position(curve.length), abs=1e-12)
    assert curve.position(-1e-16) == pytest.approx(curve.position(0.0), abs=1e-12)
