"""The mesh of one beam in its reference; straight beams with equal divisions are meshed together."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from skfem import MeshLine

from beamfem.cached_properties import cached_property
from beamfem.curves import BSpline, Line
from beamfem.element.fields import Field
from beamfem.model.beam import Beam


def nearest(ascending: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the number (n,) of the nearest of ascending numbers to each value (n,), the first of equally near ones."""
    after = np.minimum(np.searchsorted(ascending, values), len(ascending) - 1)
    before = np.searchsorted(ascending, ascending[np.maximum(after - 1, 0)])
    return np.where(np.abs(ascending[before] - values) <= np.abs(ascending[after] - values), before, after)


def distances(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the distance (n,) of each value (n,) to the nearest place (m,), infinite if there are no places."""
    if not len(places):
        return np.full(len(values), np.inf)
    ascending = np.sort(places)
    return np.abs(ascending[nearest(ascending, values)] - values)


_INSIDE = 1e-8  # of the length: distance from an element end at a jump at which the section is evaluated
_MOVED = 0.005  # of the two elements at an end: largest distance by which the end is moved


@dataclass(frozen=True, eq=False)
class Grid:
    """Elements and nodes of a beam; a corner of the curve has two coincident nodes.

    vertices: arc lengths of element ends (ne + 1,) [m]; parameter: mesh coordinates there (ne + 1,), arc lengths or
    knots of a spline; rate: mesh length [m] per unit of the parameter; node: nodes of each element (ne, nn); arc
    (nodes,) [m], position (nodes, 2) [m], unit tangent (nodes, 2) and |r_x| (nodes,) of the nodes; moved: whether a
    node has been moved off the curve to the node that it is joined to.
    """

    beam: Beam
    vertices: np.ndarray
    parameter: np.ndarray
    rate: float
    node: np.ndarray
    arc: np.ndarray
    position: np.ndarray
    tangent: np.ndarray
    speed: np.ndarray
    moved: bool = field(default=False, kw_only=True)

    def skfem(self, elements: slice = slice(None)) -> MeshLine:
        """Return the mesh of all elements, or of a slice of neighbouring ones, for scikit-fem."""
        chosen = range(self.elements)[elements]
        return MeshLine(self.vertices[chosen.start : chosen.stop + 1])

    @property
    def pieces(self) -> list[slice]:
        """Slices of the elements of each smooth piece, between corners of the curve."""
        ends = 1 + np.flatnonzero(self.node[:-1, -1] != self.node[1:, 0])
        return [slice(a, b) for a, b in pairwise([0, *ends.tolist(), self.elements])]

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.vertices) - 1

    @cached_property
    def lengths(self) -> np.ndarray:
        """Mesh length of each element (ne,) [m]."""
        return self.rate * (self.parameter[1:] - self.parameter[:-1])

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.arc)

    @property
    def straight(self) -> bool:
        """Whether the axis is a straight line."""
        return type(self.beam.curve) is Line and not self.moved

    def locate(self, fraction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the elements (n,) at fractions (n,) [-] of the beam's arc length, and xi (n,) in [0, 1] in them."""
        along = fraction * self.vertices[-1]
        if self.beam.elements == "knots":
            assert isinstance(self.beam.curve, BSpline)
            along = self.beam.curve.parameter(along)
        element = np.searchsorted(self.parameter[1:-1], along, side="right")
        start, end = self.parameter[element], self.parameter[element + 1]
        return element, np.minimum(np.maximum((along - start) / (end - start), 0.0), 1.0)

    def node_near(self, fraction: float) -> int | None:
        """Return the node at a fraction [-], None if there is none."""
        if fraction in (0.0, 1.0) and self.beam.elements != "knots":
            return self.node_at(fraction)
        (element,), (xi,) = self.locate(np.array([fraction]))
        nodes = self.beam.element.field.nodes.tolist()
        return int(self.node[element, nodes.index(xi)]) if xi in nodes else None

    def node_at(self, fraction: float) -> int:
        """Return the node at a fraction [-] at which there is a support or joint; `make_grid` has put one there."""
        if fraction in (0.0, 1.0):
            return 0 if fraction == 0.0 else self.nodes - 1
        return int(nearest(self.arc, fraction * self.vertices[-1]))

    def ends(self, element: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the arc lengths (n,) [m] of both ends of elements (n,)."""
        return self.vertices[element], self.vertices[element + 1]

    def tangents(self, element: np.ndarray, arc_length: np.ndarray) -> np.ndarray:
        """Return the unit tangents (n, 2) of the curve at arc lengths (n,) [m] in elements (n,)."""
        return np.asarray(self.beam.curve.tangent(arc_length.copy()))

    def arc_length(self, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Return the arc lengths (n,) [m] of points, given by element and xi, both (n,)."""
        start, end = self.ends(element)
        if self.beam.elements == "knots":
            assert isinstance(self.beam.curve, BSpline)
            along = self.beam.curve.arc_length(self.parameter[element] + xi * np.diff(self.parameter)[element])
        else:
            along = start + xi * (end - start)
        # elements agree on the arc length of their common end, to the last digit
        return np.where(xi == 0.0, start, np.where(xi == 1.0, end, along))

    def section_arc_length(self, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Return the arc lengths (n,) [m] at which sections of points are evaluated: inside the element at jumps."""
        return self.arc_length_inside(element, xi, self.beam.jumps)

    def arc_length_inside(self, element: np.ndarray, xi: np.ndarray, jumps: Sequence[float]) -> np.ndarray:
        """Return the arc lengths (n,) [m] of points, moved inside an element that ends at one of the jumps [m]."""
        arc = self.arc_length(element, xi)
        if not jumps:
            return arc
        length = self.vertices[-1]
        near = distances(self.vertices, np.array(jumps)) < _INSIDE * length
        inside = np.where(near, _INSIDE * length, 0.0)
        return np.clip(arc, (self.vertices + inside)[element], (self.vertices - inside)[element + 1])


def make_grid(beam: Beam, fractions: Iterable[float]) -> Grid:
    """Return the grid of a beam with a node at each of the fractions and at each corner of its curve."""
    if beam.elements == "knots":
        return _knot_spans(beam, fractions)
    length = beam.curve.length
    corners = np.array(beam.curve.corners, dtype=float)
    vertices = element_ends(beam, fractions)
    inner = beam.element.field.nodes
    last = len(inner) - 1
    elements = len(vertices) - 1
    at_corner = distances(vertices[1:-1], corners) < 1e-9 * length
    # at a corner, the adjacent elements have separate nodes
    first = np.arange(elements) * last + np.concatenate([[0], np.cumsum(at_corner)])
    node = first[:, None] + np.arange(last + 1)
    arc = np.empty(node[-1, -1] + 1)
    arc[node] = vertices[:-1, None] + np.diff(vertices)[:, None] * inner
    arc[node[-1, -1]] = vertices[-1]
    seen_from = arc.copy()
    parted = np.flatnonzero(at_corner)
    nudge = 1e-10 * length
    seen_from[node[parted, -1]] -= nudge
    seen_from[node[parted + 1, 0]] += nudge
    # a user's curve may modify its argument
    position, tangent = beam.curve.position(arc.copy()), beam.curve.tangent(seen_from)
    return Grid(beam, vertices, vertices, 1.0, node, arc, position, tangent, np.ones(len(arc)))


def element_ends(beam: Beam, fractions: Iterable[float]) -> np.ndarray:
    """Return the arc lengths [m] at which the elements of a beam end, see `make_grid`."""
    if beam.elements == "knots":
        return _knot_spans(beam, fractions).vertices
    length = beam.curve.length
    corners = np.array(beam.curve.corners, dtype=float)
    return _vertices(beam, [*fractions, *(corners / length)]) * length


def _knot_spans(beam: Beam, fractions: Iterable[float]) -> Grid:
    """Return the grid whose cubic elements are the spans of a cubic spline, divided at the fractions."""
    spline = beam.curve
    assert isinstance(spline, BSpline)
    u = spline.breaks
    near = 1e-9 * np.diff(u).min()
    wanted = spline.parameter(np.array(sorted(set(fractions))) * spline.length)
    extra = wanted[distances(wanted, u) > near]
    # those that are no further apart than this share an element end
    u = np.sort(np.append(u, extra[np.diff(extra, prepend=-np.inf) > near]))
    arc = spline.arc_length(u)
    arc[-1] = spline.length
    rate = spline.length / (u[-1] - u[0])
    slope = spline.derivative(u) / rate
    speed = np.hypot(slope[:, 0], slope[:, 1])
    node = np.arange(len(u) - 1)[:, None] + np.arange(2)
    return Grid(beam, arc, u, rate, node, arc, spline.evaluate(u), slope / speed[:, None], speed)


def _vertices(beam: Beam, fractions: Iterable[float]) -> np.ndarray:
    """Return the fractions at which elements end: those of the beam, and additional ends at `fractions`.

    An end of the beam's elements that is very close to one of `fractions` is moved there instead, because the element
    in between would be too short for accurate strains.
    """
    elements = beam.element_count if beam.elements == "auto" else beam.elements
    assert not isinstance(elements, str)
    grid = np.linspace(0.0, 1.0, elements + 1) if isinstance(elements, int) else np.array(elements, dtype=float)
    near = 1e-9 * np.diff(grid).min()
    wanted = np.array(sorted(set(fractions)))
    extra = wanted[distances(wanted, grid) > near]
    distinct = extra[np.diff(extra, prepend=-np.inf) > near]
    movable = distances(grid, wanted) > near
    movable[[0, -1]] = False
    moved = grid.copy()
    added = []
    for fraction, i in zip(distinct.tolist(), nearest(grid, distinct).tolist(), strict=True):
        if movable[i] and abs(grid[i] - fraction) < _MOVED * (grid[i + 1] - grid[i - 1]):
            moved[i], movable[i] = fraction, False
        else:
            added.append(fraction)
    return np.sort(np.append(moved, added))


def make_grids(beams: Sequence[Beam], fractions: Sequence[Sequence[float]]) -> list[Grid]:
    """Return the grid of each beam with a node at each of its fractions and at each corner of its curve."""
    alike: defaultdict[tuple[int, Field], list[int]] = defaultdict(list)
    grids: dict[int, Grid] = {}
    for number, (beam, beam_fractions) in enumerate(zip(beams, fractions, strict=True)):
        if type(beam.curve) is Line and isinstance(beam.elements, int) and not beam_fractions:
            alike[beam.elements, beam.element.field].append(number)
        else:
            grids[number] = make_grid(beam, beam_fractions)
    for (elements, basis), numbers in alike.items():
        grids.update(zip(numbers, _straight_grids([beams[i] for i in numbers], elements, basis), strict=True))
    return [grids[number] for number in range(len(beams))]


def _straight_grids(beams: Sequence[Beam], elements: int, field: Field) -> list[Grid]:
    """Return the grids of straight beams with the same number of equal elements of one field."""
    lines = [beam.curve for beam in beams if isinstance(beam.curve, Line)]
    nodes = np.asarray(field.nodes, dtype=float)  # a user's field may return any sequence
    length = np.array([line.length for line in lines])[:, None]
    start, end = np.array([line.start for line in lines])[:, None], np.array([line.end for line in lines])[:, None]
    last = len(nodes) - 1
    node = last * np.arange(elements)[:, None] + np.arange(last + 1)
    vertices = np.linspace(0.0, 1.0, elements + 1) * length
    arc = np.empty((len(lines), elements * last + 1))
    sizes = vertices[:, 1:] - vertices[:, :-1]
    arc[:, :-1] = (vertices[:, :-1, None] + sizes[:, :, None] * nodes[:-1]).reshape(len(lines), -1)
    arc[:, -1] = vertices[:, -1]
    fraction = (arc / length)[:, :, None]
    position, tangent = (1.0 - fraction) * start + fraction * end, np.empty((*arc.shape, 2))
    tangent[:] = (end - start) / length[:, :, None]
    speed = np.ones(arc.shape[1])
    parts = zip(beams, vertices, arc, position, tangent, strict=True)
    return [Grid(beam, ends, ends, 1.0, node, at, r, along, speed) for beam, ends, at, r, along in parts]
