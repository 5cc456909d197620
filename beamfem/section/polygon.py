"""Sections bounded by straight lines and circular arcs."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beamfem.errors import InputError
from beamfem.section.outline import StripOutline
from beamfem.section.section_shapes import ShapedSection
from beamfem.validation import finite, items, not_negative, optional, positive, shown

Corner = Sequence[float]  # x, y and, of a rounded corner, its radius [m]
_SAME = 1e-9  # fraction of the size: heights closer than this are one
_POINTS = 24  # of the quadrature over a strip, which has sines of its angle up to the 5th power


class _Side(NamedTuple):
    """Part of a boundary at x = a + b y + c sqrt(r^2 - (y - m)^2), counted with `sign` in the width."""

    low: float
    high: float
    sign: float
    line: tuple[float, float] = (0.0, 0.0)
    arc: tuple[float, float, float] | None = None  # c, m, r

    def at(self, y: float) -> float:
        c, m, r = self.arc or (0.0, 0.0, 0.0)
        return self.line[0] + self.line[1] * y + c * max(r * r - (y - m) ** 2, 0.0) ** 0.5


def Polygon(
    corners: Sequence[Corner], holes: Sequence[Sequence[Corner]] = (), shear_factor: float | None = None
) -> ShapedSection:
    """Return the section inside a polygon, whose corners may be rounded, with its centroid on the beam's axis.

    It bends in its plane, held against lateral motion and twist, even if its axes are not principal axes. Raises
    InputError for a polygon without area or one that crosses itself, and for a radius that does not fit.

    Parameters
    ----------
    corners : sequence of (x, y) or (x, y, radius), [m]
        Corners one after the other, x out of the plane of the beam, y along the height.
    holes : sequence of polygons, [m]
        Holes, each given by its corners.
    shear_factor : float, [-], optional
        Shear correction factor k_s, by default from the energy of Jourawski's shear stress V S / (I b),
        1/k_s = A/I^2 times the integral of (S/b)^2 over the area.

    Examples
    --------
    >>> triangle = bf.Polygon([(0, 0), (0.06, 0), (0.03, 0.09)])
    >>> round(triangle.area, 6), round(triangle.second_moment, 9), round(triangle.bounds[0], 9)
    (0.0027, 1.215e-06, -0.03)
    """
    loops = [_checked(loop) for loop in (corners, *items("holes of Polygon", holes))]
    return of_loops(loops, "", shear_factor)


def of_loops(loops: list[list[Corner]], name: str, shear_factor: float | None = None) -> ShapedSection:
    """Return the section inside a polygon with holes (the loops after the first)."""
    heights, weights = _quadrature(_strips(loops))
    centroid = float(heights @ weights / weights.sum())
    strips = _strips([[(x, y - centroid, *radius) for x, y, *radius in loop] for loop in loops])
    heights, weights = _quadrature(strips)
    area, _, second, third, fourth = (float(heights**n @ weights) for n in range(5))
    shear = optional(positive)("shear_factor of Polygon", shear_factor) or _shear_factor(strips, area, second)
    low, high = strips[0].low, strips[-1].high
    return ShapedSection(area, second, shear, fourth, high - low, -low, strips, third, name)


def _checked(loop: Sequence[Corner]) -> list[Corner]:
    corners = items("corners of a Polygon", loop)
    for corner in corners:
        if len(numbers := items("a corner of a Polygon", corner)) not in (2, 3):
            raise InputError(f"a corner of a Polygon is (x, y) or (x, y, radius), got {shown(corner)}")
        for value in numbers[:2]:
            finite("a corner of a Polygon", value)
        for radius in numbers[2:]:
            not_negative("the radius of a corner of a Polygon", radius)
    if len(corners) < 3:
        raise InputError(f"a Polygon has at least 3 corners, got {len(corners)}")
    return [tuple(map(float, corner)) for corner in corners]


def _strips(loops: list[list[Corner]]) -> tuple[StripOutline, ...]:
    """Return the strips between the heights at which sides begin or end. Raises InputError where sides cross."""
    sides = [side for number, loop in enumerate(loops) for side in _sides(loop, hole=number > 0)]
    levels = np.unique([level for side in sides for level in (side.low, side.high)])
    breaks = levels[np.append(True, np.diff(levels) > _SAME * (levels[-1] - levels[0]))].tolist()
    result = []
    for low, high in pairwise([*breaks[:-1], float(levels[-1])]):
        spanning = [side for side in sides if side.low < 0.5 * (low + high) < side.high]
        offset, slope = (float(sum(side.sign * side.line[n] for side in spanning)) for n in (0, 1))
        arcs = tuple(
            (float(side.sign * side.arc[0]), float(side.arc[1]), float(side.arc[2])) for side in spanning if side.arc
        )
        for y in (low + 1e-6 * (high - low), high - 1e-6 * (high - low)):
            signs = [side.sign for side in sorted(spanning, key=lambda side: side.at(y))]
            if signs != [-1.0, 1.0] * (len(signs) // 2):
                raise InputError("a Polygon must not cross itself, and its holes are inside")
        result.append(StripOutline(low, high, (offset, slope), arcs))
    return tuple(result)


def _sides(corners: list[Corner], hole: bool) -> Iterator[_Side]:
    """Yield the lines and arcs of a boundary, each monotonic in y. Raises InputError for a radius that does not fit."""
    points = np.array([corner[:2] for corner in corners])
    following = np.roll(points, -1, axis=0)
    turns = points[:, 0] @ following[:, 1] - points[:, 1] @ following[:, 0]
    if turns == 0.0:
        raise InputError("a Polygon needs an area; its corners go round it once")
    outward = np.sign(turns) * (-1.0 if hole else 1.0)
    before, after = np.roll(points, 1, axis=0) - points, following - points
    lengths = np.linalg.norm(after, axis=1)
    if not lengths.all():
        raise InputError("two successive corners of a Polygon are the same")
    u, v = before / np.roll(lengths, 1)[:, None], after / lengths[:, None]
    cross, along = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], np.einsum("ni,ni->n", u, v)
    half = 0.5 * np.arctan2(np.abs(cross), along)  # of the angle between both sides
    radii = np.array([corner[2] if len(corner) > 2 else 0.0 for corner in corners])
    cut = np.where(radii > 0.0, radii / np.tan(half), 0.0)
    if np.any(cut + np.roll(cut, -1) > lengths * (1.0 + _SAME)):
        raise InputError("the radius of a corner of a Polygon is too large for the sides beside it")
    starts, ends = points + cut[:, None] * u, points + cut[:, None] * v  # of the roundings
    for end, start in zip(ends, np.roll(starts, -1, axis=0), strict=True):
        (x, y), (dx, dy) = end, start - end
        if abs(dy) > _SAME * lengths.max():
            slope = dx / dy
            yield _Side(min(y, y + dy), max(y, y + dy), outward * np.sign(dy), (x - slope * y, slope))
    for n in np.flatnonzero(radii):
        centre = points[n] + (u[n] + v[n]) / np.linalg.norm(u[n] + v[n]) * radii[n] / np.sin(half[n])
        first, last = (np.arctan2(*(at[n] - centre)[::-1]) for at in (starts, ends))
        last = first + (last - first + np.pi) % (2.0 * np.pi) - np.pi  # the shorter way round
        level = [np.pi * k for k in (-1.5, -0.5, 0.5, 1.5) if min(first, last) < np.pi * k < max(first, last)]
        for one, other in pairwise([first, *sorted(level, reverse=bool(last < first)), last]):
            low, high = sorted(centre[1] + radii[n] * np.sin([one, other]))
            side, rising = np.sign(np.cos(0.5 * (one + other))), np.sign(np.sin(other) - np.sin(one))
            yield _Side(low, high, outward * rising, (centre[0], 0.0), (side, centre[1], radii[n]))


def _quadrature(strips: tuple[StripOutline, ...]) -> tuple[np.ndarray, np.ndarray]:
    heights, weights = zip(*(strip.quadrature(_POINTS) for strip in strips), strict=True)
    return np.concatenate(heights), np.concatenate(weights)


def _shear_factor(strips: tuple[StripOutline, ...], area: float, second: float) -> float:
    energy, below = 0.0, 0.0
    for strip in strips:
        heights, weights = strip.quadrature(_POINTS)
        energy += float(weights @ ((below + strip.below(heights)[1]) / strip.width(heights)) ** 2)
        below += float(strip.below(np.array(strip.high))[1])
    return second**2 / (area * energy)
