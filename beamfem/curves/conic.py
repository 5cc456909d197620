"""Arcs of ellipses as rational splines."""

from collections.abc import Sequence

import numpy as np

from beamfem.curves.bspline import BSpline
from beamfem.curves.curve import points
from beamfem.errors import InputError
from beamfem.validation import finite, vector


def elliptic_arc(
    center: Sequence[float], first: Sequence[float], second: Sequence[float], start: float, end: float
) -> BSpline:
    """Return the arc center + first cos a + second sin a, a from start to end [rad], as an exact rational spline.

    center, first, second: (x, y) [m], the last two conjugate half diameters (the half axes where they are normal to
    each other). Each piece of at most a quarter turn is a rational parabola whose middle weight is the cosine of half
    its angle. Raises InputError where start equals end or the half diameters are parallel.
    """
    middle, one, two = (np.array(vector(*pair)) for pair in (("center", center), ("first", first), ("second", second)))
    begin, turn = finite("start", start), finite("end", end) - finite("start", start)
    if turn == 0.0:
        raise InputError(f"an elliptic arc needs two different angles, start and end are both {begin}")
    if one[0] * two[1] == one[1] * two[0]:
        raise InputError(f"the half diameters of an elliptic arc must not be parallel, got {first!r} and {second!r}")
    pieces = int(np.ceil(abs(turn) / (np.pi / 2) - 1e-12))
    angles = begin + turn * np.arange(2 * pieces + 1) / (2 * pieces)
    weights = np.ones(len(angles))
    weights[1::2] = np.cos(turn / (2 * pieces))
    # every other point lies off the ellipse, where the tangents at its neighbours meet
    table = middle + (np.outer(np.cos(angles), one) + np.outer(np.sin(angles), two)) / weights[:, None]
    inner = np.repeat(np.arange(pieces + 1.0), 2)
    return BSpline(2, (0.0, *inner, float(pieces)), points("control_points", table), tuple(weights))
