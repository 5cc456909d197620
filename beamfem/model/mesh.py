"""The mesh of one beam: a scikit-fem line mesh over the arc length, with a node at every support."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from skfem import MeshLine

from beamfem.model.beam import Beam


@dataclass(frozen=True, eq=False)
class BeamMesh:
    """Mesh of a beam and where its numbers stand in the model.

    vertices: arc lengths of the ends of the elements (ne + 1,) [m]; first_dof: first coordinate of the beam;
    first_element: first element of the beam in its block; block: number of its block.
    """

    beam: Beam
    vertices: np.ndarray
    first_dof: int
    first_element: int
    block: int

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
    def intervals(self) -> int:
        """Node intervals in an element."""
        return len(self.beam.element.field.nodes) - 1

    @property
    def nodes(self) -> int:
        return self.elements * self.intervals + 1

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.nodes * self.beam.element.coordinates_per_node

    def node_arc_lengths(self) -> np.ndarray:
        """Arc length of every node (nodes,) [m]."""
        inner = self.vertices[:-1, None] + self.lengths[:, None] * self.beam.element.field.nodes[None, :-1]
        return np.append(inner.ravel(), self.vertices[-1])

    def locate(self, fraction: float) -> tuple[int, float]:
        """Return element and xi in [0, 1] of a point of the beam."""
        s = fraction * self.vertices[-1]
        element = int(np.clip(np.searchsorted(self.vertices, s, side="right") - 1, 0, self.elements - 1))
        xi = float(np.clip((s - self.vertices[element]) / self.lengths[element], 0.0, 1.0))
        return element, xi

    def node_at(self, fraction: float) -> int:
        """Return the node at a support; `vertices_with` has put one there."""
        arc = self.node_arc_lengths()
        return int(np.argmin(np.abs(arc - fraction * self.vertices[-1])))

    def dofs_of_node(self, node: int) -> np.ndarray:
        """Coordinates of a node in the model (npn,)."""
        per_node = self.beam.element.coordinates_per_node
        return self.first_dof + node * per_node + np.arange(per_node)


def vertices_with(beam: Beam, fractions: Iterable[float]) -> np.ndarray:
    """Return the ends of equal elements (ne + 1,) [m], and one more wherever a fraction falls between them."""
    grid = np.linspace(0.0, 1.0, beam.elements + 1)
    near = 1e-9 / beam.elements
    extra = [f for f in sorted(set(fractions)) if np.abs(grid - f).min() > near]
    return np.sort(np.append(grid, extra)) * beam.curve.length
