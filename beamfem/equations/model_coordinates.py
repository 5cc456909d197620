"""Coordinates of the stress-free state of a model, and those that supports prescribe."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from beamfem.element.coordinates import across, labels
from beamfem.equations.connector_nodes import first_value
from beamfem.errors import InputError
from beamfem.kernels.block import ROTATED_GRADIENTS, Block
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.contribution import prescribed_by, uses_rotations
from beamfem.model.model import Model
from beamfem.model.supports import PointSupport, Value
from beamfem.model.time_functions import Integral
from beamfem.validation import called, function_value

Columns = list[tuple[str, np.ndarray, np.ndarray]]


def coordinate_columns(mesh: BeamMesh) -> Columns:
    """Return name, nodes and numbers in the model of each coordinate of a beam, for each kind of node.

    Joined nodes with gradients share r_y, rotated by the angle between them; it is listed at the first of them only.
    """
    return columns_of(mesh.kinematics.node_kind, mesh.kinematics.dof, mesh.vectors)


def columns_of(node_kinds: np.ndarray, dof: np.ndarray, vectors: tuple[str, ...]) -> Columns:
    """Return `coordinate_columns` for nodes of the given kinds (N,) with coordinates dof (N, npn)."""
    result = []
    for node_kind in np.unique(node_kinds).tolist():
        nodes = np.flatnonzero(node_kinds == node_kind)
        for column, label in enumerate(labels(node_kind, vectors)):
            if node_kind != ROTATED_GRADIENTS or not label.startswith("r_y"):
                result.append((label, nodes, dof[nodes, column]))
    return result


_SOURCES = ("r^x", "r^y", "r_x^x", "r_x^y", "r_y^x", "r_y^y", "s")


def stress_free(model: Model, blocks: Sequence[Block]) -> np.ndarray:
    """Return the coordinates (n,) of a model in its reference; multipliers and history variables are zero."""
    p = np.zeros(model.size)
    for number, (element, block) in enumerate(zip(model.groups, blocks, strict=True)):
        meshes = [mesh for mesh in model.meshes if mesh.block == number]
        position, tangent, speed = (
            np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in ("position", "tangent", "speed")
        )
        speed = speed[:, None]
        table = np.concatenate((position, tangent * speed, across(tangent), speed), axis=1)
        for label, nodes, dofs in columns_of(block.node_kind, block.dof, element.field.vectors):
            if label != "theta":
                p[dofs] = table[nodes, _SOURCES.index(label)]
    return p


COORDINATES = {"ux": "r^x", "uy": "r^y", "rotation": "theta"}  # nodal coordinate by direction of a support


class PrescribedCoordinate(NamedTuple):
    """A coordinate that a support prescribes.

    value: its change from the reference, a number or a function of time; rotation: whether it is a rotation; source:
    the part that prescribes it and its place, for messages about functions.
    """

    dof: int
    value: Value
    rotation: bool
    source: str

    @property
    def name(self) -> str:
        return f"value prescribed by {self.source}"

    def change(self, time: float, static: bool) -> float:
        """Return the change from the reference at a time, in statics at a load factor."""
        if callable(self.value):
            return function_value(self.name, self.value, time)
        return self.value * (time if static else 1.0)

    def course(self, times: np.ndarray) -> np.ndarray:
        """Return the changes (n,) from the reference at times (n,) of a motion."""
        if isinstance(self.value, Integral):
            values = called(self.name, self.value.course, times)
            if np.isfinite(values).all():
                return np.asarray(values)
        return np.array([self.change(time, False) for time in times.tolist()])


def prescribed_coordinates(model: Model) -> tuple[PrescribedCoordinate, ...]:
    """Return the prescribed coordinates and values of conditions ordered by number.

    Raises InputError if two supports prescribe the same one.
    """
    coordinates: dict[int, PrescribedCoordinate] = {}
    for support in model.point_supports:
        mesh = model.mesh_of(support.point)
        dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
        source = f"{model.name_of(support)} at {support.point}"
        for direction, value in support.prescribed().items():
            name = coordinate_of(support, direction)
            if name is None:
                continue
            dof = dofs[name]
            if dof in coordinates:
                raise InputError(f"{source}: another support already prescribes {direction} there; one is enough")
            coordinates[dof] = PrescribedCoordinate(dof, value, direction == "rotation", source)
    values = ((item, value) for item in model.at_points for value in prescribed_by(item))
    for dof, (item, value) in enumerate(values, first_value(model)):
        source = f"{model.name_of(item)} at {item.points[-1]}"
        coordinates[dof] = PrescribedCoordinate(dof, value, uses_rotations(item), source)
    return tuple(coordinates[dof] for dof in sorted(coordinates))


def inclined_normals(model: Model, prescribed: set[int]) -> tuple[tuple[int, np.ndarray], ...]:
    """Return the first coordinate of r and the unit normal of each support that is inclined. Raises InputError."""
    found = dict[int, np.ndarray]()
    for support in model.point_supports:
        normal = support.direction
        if normal is not None and _axis_of(normal) is None:
            mesh = model.mesh_of(support.point)
            dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            dof, inclined = dofs["r^x"], f"inclined {model.name_of(support)}"
            if dof in found:
                raise InputError(f"two {inclined}s stand at the same point", remedy="one support can hold ux and uy")
            if dof in prescribed or dof + 1 in prescribed:
                raise InputError(f"an {inclined} stands where another support already constrains the displacement")
            found[dof] = normal
    return tuple(found.items())


def coordinate_of(support: PointSupport, direction: str) -> str | None:
    """Return the name of the nodal coordinate for a direction of a support, None for an inclined normal."""
    if direction != "normal":
        return COORDINATES[direction]
    assert support.direction is not None
    axis = _axis_of(support.direction)
    return None if axis is None else f"r^{axis}"


def _axis_of(normal: np.ndarray) -> str | None:
    """Return the name of the axis that a unit normal (2,) is parallel to, None if there is none."""
    nx, ny = np.abs(normal)
    if ny < 1e-12:
        return "x"
    return "y" if nx < 1e-12 else None


def set_coordinates(mesh: BeamMesh, values: Mapping[str, np.ndarray], p: np.ndarray) -> None:
    """Set the coordinates of a mesh in p (n,); values: of every coordinate that a node could have (nodes,), by name."""
    for label, nodes, dofs in coordinate_columns(mesh):
        # a rotated vector belongs to the first of the joined nodes
        mask = mesh.kinematics.node_kind[nodes] != ROTATED_GRADIENTS if label.startswith("r_y") else slice(None)
        p[dofs[mask]] = values[label][nodes[mask]]
