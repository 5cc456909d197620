"""Section forces at the ends of a beam, from the equilibrium of its first and last element."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem import postprocess
from beamfem.analysis.equations import element_residual
from beamfem.element.axis import cross
from beamfem.last_digits import exactly
from beamfem.model.beam import Beam
from beamfem.model.mesh import BeamMesh
from beamfem.model.system import System, system_of
from beamfem.postprocess import SectionForces

if TYPE_CHECKING:
    from beamfem.solution import Solution


def with_ends(solution: "Solution", beam: Beam) -> SectionForces:
    """Return the section forces at the Gauss points of a beam, and at its start and end.

    Those at the ends balance the element there, as the reactions do; interpolation would be an order less exact.
    """
    mesh = solution.model.mesh_of(beam.start)
    arc = postprocess.section_forces(mesh, solution.p[:1]).arc_length
    found = exactly(solution, lambda p: _stacked(solution, mesh, p))
    arc_length = np.concatenate([[0.0], arc, [mesh.vertices[-1]]])
    return SectionForces(arc_length, found[:, 0], found[:, 1], found[:, 2])


def _stacked(solution: "Solution", mesh: BeamMesh, p: np.ndarray) -> np.ndarray:
    """Return normal and shear force and moment (steps, 3, stations) at the start, the Gauss points and the end."""
    inside = postprocess.section_forces(mesh, p)
    system = system_of(solution.model, solution.static)
    vectors = postprocess.nodal_vectors(mesh, p)
    ends = []
    for element, local, sign in ((0, 0, -1.0), (mesh.elements - 1, -1, 1.0)):
        node = int(mesh.node[element, local])
        xi = np.array([0.0 if local == 0 else 1.0])
        now = postprocess.axis(mesh, vectors, np.array([element]), xi)
        along = postprocess.direction(mesh, now)[:, 0]
        force, moment = _at_node(solution, p, system, mesh, element, node, vectors[:, node])
        normal = (force * along).sum(axis=1)
        ends.append(np.stack([sign * normal, sign * cross(along, force), sign * moment], axis=1)[:, :, None])
    within = np.stack([inside.normal, inside.shear, inside.moment], axis=1)
    return np.concatenate([ends[0], within, ends[1]], axis=2)


def _at_node(
    solution: "Solution",
    p: np.ndarray,
    system: System,
    mesh: BeamMesh,
    element: int,
    node: int,
    vectors: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return force (steps, 2) [N] and moment (steps,) [N m] that hold an element at one of its nodes."""
    dofs = mesh.coordinates_of(node)
    force, moment = np.empty((len(solution), 2)), np.zeros(len(solution))
    for row, at in enumerate(solution.at):
        state = (p[row], solution.v[row], solution.a[row])
        found = element_residual(system, mesh.block, mesh.first_element + element, *state, at)
        force[row] = found[dofs["r^x"]], found[dofs["r^y"]]
        if "theta" in dofs:
            moment[row] = found[dofs["theta"]]
        for place, name in enumerate(mesh.vectors):
            if name != "r" and f"{name}^x" in dofs:
                pair = np.array([found[dofs[f"{name}^x"]], found[dofs[f"{name}^y"]]])
                moment[row] += cross(vectors[row, place], pair)
    return force, moment
