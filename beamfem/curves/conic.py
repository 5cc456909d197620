"""Elliptic arcs as rational splines."""

from collections.abc import Sequence

import numpy as np

from beamfem.curves.bspline import BSpline
from beamfem.curves.curve import points, warn_of_turns
from beamfem.errors import InputError
from beamfem.validation import finite, vector

_MOST_TURNS = 1000


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
    with np.errstate(over="ignore", invalid="ignore"):
        area = one[0] * two[1] - one[1] * two[0]
    if not np.isfinite(area):
        raise InputError(f"the half diameters of an elliptic arc are too large to be multiplied, got {one} and {two}")
    if area == 0.0:
        raise InputError(f"the half diameters of an elliptic arc must not be parallel, got {first!r} and {second!r}")
    if not abs(turn) <= 2.0 * np.pi * _MOST_TURNS:
        raise InputError(
            f"an elliptic arc turns at most {_MOST_TURNS} times, got {abs(turn) / (2.0 * np.pi):.3g} turns from start "
            f"({start:g}) to end ({end:g}); angles are in rad"
        )
    warn_of_turns("the elliptic arc", turn)
    pieces = max(1, int(np.ceil(abs(turn) / (np.pi / 2) - 1e-12)))
    angles = begin + turn * np.arange(2 * pieces + 1) / (2 * pieces)
    weights = np.ones(len(angles))
    weights[1::2] = np.cos(turn / (2 * pieces))
    # every other control point lies off the ellipse, at the intersection of the tangents at its neighbours
    table = middle + (np.outer(np.cos(angles), one) + np.outer(np.sin(angles), two)) / weights[:, None]
    inner = np.repeat(np.arange(pieces + 1.0), 2)
    return BSpline(2, (0.0, *inner, float(pieces)), points("control_points", table), tuple(weights))
