"""Supports at points by beam and fraction, so that those near a point are found among many in little time."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable

from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport


class SupportsAlong:
    """The supports at points of a model, sorted along each beam."""

    def __init__(self, supports: Iterable[PointSupport]) -> None:
        found: defaultdict[int, list[PointSupport]] = defaultdict(list)
        for support in sorted(supports, key=lambda support: support.point.fraction):
            found[id(support.point.beam)].append(support)
        self._beams = {beam: ([support.point.fraction for support in own], own) for beam, own in found.items()}

    def near(self, point: Point, distance: float) -> list[PointSupport]:
        """Return the supports on a point's beam whose fractions differ from the point's by less than a distance [-]."""
        fractions, supports = self._beams.get(id(point.beam), ([], []))
        begin = bisect_left(fractions, point.fraction - distance)
        end = bisect_right(fractions, point.fraction + distance)
        return [support for support in supports[begin:end] if abs(support.point.fraction - point.fraction) < distance]
