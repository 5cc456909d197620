"""Bounds of strains and of locking from the nodes of elements alone, which decide whether a closer look is worth it.

Between neighbouring nodes, the chord stretches and turns against the sections at both of them. A stretch e and an angle
a over a length l strain the fibres of a section of height h by at most about |e| + 3 h |a| / l, as the fields are
polynomials. The parasitic strains of a cubic field, in terms of its bending strains, are about a l / h.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from beamfem.assembly.system import System
from beamfem.element.coordinates import KINEMATICS, labels
from beamfem.model.mesh import BeamMesh

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_ROWS = 32  # of a solution that are looked at
_Found = TypeVar("_Found")


class Pairs(NamedTuple):
    """Neighbouring nodes (m,) of elements.

    numbers (k,): of the coordinates of both nodes, x1, y1, x2, y2 (m,) each, then the angles of sections, then x and
    then y of their r_y; angled, directed: numbers of the ends (2 m,) of pairs with such coordinates; chord, at_rest:
    inverse of the chord and of r_y in the reference, as complex numbers; length (m,) [m]; curved (m,): largest angle
    [rad] of the chord against the axis at its ends in the reference; mesh (m,): number of the beam.
    """

    numbers: np.ndarray
    angled: np.ndarray
    directed: np.ndarray
    chord: np.ndarray
    at_rest: np.ndarray
    length: np.ndarray
    curved: np.ndarray
    mesh: np.ndarray

    def change(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return what chords (rows, 1, m) and sections at their ends (rows, 2, m) are multiplied by, for p (rows, n).

        Vectors are complex numbers.
        """
        q, m, k = p.take(self.numbers, axis=1), len(self.length), len(self.angled)
        along = q[:, 2 * m : 4 * m] - q[:, : 2 * m]
        chord = (along[:, :m] + 1j * along[:, m:]) * self.chord
        sections = np.exp(1j * q[:, 4 * m : 4 * m + k])
        if len(self.directed):
            x, y = np.split(q[:, 4 * m + k :], 2, axis=1)
            turned, sections = sections, np.empty((len(p), 2 * m), dtype=complex)
            sections[:, self.angled], sections[:, self.directed] = turned, (x + 1j * y) * self.at_rest
        return chord[:, None], sections.reshape(len(p), 2, m)


def rows_looked_at(solution: "Solution") -> slice:
    """Return up to `_ROWS` rows of a solution, the last one among them, and of few all but the first, its start."""
    count = len(solution)
    stride = -(-count // _ROWS)
    return slice((count - 1) % stride if stride > 1 else min(1, count - 1), None, stride)


def shared(system: System, build: Callable[[System], _Found]) -> _Found:
    """Return a function of a model that is computed once for all that are alike."""
    name = f"{build.__module__}.{build.__name__}"
    if name not in system.alike:
        system.alike[name] = build(system)
    found: _Found = system.alike[name]
    return found


def pairs(system: System) -> Pairs:
    """Return the neighbouring nodes of all elements of a model."""
    ends, columns, frames, meshes = [], [], [], []
    for number, mesh in enumerate(system.model.meshes):
        nodes = np.stack([mesh.node[:, :-1].ravel(), mesh.node[:, 1:].ravel()])
        ends.append(mesh.kinematics.dof[:, :2][nodes])
        columns.append(_section_columns(mesh)[nodes])
        frames.append(mesh.kinematics.frame[nodes])
        meshes.append(np.full(nodes.shape[1], number))
    positions = np.concatenate(ends, axis=1).transpose(0, 2, 1).reshape(4, -1)
    section = np.concatenate(columns, axis=1).reshape(-1, 2)
    frame = np.concatenate(frames, axis=1)
    directed = section[:, 1] >= 0
    x1, y1, x2, y2 = system.reference[positions]
    chord = (x2 - x1) + 1j * (y2 - y1)
    d = system.reference[section[directed]]
    leaning = np.angle((frame[..., 0] + 1j * frame[..., 1]) / chord)
    return Pairs(
        np.concatenate([positions.ravel(), section[~directed, 0], section[directed].T.ravel()]),
        np.flatnonzero(~directed),
        np.flatnonzero(directed),
        1.0 / chord,
        1.0 / (d[:, 0] + 1j * d[:, 1]),
        np.abs(chord),
        np.abs(leaning).max(axis=0),
        np.concatenate(meshes),
    )


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
