"""Deformed shapes: the body of each beam and its axis, in one colour or by a field."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.results.axis_fields import Quantity, quantity
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import LikeBeams, equal_beams, of_each
from beamfem.results.beam_stress import HEIGHTS
from beamfem.results.solution import Solution
from beamfem.units import units_of
from beamfem.view.frames import axis_points
from beamfem.view.support_symbols import grounds

ORIGINAL = "original shape"  # what is dashed
_SAME = 1e-3  # of the largest value: smaller differences are not worth all colours
FIELD_COLOURS = "viridis"  # told apart by the colour-blind, and its lightness rises: readable in grey print
_LIGHT, _DARK = np.array([0.68, 0.78, 0.88]), np.array([0.07, 0.22, 0.42])
_DASHED, _DASHES = "0.55", (0, (5, 3))  # axes in the reference
_UNKNOWN = 0.8  # grey of what has no value
_THIN = 0.01  # of the larger side of a picture
_SLABS = 40_000  # of bodies in a picture; above, axes alone are drawn


def shade(fraction: float) -> np.ndarray:
    """Return blue, light for 0 and dark for 1."""
    return _LIGHT + fraction * (_DARK - _LIGHT)


@dataclass(frozen=True, eq=False)
class Shapes:
    """The shapes of some rows of a solution, and a field along them where `colour` names one.

    r, d: for each beam (rows, points, 2).
    """

    solution: Solution
    rows: np.ndarray
    colour: str | None = None
    total: int | None = None

    @cached_property
    def points(self) -> list[AxisPoints]:
        return axis_points(self.solution) if self.total is None else axis_points(self.solution, self.total)

    @cached_property
    def groups(self) -> list[LikeBeams]:
        """The points of like beams, which are evaluated together."""
        return equal_beams(self.solution.model, self.points, len(self.rows))

    @cached_property
    def _moved(self) -> list[tuple[np.ndarray, np.ndarray]]:
        p = self.solution.p[self.rows]
        both = of_each(self.groups, lambda points: np.stack(points.positions(p)), 2)
        return [(r, d) for r, d in both]

    @cached_property
    def body(self) -> list[np.ndarray]:
        """Lower and upper face of each beam (rows, points, 2 faces, 2) [m]."""
        return [_at_heights(points.faces, *moved) for points, moved in zip(self.points, self._moved, strict=True)]

    @cached_property
    def layers(self) -> list[list[np.ndarray]]:
        """Lower and upper face of each layer of each beam (rows, points, 2 faces, 2) [m], from the bottom up."""
        return [
            [_at_heights(heights, *moved) for heights in np.moveaxis(points.layers, 1, 0)]
            for points, moved in zip(self.points, self._moved, strict=True)
        ]

    @cached_property
    def axis(self) -> list[np.ndarray]:
        """Axis of each beam (rows, points, 2) [m]."""
        return [r for r, _ in self._moved]

    @cached_property
    def quantity(self) -> Quantity | None:
        return None if self.colour is None else quantity(self.colour)

    @cached_property
    def _readable(self) -> tuple[float, str]:
        assert self.quantity is not None
        return units_of(self.solution.model.units).readable(max(map(abs, self.limits)), self.quantity.unit)

    @property
    def factor(self) -> float:
        """Factor of the numbers at a colour bar."""
        return self._readable[0]

    @property
    def label(self) -> str:
        """Name of the field, and the unit of the numbers at a colour bar."""
        assert self.quantity is not None
        return f"{self.quantity.label} [{self._readable[1]}]"

    @cached_property
    def values(self) -> list[np.ndarray]:
        """The field along each beam (rows, points)."""
        assert self.quantity is not None
        along = self.quantity.values
        result = of_each(self.groups, lambda points: along(points, self.solution, self.rows))
        if not any(np.isfinite(values).any() for values in result):
            why = self.quantity.unknown_of(points.mesh.beam for points in self.points)
            raise InputError(f"no beam has a {self.quantity.label} to draw: {why}")
        return result

    def strips(self, order: int) -> list[list[tuple[np.ndarray, np.ndarray]]]:
        """Strips along each beam in a row: their two faces (points, 2 faces, 2) [m] and the field there (points, 2).

        A field that varies over the height has several strips in each layer, any other one for each layer.
        """
        if self._over_height is None:
            return [
                [(faces[order], np.repeat(values[order, :, None], 2, axis=-1)) for faces in layers]
                for layers, values in zip(self.layers, self.values, strict=True)
            ]
        result = []
        for layers, values in zip(self.layers, self._over_height, strict=True):
            strips = []
            for number, faces in enumerate(layers):
                low, high = np.moveaxis(faces[order][:, :, None], 1, 0)
                between = low + HEIGHTS[:, None] * (high - low)
                field = values[order, :, number]
                strips += [(between[:, i : i + 2], field[:, i : i + 2]) for i in range(len(HEIGHTS) - 1)]
            result.append(strips)
        return result

    @cached_property
    def _over_height(self) -> list[np.ndarray] | None:
        """The field of each beam at `HEIGHTS` of each layer (rows, points, layers, heights), None if it is the same."""
        over_height = None if self.quantity is None else self.quantity.over_height
        if over_height is None:
            return None
        return of_each(self.groups, lambda points: over_height(points, self.solution, self.rows))

    @cached_property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest value of the field in these rows."""
        return limits(self.values if self._over_height is None else [*self.values, *self._over_height])

    @cached_property
    def box(self) -> np.ndarray:
        """Lower left and upper right corner (2, 2) [m] of all shapes, the undeformed axes and ends of springs."""
        parts = [body.reshape(-1, 2) for body in self.body] + [points.reference for points in self.points]
        parts += [place[None] for place in grounds(self.solution.model)]
        return np.stack([end([end(part, axis=0) for part in parts], axis=0) for end in (np.min, np.max)])

    @cached_property
    def centre(self) -> np.ndarray:
        """Mean of all points of the axes (2,) [m]."""
        return np.concatenate([axis.reshape(-1, 2) for axis in self.axis]).mean(axis=0)

    @property
    def _bodies_drawn(self) -> bool:
        varies = self.quantity is not None and self.quantity.over_height is not None
        strips = len(HEIGHTS) - 1 if varies else 1
        return strips * len(self.rows) * sum(len(points.xi) for points in self.points) <= _SLABS

    def draw(self, axes: Any, order: int, fraction: float = 1.0) -> list[Any]:
        """Draw the shape of the row number `order`; fraction: from 0 for pale to 1 for strong. Return the artists."""
        return self._by_field(axes, order, fraction) if self.colour else self._plain(axes, order, fraction)

    def _plain(self, axes: Any, order: int, fraction: float) -> list[Any]:
        from matplotlib.collections import LineCollection, PolyCollection

        colour = shade(fraction)
        lines = LineCollection(
            [axis[order] for axis in self.axis], colors=[colour], linewidths=1.3, zorder=2 + fraction
        )
        drawn: list[Any] = [lines]
        if self._bodies_drawn:
            parts = [(number, faces[order]) for layers in self.layers for number, faces in enumerate(layers)]
            outlines = [_outline(faces) for _, faces in parts]
            # neighbouring layers differ in strength
            colours = [(*colour, 0.45 if number % 2 == 0 else 0.25) for number, _ in parts]
            drawn.insert(0, PolyCollection(outlines, facecolors=colours, edgecolors="none", zorder=2 + fraction))
        return _added(axes, drawn)

    def _by_field(self, axes: Any, order: int, fraction: float) -> list[Any]:
        from matplotlib.collections import LineCollection, PolyCollection

        drawn: list[Any] = []
        if self._bodies_drawn:
            slabs, means = [], []
            for points, strips in zip(self.points, self.strips(order), strict=True):
                for faces, field in strips:
                    slabs.append(_between(points, faces)[:, [0, 1, 1, 0], [0, 0, 1, 1]])
                    means.append(_between(points, field).mean(axis=(1, 2)))
            colours = self._colours(np.concatenate(means), fraction)
            drawn.append(
                PolyCollection(list(np.concatenate(slabs)), facecolors=colours, edgecolors="face", linewidths=0.3)
            )
            outlines = [_outline(faces[order]) for layers in self.layers for faces in layers]
            edges = str(1.0 - 0.75 * _strength(fraction))
            drawn.append(PolyCollection(outlines, facecolors="none", edgecolors=edges, linewidths=0.4))
        lines, along = [], []
        for points, axis, values in zip(self.points, self.axis, self.values, strict=True):
            # on a body whose field varies over the height, the extreme over it would be painted on its axis
            hardly_higher = float(np.ptp(points.faces, axis=1).max()) < _THIN * float(np.max(self.box[1] - self.box[0]))
            if self._over_height is None or not self._bodies_drawn or hardly_higher:
                lines.append(_between(points, axis[order]))
                along.append(_between(points, values[order]).mean(axis=1))
        if lines:
            colours = self._colours(np.concatenate(along), fraction)
            drawn.append(LineCollection(list(np.concatenate(lines)), colors=colours, linewidths=2.0, capstyle="round"))
        for artist in drawn:
            artist.set_zorder(2 + fraction)
        return _added(axes, drawn)

    def _colours(self, values: np.ndarray, fraction: float) -> np.ndarray:
        """Return the colours (n, 3) of values (n,) of the field."""
        from matplotlib import colormaps

        low, high = self.limits
        fractions = (values - low) / (high - low)
        colours = np.where(np.isfinite(fractions)[:, None], colormaps[FIELD_COLOURS](fractions)[:, :3], _UNKNOWN)
        return np.asarray(1.0 - _strength(fraction) * (1.0 - colours))


def _at_heights(heights: np.ndarray, r: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Return positions (rows, points, 2 faces, 2) [m] at heights (points, 2) [m]."""
    return np.asarray(r[:, :, None] + heights[None, :, :, None] * d[:, :, None])


def _outline(faces: np.ndarray) -> np.ndarray:
    return np.concatenate([faces[:, 0], faces[::-1, 1]])


def _added(axes: Any, drawn: list[Any]) -> list[Any]:
    for artist in drawn:
        axes.add_collection(artist, autolim=False)
    return drawn


def _between(points: AxisPoints, values: np.ndarray) -> np.ndarray:
    """Return values (points, ...) at both ends of the pieces of all elements (pieces, 2, ...)."""
    table = values.reshape(points.mesh.elements, points.pieces + 1, *values.shape[1:])
    return np.stack([table[:, :-1], table[:, 1:]], axis=2).reshape(-1, 2, *values.shape[1:])


def _strength(fraction: float) -> float:
    """Return how strong a colour is; paler ones are mixed with white, not transparent, which would show overlaps."""
    return 0.35 + 0.65 * fraction


def limits(values: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the smallest and the largest value, widened if they agree to three digits."""
    low, high = _range(values)
    size = max(abs(low), abs(high))
    return (low - (size or 1.0), high + (size or 1.0)) if even(values) else (low, high)


def even(values: Sequence[np.ndarray]) -> bool:
    """Return whether all values agree to three digits."""
    low, high = _range(values)
    return high - low <= _SAME * max(abs(low), abs(high))


def _range(values: Sequence[np.ndarray]) -> tuple[float, float]:
    finite = [v[np.isfinite(v)] for v in values]
    return min(float(v.min()) for v in finite if v.size), max(float(v.max()) for v in finite if v.size)


def draw_undeformed(axes: Any, points: Sequence[AxisPoints]) -> Any:
    """Draw the axes in the reference as dashed lines; return the entry of the legend that says so."""
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    lines = [of_beam.reference for of_beam in points]
    axes.add_collection(
        LineCollection(lines, colors=_DASHED, linestyles=_DASHES, linewidths=0.9, zorder=1.5), autolim=False
    )
    return Line2D([], [], color=_DASHED, linestyle=_DASHES, linewidth=0.9, label=ORIGINAL)
