"""Splines from other data: elliptic arcs, and cubic Hermite interpolation, which exports beams to CAD programs."""

from collections.abc import Sequence

import numpy as np

from beamfem.curves.bspline import BSpline
from beamfem.curves.curve import numbers, points, warn_of_turns
from beamfem.errors import InputError
from beamfem.validation import finite, shown, vector


def elliptic_arc(
    center: Sequence[float], first: Sequence[float], second: Sequence[float], start: float, end: float
) -> BSpline:
    """Return an elliptic arc as an exact rational spline.

    The arc is center + first cos a + second sin a, with a from start to end. Each piece of at most a quarter turn is a
    rational parabola whose middle weight is the cosine of half its angle. Raises InputError if start equals end or the
    semi-diameters are parallel. Warns with SeveralTurnsWarning for more than one full turn, which angles in degrees
    often cause.

    Parameters
    ----------
    center : (float, float), [m]
        Center (x, y).
    first, second : (float, float), [m]
        Conjugate semi-diameters (x, y), which are the semi-axes if they are perpendicular.
    start, end : float, [rad]
        Angles a at which the arc starts and ends.

    Examples
    --------
    >>> quarter = bf.elliptic_arc((0, 0), (2, 0), (0, 1), 0.0, np.pi / 2)
    >>> round(quarter.length, 4)
    2.4221
    """
    middle, one, two = (np.array(vector(*pair)) for pair in (("center", center), ("first", first), ("second", second)))
    begin, turn = finite("start", start), finite("end", end) - finite("start", start)
    if turn == 0.0:
        raise InputError(f"an elliptic arc needs two different angles, start and end are both {begin}")
    area = one[0] * two[1] - one[1] * two[0]
    if area == 0.0:
        raise InputError(f"the half diameters of an elliptic arc must not be parallel, got {first!r} and {second!r}")
    warn_of_turns("the elliptic arc", turn)
    pieces = max(1, int(np.ceil(abs(turn) / (np.pi / 2) - 1e-12)))
    angles = begin + turn * np.arange(2 * pieces + 1) / (2 * pieces)
    weights = np.ones(len(angles))
    weights[1::2] = np.cos(turn / (2 * pieces))
    # every other control point lies off the ellipse, at the intersection of the tangents at its neighbours
    table = middle + (np.outer(np.cos(angles), one) + np.outer(np.sin(angles), two)) / weights[:, None]
    inner = np.repeat(np.arange(pieces + 1.0), 2)
    return BSpline(2, (0.0, *inner, float(pieces)), points("control_points", table), tuple(weights))


# Two splines are the same up to this distance, as a fraction of their largest coordinate (times the ratio of
# neighbouring spans): about a hundred times the measured round-off.
_SAME = 1e-13


def spline_through_hermite(
    u: Sequence[float] | np.ndarray,
    r: Sequence[Sequence[float]] | np.ndarray,
    r_u: Sequence[Sequence[float]] | np.ndarray,
) -> BSpline:
    """Return the cubic spline with given positions and derivatives.

    It is exactly the cubic of each span; interior knots are double (see `without_removable_knots`). Raises InputError
    if u does not increase or the numbers of values do not match.

    Parameters
    ----------
    u : array_like, (m + 1,)
        Increasing parameters.
    r : array_like, [m], (m + 1, 2)
        Positions (x, y) at u.
    r_u : array_like, [m], (m + 1, 2)
        Derivatives dr/du at u.

    Examples
    --------
    >>> spline = bf.spline_through_hermite([0, 1], [(0, 0), (1, 1)], [(1, 0), (1, 0)])
    >>> spline.evaluate(np.array([0.5]))
    array([[0.5, 0.5]])
    """
    knots = np.array(numbers("u", u))
    if len(knots) < 2 or not np.all(np.diff(knots) > 0.0):
        raise InputError(f"u must be at least two increasing numbers, got {shown(u)}")
    position, rate = (np.array(points(name, values)) for name, values in (("r", r), ("r_u", r_u)))
    for name, values in (("r", position), ("r_u", rate)):
        if len(values) != len(knots):
            raise InputError(f"{name} must be {len(knots)} finite points (x, y), one for each u, got {len(values)}")
    return _spline(knots, _bezier(knots, position, rate), np.full(len(knots) - 2, 2))


def without_removable_knots(spline: BSpline) -> BSpline:
    """Return the same cubic with one knot in place of two wherever its second derivative does not jump.

    A knot is removed if that moves no control point by more than 1e-13 of the largest coordinate, times the ratio of
    the spans beside it: d^2r/du^2 may jump by 6 / (h_left h_right) of this. The ends of the result are clamped. Raises
    InputError unless `spline.hermite()` exists.

    Parameters
    ----------
    spline : BSpline
        A cubic spline without weights whose interior knots appear at most twice.

    Examples
    --------
    >>> spline = bf.spline_through_hermite([0, 1, 2], [(0, 0), (1, 0), (2, 0)], [(1, 0), (1, 0), (1, 0)])
    >>> len(spline.knots), len(bf.without_removable_knots(spline).knots)
    (10, 9)
    """
    if not isinstance(spline, BSpline):
        raise InputError(f"knots are removed from a BSpline, got {shown(spline)}")
    u, r, r_u = spline.hermite()
    bezier = _bezier(u, r, r_u)
    h = np.diff(u)[:, None]
    second_left = 6.0 * (bezier[:-1, 1] - 2.0 * bezier[:-1, 2] + bezier[:-1, 3]) / h[:-1] ** 2
    second_right = 6.0 * (bezier[1:, 0] - 2.0 * bezier[1:, 1] + bezier[1:, 2]) / h[1:] ** 2
    distance = np.linalg.norm(second_right - second_left, axis=1) * (h[:-1] * h[1:])[:, 0] / 6.0
    ratio = np.maximum(h[:-1] / h[1:], h[1:] / h[:-1])[:, 0]
    return _spline(u, bezier, np.where(distance <= _SAME * ratio * np.abs(bezier).max(), 1, 2))


def _bezier(u: np.ndarray, r: np.ndarray, r_u: np.ndarray) -> np.ndarray:
    """Return the Bezier points (m, 4, 2) of each span."""
    third = np.diff(u)[:, None] / 3.0
    return np.stack([r[:-1], r[:-1] + third * r_u[:-1], r[1:] - third * r_u[1:], r[1:]], axis=1)


def _spline(u: np.ndarray, bezier: np.ndarray, multiplicities: np.ndarray) -> BSpline:
    """Return the cubic spline over spans with Bezier points (m, 4, 2) and given multiplicities of interior knots.

    A control point is the polar form (blossom) of a span's cubic at three consecutive knots. Every span between these
    gives the same value; the longest needs the least extrapolation.
    """
    times = np.concatenate([[4], multiplicities, [4]])
    indices = np.repeat(np.arange(len(u)), times)
    control = []
    for triple in zip(indices[1:-3], indices[2:-2], indices[3:-1], strict=True):
        spans = np.arange(triple[0], triple[2]) if triple[2] > triple[0] else np.array([min(triple[0], len(u) - 2)])
        span = int(spans[np.argmax(np.diff(u)[spans])])
        control.append(_polar(bezier[span], (u[list(triple)] - u[span]) / (u[span + 1] - u[span])))
    return BSpline(3, tuple(u[indices]), points("control_points", control))


def _polar(bezier: np.ndarray, arguments: np.ndarray) -> np.ndarray:
    """Return the polar form (2,) of a cubic with Bezier points (4, 2) at three arguments in units of the span."""
    table = bezier
    for t in arguments:
        table = (1.0 - t) * table[:-1] + t * table[1:]
    return table[0]
