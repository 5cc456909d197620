"""Bounds of strains and of locking from the nodes of elements alone, which decide whether a closer look is worth it.

Between neighbouring nodes, the chord stretches and turns against the sections at both of them. A stretch e and an angle
a over a length l strain the fibres of a section of height h by at most about |e| + 3 h |a| / l, as the fields are
polynomials. The parasitic strains of a cubic field, in terms of its bending strains, are about a l / h.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beamfem.assembly.system import System
from beamfem.element.coordinates import KINEMATICS, labels
from beamfem.mesh.beam_mesh import BeamMesh

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

ROWS = 32  # of a solution that are looked at


class Pairs(NamedTuple):
    """Neighbouring nodes (m,) of elements.

    numbers (m, 8): of their coordinates, as `kernels.neighbouring_nodes` takes them; at_rest (m, 3): inverse of the
    chord and of r_y at both ends in the reference, as complex numbers; length (m,) [m]; curved (m,): largest angle
    [rad] of the chord against the axis at its ends in the reference; mesh (m,): number of the beam.
    """

    numbers: np.ndarray
    at_rest: np.ndarray
    length: np.ndarray
    curved: np.ndarray
    mesh: np.ndarray


def rows_looked_at(solution: "Solution") -> slice:
    """Return up to `ROWS` rows of a solution, the last one among them, and of few all but the first, its start."""
    count = len(solution)
    stride = -(-count // ROWS)
    return slice((count - 1) % stride if stride > 1 else min(1, count - 1), None, stride)


def pairs(system: System) -> Pairs:
    """Return the neighbouring nodes of all elements of a model."""
    ends, columns, frames, meshes = [], [], [], []
    for number, mesh in enumerate(system.model.meshes):
        nodes = np.stack([mesh.node[:, :-1].ravel(), mesh.node[:, 1:].ravel()])
        ends.append(mesh.kinematics.dof[:, :2][nodes])
        columns.append(_section_columns(mesh)[nodes])
        frames.append(mesh.kinematics.frame[nodes])
        meshes.append(np.full(nodes.shape[1], number))
    positions, sections = np.concatenate(ends, axis=1), np.concatenate(columns, axis=1)
    frame, p = np.concatenate(frames, axis=1), system.reference
    chord = _vectors(p[positions[1]] - p[positions[0]])
    directed = sections[..., 1] >= 0
    at_rest = np.ones((3, len(chord)), dtype=complex)
    at_rest[0] /= chord
    at_rest[1:][directed] /= _vectors(p[sections[directed]])
    return Pairs(
        np.hstack([*positions, *sections]),
        at_rest.T.copy(),
        np.abs(chord),
        np.abs(np.angle(_vectors(frame) / chord)).max(axis=0),
        np.concatenate(meshes),
    )


def _vectors(components: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2 or more) as complex numbers."""
    return np.asarray(components[..., 0] + 1j * components[..., 1])


def _section_columns(mesh: BeamMesh) -> np.ndarray:
    """Return the numbers (nodes, 2) of the coordinates of the section of each node: its angle and -1, or r_y."""
    result = np.empty((mesh.nodes, 2), dtype=np.int64)
    for node_kind, nodes in mesh.node_kinds:
        last = len(labels(node_kind, mesh.vectors)) - 1
        dof = mesh.kinematics.dof[nodes]
        result[nodes, 0] = dof[:, last if node_kind in KINEMATICS else last - 1]
        result[nodes, 1] = -1 if node_kind in KINEMATICS else dof[:, last]
    return result


def heights(system: System) -> np.ndarray:
    """Return the height (m,) [m] of the section in the middle of the elements of neighbouring nodes."""
    parts = []
    for mesh in system.model.meshes:
        arc, beam = 0.5 * (mesh.vertices[1:] + mesh.vertices[:-1]), mesh.beam
        sections = [beam.section_at(s) for s in (arc[:1] if beam.prismatic else arc).tolist()]
        own = np.array([np.ptp(section.bounds) for section in sections])
        parts.append(np.repeat(np.broadcast_to(own, len(arc)), mesh.node.shape[1] - 1))
    return np.concatenate(parts)
