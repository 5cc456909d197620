"""Forces and moments that supports exert on a beam."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.analysis.equations import residual
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.system import System
from beamfem.postprocess import nodal_vectors

if TYPE_CHECKING:
    from beamfem.solution import Solution


def reaction(solution: "Solution", point: Point) -> np.ndarray:
    """Return fx, fy [N] and m [N m] of the support at a point (steps, 3); m is d x the force on d.

    Raises InputError where no support is.
    """
    model = solution.model
    mesh = model.mesh_of(point)
    if not any(s.point.beam is point.beam and abs(s.point.fraction - point.fraction) < 1e-9 for s in model.supports):
        raise InputError(f"there is no support at {point}, so there is no reaction")
    system = System(model, solution.static)
    held = np.zeros(model.size, dtype=bool)
    held[system.held_dofs] = True
    for dof, _ in system.inclined:
        held[dof : dof + 2] = True
    node = mesh.node_at(point.fraction)
    dofs = mesh.dofs_of_node(node)
    element = mesh.beam.element
    labels = element.coordinates.labels(element.field.vectors)
    director = nodal_vectors(mesh, solution.p)[:, node, element.field.vectors.index("r_y")]
    result = np.zeros((len(solution), 3))
    for row, at in enumerate(solution.at):
        force = residual(system, solution.p[row], solution.v[row], solution.a[row], at)
        local = dict(zip(labels, np.where(held, force, 0.0)[dofs], strict=True))
        result[row, :2] = local["r^x"], local["r^y"]
        if "theta" in local:
            result[row, 2] = local["theta"]
        else:
            result[row, 2] = director[row, 0] * local["r_y^y"] - director[row, 1] * local["r_y^x"]
    return result
