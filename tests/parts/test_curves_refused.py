"""Data that describes no curve, each named."""

import math

import pytest

from beamfem.curves import Arc, BSpline, Chain, Line, Parametric, Polyline, elliptic_arc, spline_through_hermite
from beamfem.errors import InputError

QUARTER = BSpline(2, (0, 0, 0, 1, 1, 1), ((2, 0), (2, 2), (0, 2)), (1, math.sqrt(0.5), 1))
K = (0, 0, 0, 0, 1, 1, 1, 1)
P = ((0, 0), (1, 1), (2, 1), (3, 0))
BAD = {
    "arc without radius": (lambda: Arc((0, 0), 0.0, 0, 1), "radius"),
    "arc with a center of one number": (lambda: Arc((0,), 1.0, 0, 1), "center"),
    "arc with text": (lambda: Arc((0, 0), 1.0, "0", 1), "start_angle"),
    "arc that ends where it starts": (lambda: Arc((0, 0), 1.0, 1, 1), "two different angles"),
    "polyline of one point": (lambda: Polyline(((0, 0),)), "at least two points"),
    "polyline that stands still": (lambda: Polyline(((0, 0), (1, 1), (1, 1))), "points 1 and 2"),
    "polyline of numbers": (lambda: Polyline((0, 1)), r"points\[0\]"),
    "polyline of one number": (lambda: Polyline(3), "points must be a list"),
    "chain of nothing": (lambda: Chain(()), "at least one curve"),
    "chain of points": (lambda: Chain(((0, 0), (1, 1))), r"curves\[0\]"),
    "chain with a gap": (
        lambda: Chain((Line((0, 0), (1, 0)), Line((1, 1e-4), (2, 0)))),
        r"curves\[1\] of a Chain must start where curves\[0\] ends",
    ),
    "degree zero": (lambda: BSpline(0, (0, 1), ((0, 0),)), "degree"),
    "too few points": (lambda: BSpline(3, K[1:], P[1:]), "control_points: degree 3 needs at least 4, got 3"),
    "a knot too few": (lambda: BSpline(3, K[1:], P), "4 control points of degree 3 need 8, got 7"),
    "knots that decrease": (lambda: BSpline(3, (0, 0, 0, 0, 1, 1, 2, 1), P), r"knots\[7\] is 1"),
    "a knot of nan": (lambda: BSpline(3, (0, 0, 0, math.nan, 1, 1, 1, 1), P), r"knots\[3\]"),
    "equal knots": (lambda: BSpline(3, (0, 0, 0, 1, 1, 1, 2, 2), P), "all equal"),
    "a spline in two parts": (lambda: BSpline(1, (0, 0, 1, 1, 2, 2), P), "falls apart beyond 1"),
    "points without use": (lambda: BSpline(1, (0, 0, 1, 2, 2, 2), P), "without use"),
    "a weight too many": (lambda: BSpline(3, K, P, (1,) * 5), "weights: 4 control points need 4, got 5"),
    "a weight of zero": (lambda: BSpline(3, K, P, (1, 1, 0, 1)), r"weights\[2\]"),
    "a point of three numbers": (lambda: BSpline(3, K, (*P[:3], (1, 2, 3))), r"control_points\[3\]"),
    "a cusp inside": (lambda: BSpline(3, K, ((0, 0), (1, 1), (0, 1), (1, 0))), r"stands still at u = 0\.5"),
    "a cusp at the start": (lambda: BSpline(3, K, ((0, 0), (0, 0), (0, 1), (1, 0))), "stands still at u = 0"),
    "a straight spline that turns back": (lambda: BSpline(2, (0, 0, 0, 1, 1, 1), ((0, 0), (2, 0), (0, 0))), "u = 0.5"),
    "no length": (lambda: BSpline(3, K, ((1, 1),) * 4), "no length"),
    "parallel half diameters": (lambda: elliptic_arc((0, 0), (1, 1), (2, 2), 0, 1), "parallel"),
    "an elliptic arc without end": (lambda: elliptic_arc((0, 0), (1, 0), (0, 2), 1, 1), "two different angles"),
    "no function": (lambda: Parametric(3, 0, 1), "function of a Parametric"),
    "no derivative": (lambda: Parametric(lambda u: (u, u), 0, 1, 3), "derivative of a Parametric"),
    "a function without range": (lambda: Parametric(lambda u: (u, u), 1, 1), "two different parameters"),
    "a function of one value": (lambda: Parametric(lambda u: u, 0, 1), "must be two numbers"),
    "a function of nan": (lambda: Parametric(lambda u: (u, math.nan), 0, 1), "two finite numbers"),
    "a function with a corner": (lambda: Parametric(lambda u: (u, abs(u - 0.5)), 0, 1), r"corner at u = 0\.5"),
    "a function with a corner elsewhere": (lambda: Parametric(lambda u: (u, abs(u - 0.3)), 0, 1), "not smooth near"),
    "a function with a cusp": (lambda: Parametric(lambda u: (u**2, u**3), -1, 1.3), "stands still"),
    "a function at rest": (lambda: Parametric(lambda u: (0 * u, 1), 0, 1), "no length"),
    "a wrong derivative": (lambda: Parametric(lambda u: (u, u**2), 0, 1, lambda u: (1, u)), "not that of function"),
    "hermite of degree 2": (QUARTER.hermite, "degree 3.*degree 2.*spline_through_hermite"),
    "hermite with weights": (lambda: BSpline(3, K, P, (1, 2, 1, 1)).hermite(), "weights"),
    "hermite with a triple knot": (
        lambda: BSpline(3, (0, 0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1, 1), (*P, (4, 1), (5, 1), (6, 0))).hermite(),
        r"knot 0\.5, which appears 3 times",
    ),
    "hermite backwards": (lambda: spline_through_hermite((1, 0), P[:2], P[1:3]), "increasing"),
    "hermite with a point too many": (lambda: spline_through_hermite((0, 1), P[:3], P[1:3]), "r must be 2"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_named(case):
    make, words = BAD[case]
    with pytest.raises(InputError, match=words):
        make()
