"""The supports at a point, found by bisection, so that each of many reactions does not search all of them."""

from bisect import bisect_left, bisect_right
from collections import defaultdict

from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.model.support import PointSupport

_Along = dict[int, tuple[list[float], list[PointSupport]]]


def supports_near(model: Model, point: Point, distance: float) -> list[PointSupport]:
    """Return the supports on a point's beam whose fractions differ from the point's by less than a distance [-]."""
    fractions, supports = _along(model).get(id(point.beam), ([], []))
    begin = bisect_left(fractions, point.fraction - distance)
    end = bisect_right(fractions, point.fraction + distance)
    return [own for own in supports[begin:end] if abs(own.point.fraction - point.fraction) < distance]


def _along(model: Model) -> _Along:
    """Return the fractions and the supports of each beam that has some, from its start to its end."""
    known: dict[str, _Along] = model.__dict__
    if "_supports_along" not in known:
        found: defaultdict[int, list[PointSupport]] = defaultdict(list)
        for support in sorted(model.point_supports, key=lambda own: own.point.fraction):
            found[id(support.point.beam)].append(support)
        known["_supports_along"] = {
            beam: ([support.point.fraction for support in own], own) for beam, own in found.items()
        }
    return known["_supports_along"]
