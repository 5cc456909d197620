"""Coordinates that are prescribed by supports."""

from typing import NamedTuple

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.model.supports import PointSupport, Value
from beamfem.validation import function_value

COORDINATES = {"ux": "r^x", "uy": "r^y", "rotation": "theta"}  # nodal coordinate by direction of a support


class PrescribedCoordinate(NamedTuple):
    """A coordinate that a support prescribes.

    value: its change from the reference, a number or a function of time; rotation: whether it is a rotation; point:
    position of the support.
    """

    dof: int
    value: Value
    rotation: bool
    point: Point

    def change(self, time: float, static: bool) -> float:
        """Return the change from the reference at a time, in statics at a load factor."""
        if callable(self.value):
            return function_value(f"Prescribed at {self.point}: value", self.value, time)
        return self.value * (time if static else 1.0)


def prescribed_coordinates(model: Model) -> tuple[PrescribedCoordinate, ...]:
    """Return the prescribed coordinates ordered by number. Raises InputError if two supports prescribe the same one."""
    coordinates: dict[int, PrescribedCoordinate] = {}
    for support in model.point_supports:
        mesh = model.mesh_of(support.point)
        dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
        for direction, value in support.prescribed().items():
            name = coordinate_of(support, direction)
            if name is None:
                continue
            dof = dofs[name]
            if dof in coordinates:
                what = type(support).__name__
                raise InputError(
                    f"{what} at {support.point}: another support already prescribes {direction} there; one is enough"
                )
            coordinates[dof] = PrescribedCoordinate(dof, value, direction == "rotation", support.point)
    return tuple(coordinates[dof] for dof in sorted(coordinates))


def inclined_rollers(model: Model, prescribed: set[int]) -> tuple[tuple[int, np.ndarray], ...]:
    """Return first coordinate of r and unit normal of each roller not along x or y. Raises InputError."""
    rollers = []
    for support in model.point_supports:
        normal = support.direction
        if normal is not None and _axis_of(normal) is None:
            mesh = model.mesh_of(support.point)
            dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            rollers.append((dofs["r^x"], normal))
    if len({dof for dof, _ in rollers}) < len(rollers):
        raise InputError("two inclined Rollers stand at the same point", remedy="a Pin constrains both directions")
    for dof, _ in rollers:
        if dof in prescribed or dof + 1 in prescribed:
            raise InputError("an inclined Roller stands where another support already constrains the displacement")
    return tuple(rollers)


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
