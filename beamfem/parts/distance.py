"""The distance of two places in the reference."""

import math

from beamfem.model.beam import Point


def reference_distance(a: Point, b: Point | tuple[float, float]) -> float:
    """Return the distance [m] of a point from another one, or from a place on the ground, in the reference."""
    x, y = a.reference - (b.reference if isinstance(b, Point) else b)
    return math.hypot(x, y)
