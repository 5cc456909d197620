"""The meshes of beams with like elements and sections as one mesh, so that results are evaluated on all at once."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.mesh.beam_mesh import BeamMesh, Nodes

_NONE = np.empty(0)


@dataclass(frozen=True, eq=False)
class JoinedMesh(BeamMesh):
    """Meshes of one block and section, the elements and nodes of one after those of another.

    `beam` is the first of them; vertices and parameter are empty, since elements of different beams share no ends.
    """

    joined: tuple[BeamMesh, ...]

    @property
    def parts(self) -> tuple[BeamMesh, ...]:
        return self.joined

    @property
    def elements(self) -> int:
        return len(self.node)

    @cached_property
    def begin(self) -> np.ndarray:
        """First element of each mesh, and their total number (parts + 1,)."""
        return np.cumsum([0, *(mesh.elements for mesh in self.joined)])

    @cached_property
    def lengths(self) -> np.ndarray:
        return np.concatenate([mesh.lengths for mesh in self.joined])

    def ends(self, element: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        start, end = self._ends
        return start[element], end[element]

    def in_block(self, element: np.ndarray) -> np.ndarray:
        return self._in_block[element]

    def section_arc_length(self, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
        result = np.empty(len(element))
        for mesh, points, own in self.by_beam(element):
            result[points] = mesh.section_arc_length(own, xi[points])
        return result

    def tangents(self, element: np.ndarray, arc_length: np.ndarray) -> np.ndarray:
        result = np.empty((len(element), 2))
        for mesh, points, own in self.by_beam(element):
            result[points] = mesh.tangents(own, arc_length[points])
        return result

    def by_beam(self, element: np.ndarray) -> Iterator[tuple[BeamMesh, np.ndarray, np.ndarray]]:
        """Yield each mesh with the indices of those of the points (n,) that lie on it, and their elements in it."""
        owner = np.searchsorted(self.begin, element, side="right") - 1
        order = np.argsort(owner, kind="stable")
        bounds = np.searchsorted(owner[order], np.arange(len(self.joined) + 1))
        for mesh, first, (start, stop) in zip(
            self.joined, self.begin.tolist(), pairwise(bounds.tolist()), strict=False
        ):
            if start < stop:
                points = order[start:stop]
                yield mesh, points, element[points] - first

    @cached_property
    def _ends(self) -> tuple[np.ndarray, np.ndarray]:
        ends = [mesh.vertices for mesh in self.joined]
        return np.concatenate([own[:-1] for own in ends]), np.concatenate([own[1:] for own in ends])

    @cached_property
    def _in_block(self) -> np.ndarray:
        return np.concatenate([mesh.first_element + np.arange(mesh.elements) for mesh in self.joined])


def join(meshes: Sequence[BeamMesh]) -> BeamMesh:
    """Return meshes of a group, see `NumberedMeshes.joinable`, as one; a single one as it is."""
    if len(meshes) == 1:
        return meshes[0]
    first = meshes[0]
    nodes = np.array([mesh.nodes for mesh in meshes])
    shift = np.repeat(np.cumsum(nodes) - nodes, [mesh.elements for mesh in meshes])
    arc, position, tangent, speed = (
        np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in ("arc", "position", "tangent", "speed")
    )
    node = np.concatenate([mesh.node for mesh in meshes]) + shift[:, None]
    grid = first.beam, _NONE, _NONE, first.rate, node, arc, position, tangent, speed
    return JoinedMesh(
        *grid, _joined_kinematics(meshes), 0, first.block, first.history[:0], tuple(meshes), moved=first.moved
    )


def _joined_kinematics(meshes: Sequence[BeamMesh]) -> Nodes:
    """Return the nodes of all meshes; coordinates that a node does not have are -1."""
    width = max(mesh.kinematics.dof.shape[1] for mesh in meshes)
    dofs = [
        np.pad(dof, ((0, 0), (0, width - dof.shape[1])), constant_values=-1) if dof.shape[1] < width else dof
        for dof in (mesh.kinematics.dof for mesh in meshes)
    ]
    kind, frame = (
        np.concatenate([getattr(mesh.kinematics, name) for mesh in meshes]) for name in ("node_kind", "frame")
    )
    return Nodes(kind, np.concatenate(dofs), frame)
