"""The velocity of a rigid motion, and the resulting rates of the coordinates of a model."""

from dataclasses import dataclass

import numpy as np

from beamfem.equations.model_coordinates import Columns, columns_of, coordinate_columns
from beamfem.equations.system import System
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.validation import convert, finite, squared, vector


@dataclass(frozen=True)
class RigidVelocity:
    """Velocity of a rigid motion, as the initial velocity of a simulation.

    Parameters
    ----------
    vector : (float, float), [m/s], default (0, 0)
        Velocity (vx, vy) of the point `about`.
    angular : float, [rad/s], default 0
        Angular velocity.
    about : (float, float), [m], default (0, 0)
        Center (x, y) of the rotation.

    Examples
    --------
    >>> spin = bf.RigidVelocity(angular=2.0, about=(0.0, 0.0))
    >>> motion = bf.simulate(bf.Model([beam], [bf.Pin(beam.start)]), duration=0.02, step=0.002, velocity=spin)
    """

    vector: tuple[float, float] = (0.0, 0.0)
    angular: float = 0.0
    about: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector", "about")
        convert(self, squared(finite), "angular")


def rigid_rates(system: System, velocity: RigidVelocity, p: np.ndarray) -> np.ndarray:
    """Return the rates (n,) of the coordinates of a model that moves rigidly from the state p (n,)."""
    result = np.zeros(len(p))
    for columns in system.table(_columns_of):
        _set_rates(columns, velocity, p, result)
    return result


def set_rigid_rates(mesh: BeamMesh, velocity: RigidVelocity, p: np.ndarray, rates: np.ndarray) -> None:
    """Write the rates of the coordinates of a beam that moves rigidly from the state p (n,) into `rates` (n,)."""
    _set_rates(coordinate_columns(mesh), velocity, p, rates)


def _columns_of(system: System) -> list[Columns]:
    """Return the coordinates of all beams of each block, which move rigidly by the same formulas."""
    groups = zip(system.blocks, system.model.groups, strict=True)
    return [columns_of(block.node_kind, block.dof, element.field.vectors) for block, element in groups]


def _set_rates(columns: Columns, velocity: RigidVelocity, p: np.ndarray, rates: np.ndarray) -> None:
    for index, (label, _, dofs) in enumerate(columns):
        if label == "theta":
            rates[dofs] = velocity.angular
        elif label != "s":
            name, axis = label.split("^")
            component = "xy".index(axis)
            other = columns[index + 1 - 2 * component][2]
            lever = p[other] - (velocity.about[1 - component] if name == "r" else 0.0)
            rates[dofs] = (-1.0 if axis == "x" else 1.0) * velocity.angular * lever
            if name == "r":
                rates[dofs] += velocity.vector[component]
