"""The mesh of one beam in its reference: elements over the arc length, nodes, and where they stand."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from skfem import MeshLine

from beamfem.curves import Line
from beamfem.model.beam import Beam


@dataclass(frozen=True, eq=False)
class Grid:
    """Elements and nodes of a beam; at a corner of the curve two nodes stand at the same place.

    vertices: arc lengths of the ends of the elements (ne + 1,) [m]; node: nodes of each element (ne, nn);
    arc (nodes,) [m], position (nodes, 2) [m] and unit tangent (nodes, 2) of the nodes.
    """

    beam: Beam
    vertices: np.ndarray
    node: np.ndarray
    arc: np.ndarray
    position: np.ndarray
    tangent: np.ndarray

    @property
    def skfem(self) -> MeshLine:
        """The same mesh for scikit-fem."""
        return MeshLine(self.vertices)

    @property
    def elements(self) -> int:
        return len(self.vertices) - 1

    @property
    def lengths(self) -> np.ndarray:
        """Mesh length of each element (ne,) [m]."""
        return np.diff(self.vertices)

    @property
    def nodes(self) -> int:
        return len(self.arc)

    @property
    def straight(self) -> bool:
        return isinstance(self.beam.curve, Line)

    def locate(self, fraction: float) -> tuple[int, float]:
        """Return element and xi in [0, 1] of a point of the beam."""
        s = fraction * self.vertices[-1]
        element = int(np.clip(np.searchsorted(self.vertices, s, side="right") - 1, 0, self.elements - 1))
        xi = float(np.clip((s - self.vertices[element]) / self.lengths[element], 0.0, 1.0))
        return element, xi

    def node_at(self, fraction: float) -> int:
        """Return the node at a support or joint; `make_grid` has put one there."""
        return int(np.argmin(np.abs(self.arc - fraction * self.vertices[-1])))

    def arc_length(self, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Return the arc length [m] of points (element, xi)."""
        return self.vertices[element] + xi * self.lengths[element]


def make_grid(beam: Beam, fractions: Iterable[float]) -> Grid:
    """Return the grid of a beam with a node at each of the fractions and at each corner of its curve."""
    length = beam.curve.length
    corners = np.array(beam.curve.corners, dtype=float)
    vertices = _vertices(beam, [*fractions, *(corners / length)]) * length
    inner = beam.element.field.nodes
    last = len(inner) - 1
    elements = len(vertices) - 1
    at_corner = np.abs(vertices[1:-1, None] - corners).min(axis=1, initial=np.inf) < 1e-9 * length
    # a corner parts the nodes of the elements on its sides
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
    return Grid(beam, vertices, node, arc, beam.curve.position(arc), beam.curve.tangent(seen_from))


def _vertices(beam: Beam, fractions: Iterable[float]) -> np.ndarray:
    """Fractions where elements end: those that were asked for, and one more wherever one of `fractions` is between."""
    asked = beam.elements
    grid = np.linspace(0.0, 1.0, asked + 1) if isinstance(asked, int) else np.array(asked, dtype=float)
    near = 1e-9 * np.diff(grid).min()
    extra = [f for f in sorted(set(fractions)) if np.abs(grid - f).min() > near]
    distinct = [f for i, f in enumerate(extra) if i == 0 or f - extra[i - 1] > near]
    return np.sort(np.append(grid, distinct))
