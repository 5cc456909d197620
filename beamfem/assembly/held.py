"""Coordinates that supports prescribe."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.model.supports import PointSupport, Roller, Value
from beamfem.validation import function_value


@dataclass(frozen=True)
class Held:
    """A coordinate that a support prescribes: its reference and a value, or a function of time, on top.

    turns: whether it is a rotation; point: where the support stands.
    """

    dof: int
    value: Value
    turns: bool
    point: Point

    def change(self, time: float, static: bool) -> float:
        """Return the change from the reference at a time, in statics at a load factor."""
        if callable(self.value):
            return function_value(f"Prescribed at {self.point}: value", self.value, time)
        return self.value * (time if static else 1.0)


def prescribed_coordinates(model: Model) -> tuple[Held, ...]:
    """Return the held coordinates, ordered by number. Raises InputError where two supports hold the same one."""
    held: dict[int, Held] = {}
    for support in model.point_supports:
        mesh = model.mesh_of(support.point)
        dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
        for direction, value in support.held().items():
            name = prescribed_coordinate(support, direction)
            if name is None:
                continue
            if dofs[name] in held:
                what = type(support).__name__
                raise InputError(f"{what} at {support.point}: another support already holds {direction} there")
            held[dofs[name]] = Held(dofs[name], value, direction == "rotation", support.point)
    return tuple(held[dof] for dof in sorted(held))


def inclined_rollers(model: Model, held: set[int]) -> tuple[tuple[int, np.ndarray], ...]:
    """Return first coordinate of r and unit normal of each roller that neither x nor y describes. Raises InputError."""
    found = []
    for support in model.supports:
        if isinstance(support, Roller) and _axis_of(support) is None:
            mesh = model.mesh_of(support.point)
            dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            found.append((dofs["r^x"], support.direction))
    if len({dof for dof, _ in found}) < len(found):
        raise InputError("two inclined Rollers stand at the same point; a Pin holds both directions")
    for dof, _ in found:
        if dof in held or dof + 1 in held:
            raise InputError("an inclined Roller stands where another support already holds a displacement")
    return tuple(found)


def prescribed_coordinate(support: PointSupport, direction: str) -> str | None:
    """Name the coordinate that holds a direction of a support; None for an inclined roller."""
    if direction == "rotation":
        return "theta"
    if direction == "normal":
        assert isinstance(support, Roller)
        axis = _axis_of(support)
        return None if axis is None else f"r^{axis}"
    return f"r^{direction[1]}"


def _axis_of(support: Roller) -> str | None:
    """Name the axis that the normal of a roller is along, if any."""
    nx, ny = np.abs(support.direction)
    if ny < 1e-12:
        return "x"
    return "y" if nx < 1e-12 else None
