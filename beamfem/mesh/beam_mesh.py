"""The numbered mesh of one beam: its grid, and the coordinates of the model at its nodes."""

from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.coordinates import Gradients, labels
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.element_types import Classes, element_classes
from beamfem.mesh.numbering import Nodes


@dataclass(frozen=True, eq=False)
class BeamMesh(Grid):
    """Grid of a beam with its numbers in the model.

    kinematics: kinematics and coordinates of the nodes; first_element: first element of the beam in its block; block:
    number of this block; history (ne, nq, k): numbers of the history variables at the quadrature points, empty without
    history.
    """

    kinematics: Nodes
    first_element: int
    block: int
    history: np.ndarray

    @cached_property
    def classes(self) -> Classes:
        """Classes of identical elements, with their data."""
        return element_classes(self)

    @property
    def parts(self) -> tuple["BeamMesh", ...]:
        """The meshes of single beams that it consists of."""
        return (self,)

    def in_block(self, element: np.ndarray) -> np.ndarray:
        """Return the numbers of elements in their block."""
        return self.first_element + element

    @property
    def vectors(self) -> tuple[str, ...]:
        """Names of the nodal vectors of a node: "r", "r_x", "r_y"."""
        return self.beam.element.field.vectors

    @cached_property
    def node_kinds(self) -> tuple[tuple[int, np.ndarray], ...]:
        """Each kind of nodal coordinates, by its number in compiled code, with its nodes (n,)."""
        codes = self.kinematics.node_kind
        return tuple((int(code), np.flatnonzero(codes == code)) for code in np.unique(codes))

    @property
    def has_gradients_only(self) -> bool:
        """Whether no node has an angle as a coordinate."""
        if not isinstance(self.beam.element.coordinates, Gradients):
            return False
        return all("theta" not in self.labels(int(nodes[0])) for _, nodes in self.node_kinds)

    def labels(self, node: int) -> tuple[str, ...]:
        """Return the names of the coordinates of a node."""
        return labels(int(self.kinematics.node_kind[node]), self.vectors)

    def coordinates_of(self, node: int) -> dict[str, int]:
        """Return the number in the model of each coordinate of a node, by name."""
        return dict(zip(self.labels(node), self.kinematics.dof[node].tolist(), strict=False))

    def table(self, p: np.ndarray) -> np.ndarray:
        """Return the coordinates (steps, nodes, npn) of states p (steps, n); unused columns of a node hold anything."""
        return p[:, self.kinematics.dof]
