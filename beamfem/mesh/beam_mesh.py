"""The numbered mesh of one beam: grid, types of identical elements, coordinates at its nodes; and of like beams."""

from collections import defaultdict
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.coordinates import Gradients, labels
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.reference import energy_points, energy_stiffness_at, inertia_at, jacobians, length_points, scales
from beamfem.value_keys import by_value

_ALIKE = 1e-9  # of the longest element: elements whose lengths differ by less are in one class


class Nodes(NamedTuple):
    """Nodes of a beam: kind (nodes,), coordinates (nodes, npn), -1 where there is none, and frame (nodes, 3).

    frame: cosine and sine of the reference angle, and |r_x|; see `kernels.block.Block`.
    """

    node_kind: np.ndarray
    dof: np.ndarray
    frame: np.ndarray


class Classes(NamedTuple):
    """Data of nc classes; kind (ne,) is the class of each element, the rest as in `kernels.block.Block`."""

    kind: np.ndarray
    slope: np.ndarray
    second: np.ndarray
    scale: np.ndarray
    jacobian: np.ndarray
    weight: np.ndarray
    stiffness: np.ndarray
    reference: np.ndarray
    mass: np.ndarray
    gravity: np.ndarray
    length: np.ndarray
    damping: np.ndarray


def element_classes(grid: Grid) -> Classes:
    """Return the classes of a grid: by length on a straight prismatic beam, otherwise one per element."""
    first, kind = _equal_elements(grid)
    element, xi, weight = energy_points(grid, first)
    count, size = len(first), len(element) // len(first)
    stiffness, reference = energy_stiffness_at(grid, element, xi)
    scale = scales(grid.beam.element, grid.lengths[first])
    mass, gravity, length = _inertia(grid, first, scale)
    damping = np.full(count, grid.beam.retardation_time)

    def by_class(values: np.ndarray) -> np.ndarray:
        return values.reshape(count, size, *values.shape[1:])

    jacobian, jacobian_xi = map(by_class, jacobians(grid, element, xi))
    tables, scaled, inverse = grid.beam.element.tables, scale[:, None, :], 1.0 / jacobian[:, :, None]
    slope, second = np.ascontiguousarray(tables.slope * scaled * inverse), np.empty((count, 0, 0))
    if grid.beam.element.forces.code == ELASTIC_LINE:
        curve = tables.curve - jacobian_xi[:, :, None] * inverse * tables.slope
        second = np.ascontiguousarray(curve * scaled * inverse**2)
    weight, stiffness, reference = map(by_class, (weight, stiffness, reference))
    shapes = kind, slope, second, scale, jacobian
    return Classes(*shapes, weight, stiffness, reference, mass, gravity, length, damping)


def _equal_elements(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return the first element (nc,) of each class and the class (ne,) of each element."""
    if not (grid.straight and grid.beam.prismatic):
        every = np.arange(grid.elements)
        return every, every
    lengths = grid.lengths
    longest = lengths.max()
    if lengths.min() >= (1.0 - 0.5 * _ALIKE) * longest:
        return np.zeros(1, dtype=np.int64), np.zeros(grid.elements, dtype=np.int64)
    rounded = np.round(lengths / (_ALIKE * longest))
    _, first, kind = np.unique(rounded, return_index=True, return_inverse=True)
    return first, kind.astype(np.int64)


def likenesses(grids: Sequence[Grid]) -> list[Hashable]:
    """Return for each grid a key that straight prismatic beams of one element share if their classes are equal.

    Lengths are compared to a relative 1e-12. Any other beam has its number as key.
    """
    keys: list[Hashable] = list(range(len(grids)))
    if len(grids) == 1:
        return keys
    sized: defaultdict[int, list[int]] = defaultdict(list)
    for number, grid in enumerate(grids):
        if grid.straight and grid.beam.prismatic:
            sized[len(grid.parameter)].append(number)
    for numbers in sized.values():
        rate = np.array([grids[i].rate for i in numbers])[:, None]
        lengths = rate * np.diff(np.array([grids[i].parameter for i in numbers]), axis=1)
        unit = 2.0 ** np.ceil(np.log2(lengths.max(axis=1)))
        rounded = np.round(lengths / unit[:, None], 12)
        for i, size, row in zip(numbers, unit.tolist(), rounded, strict=True):
            beam = grids[i].beam
            keys[i] = size, row.tobytes(), by_value(beam.section), by_value(beam.material), beam.retardation_time
    return keys


def _inertia(grid: Grid, chosen: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return mass (nc, nv, nv), load of a uniform acceleration (nc, nv) and load of a uniform force (nc, nv)."""
    tables = grid.beam.element.tables
    where, at, weight = length_points(grid, chosen)
    inertia = inertia_at(grid, where, at, weight)
    count, points = len(chosen), len(tables.r)
    mass, first, rotary = inertia.reshape(count, points, 3).transpose(2, 0, 1)
    matrix, gravity = mass @ tables.rr + rotary @ tables.dd, mass @ tables.r
    if first.any():
        matrix += first @ tables.rd
        gravity += first @ tables.d
    matrix = matrix.reshape(count, *scale.shape[1:], -1) * (scale[:, :, None] * scale[:, None, :])
    return matrix, gravity * scale, weight.reshape(count, points) @ tables.r * scale


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
