"""Points along the axis of a beam, in the reference and in states; nodal vectors and angles that they depend on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element import coordinates
from beamfem.element.fields import Axis, cross, dot
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import interpolate, reference_position
from beamfem.mesh.section_stress import Distributions, distributions, layers

_DIFFERENCE = 1e-5  # of coordinates: change along p' by which B' is found


def nodal_vectors(
    mesh: BeamMesh, p: np.ndarray, some: np.ndarray | None = None, v: np.ndarray | None = None
) -> np.ndarray:
    """Return the nodal vectors e (steps, nodes, vectors per node, 2) of states p (steps, n), of some nodes or all.

    v (steps, n): rates p', for the rates e' = B p' in place of e.
    """
    dof, frame, kinds = _nodes(mesh, some)
    table = p.take(dof, axis=1)
    result = np.empty((*table.shape[:2], len(mesh.vectors), 2))
    for node_kind, nodes in kinds:
        own = node_kind, mesh.vectors, table[:, nodes]
        if v is None:
            result[:, nodes] = coordinates.nodal_vectors(*own, frame[nodes])
        else:
            result[:, nodes] = coordinates.nodal_rates(*own, v[:, dof[nodes]], frame[nodes])
    return result


def _nodes(mesh: BeamMesh, some: np.ndarray | None) -> tuple[np.ndarray, np.ndarray, Sequence[tuple[int, np.ndarray]]]:
    """Return coordinates (k, npn) and frames (k, 3) of some nodes (k,) or all, and each kind with its nodes."""
    nodes = mesh.kinematics
    if some is None:
        return nodes.dof, nodes.frame, mesh.node_kinds
    kind = nodes.node_kind[some]
    return nodes.dof[some], nodes.frame[some], [(own, np.flatnonzero(kind == own)) for own in set(kind.tolist())]


def axis(mesh: BeamMesh, vectors: np.ndarray, element: np.ndarray, xi: np.ndarray) -> Axis:
    """Interpolate nodal vectors (steps, nodes, vectors, 2) at points (element, xi), both (points,)."""
    own = mesh.node[element]
    local = vectors.take(own, axis=1).reshape(len(vectors), len(element), own.shape[1] * vectors.shape[2], 2)
    return interpolate(mesh, local, element, xi)


def axis_at(mesh: BeamMesh, p: np.ndarray, element: np.ndarray, xi: np.ndarray, v: np.ndarray | None = None) -> Axis:
    """Return the axis in states p (steps, n), or its rate for v, at points (element, xi), both (points,)."""
    some = mesh.node[element].ravel()
    if len(some) >= mesh.nodes:
        return axis(mesh, nodal_vectors(mesh, p, None, v), element, xi)
    vectors = nodal_vectors(mesh, p, some, v)
    return interpolate(mesh, vectors.reshape(len(vectors), len(element), -1, 2), element, xi)


def has_angles(mesh: BeamMesh) -> bool:
    """Return whether the rotation of every node's section is a coordinate."""
    if mesh.beam.element.forces.turns_with == "r_x":
        return False
    return all(coordinates.labels(node_kind, mesh.vectors)[-1] == "theta" for node_kind, _ in mesh.node_kinds)


def nodal_angles(mesh: BeamMesh, p: np.ndarray, some: np.ndarray) -> np.ndarray:
    """Return the rotations (steps, k) [rad] of some nodes (k,) of a beam that has them as coordinates."""
    last = {node_kind: len(coordinates.labels(node_kind, mesh.vectors)) - 1 for node_kind, _ in mesh.node_kinds}
    column = [last[node_kind] for node_kind in mesh.kinematics.node_kind[some].tolist()]
    return np.asarray(p[:, mesh.kinematics.dof[some, column]])


@dataclass(frozen=True, eq=False)
class AxisPoints:
    """Points of a beam's axis, given by element and xi (points,).

    pieces: number of equal intervals of every element between them; 0 for points at other places.
    """

    mesh: BeamMesh
    element: np.ndarray
    xi: np.ndarray
    pieces: int = 0

    @classmethod
    def on_each(cls, mesh: BeamMesh, xi: np.ndarray, pieces: int = 0) -> "AxisPoints":
        """Return points at the same xi (k,) of every element."""
        return cls(mesh, np.repeat(np.arange(mesh.elements), len(xi)), np.tile(xi, mesh.elements), pieces)

    @classmethod
    def spaced(cls, mesh: BeamMesh, pieces: int) -> "AxisPoints":
        """Return the ends of equal intervals of every element; adjacent elements both include their common end."""
        return cls.on_each(mesh, np.arange(pieces + 1) / pieces, pieces)

    @classmethod
    def at(cls, mesh: BeamMesh, fractions: Sequence[float]) -> "AxisPoints":
        """Return the points at fractions of the length of a beam."""
        return cls(mesh, *mesh.locate(np.array(fractions)))

    def by_element(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values (rows, points) on each element as (rows, elements, k), and xi (k,), see `on_each`."""
        each = len(self.xi) // self.mesh.elements
        return values.reshape(len(values), self.mesh.elements, each), self.xi[:each]

    @cached_property
    def arc_length(self) -> np.ndarray:
        """Arc length in the reference configuration (points,) [m]."""
        return self.mesh.arc_length(self.element, self.xi)

    @cached_property
    def distributions(self) -> Distributions:
        """The layers of the section at each point, and the distribution of section forces over their height."""
        return distributions(self.mesh, self.element, self.xi)

    @cached_property
    def layers(self) -> np.ndarray:
        """Lower and upper y of each layer of the section (points, layers, 2) [m], from the bottom up."""
        return layers(self.mesh, self.element, self.xi)

    @cached_property
    def faces(self) -> np.ndarray:
        """Lower and upper y of the section (points, 2) [m]."""
        return self.layers[:, [0, -1], [0, 1]]

    @cached_property
    def reference(self) -> np.ndarray:
        """Position in the reference configuration (points, 2) [m]."""
        return reference_position(self.mesh, self.element, self.xi)

    def positions(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return r [m] and d [-] (steps, points, 2) in the states p (steps, n)."""
        now = self.now(p)
        return now.r, now.d

    def now(self, p: np.ndarray) -> Axis:
        """Return the deformed axis at the points in the states p (steps, n)."""
        return axis_at(self.mesh, p, self.element, self.xi)

    def velocities(self, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the velocity of the axis (steps, points, 2) [m/s]."""
        return axis_at(self.mesh, p, self.element, self.xi, v).r

    def accelerations(self, p: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Return the acceleration of the axis (steps, points, 2) [m/s^2], B p'' + B' p' with B' by a difference."""
        step = _DIFFERENCE / np.maximum(np.abs(v).max(axis=1, initial=0.0), np.finfo(float).tiny)[:, None]
        after, before = (self.velocities(p + way * v, v) for way in (step, -step))
        return self.velocities(p, a) + (after - before) / (2.0 * step[..., None])

    def angular_velocities(self, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the angular velocity of the sections (steps, points) [rad/s]."""
        now, rate = self.now(p), axis_at(self.mesh, p, self.element, self.xi, v)
        turns = "r_s" if self.mesh.beam.element.forces.turns_with == "r_x" else "d"
        vector = getattr(now, turns)
        return cross(vector, getattr(rate, turns)) / dot(vector, vector)
