"""Beams without an angle as a coordinate: gradients determine a rotation only up to full turns."""

import numpy as np

from beamfem.element.coordinates import Gradients
from beamfem.model.mesh import BeamMesh
from beamfem.model.model import Model
from beamfem.once import kept_with


@kept_with
def uncounted(model: Model) -> list[BeamMesh]:
    """Return the meshes (m,) of the beams without a node whose rotation is a coordinate."""
    return [mesh for mesh in model.meshes if _has_gradients_only(mesh)]


def number_uncounted(model: Model, mesh: BeamMesh) -> int | None:
    """Return the number of a mesh of the model among those of `uncounted`, None if it is not one of them."""
    return _numbers_uncounted(model).get(id(mesh))


@kept_with
def _numbers_uncounted(model: Model) -> dict[int, int]:
    return {id(mesh): number for number, mesh in enumerate(uncounted(model))}


def _has_gradients_only(mesh: BeamMesh) -> bool:
    if not isinstance(mesh.beam.element.coordinates, Gradients):
        return False
    return all("theta" not in mesh.labels(int(nodes[0])) for _, nodes in mesh.node_kinds)


def rotation_pairs(model: Model) -> np.ndarray:
    """Return the coordinates x and y (m, 2) of the vector that determines the rotation at the start of each of them."""
    pairs = []
    for mesh in uncounted(model):
        vector = "r_x" if mesh.beam.element.forces.turns_with == "r_x" else "r_y"
        column = mesh.labels(0).index(f"{vector}^x")
        pairs.append(mesh.kinematics.dof[0, column : column + 2])
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)
