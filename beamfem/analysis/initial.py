"""What a motion starts from."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.analysis.transfer import transferred
from beamfem.errors import InputError
from beamfem.model.mesh import BeamMesh
from beamfem.model.system import System, coordinate_columns
from beamfem.solution import Solution, State
from beamfem.validation import finite, vector


@dataclass(frozen=True)
class RigidVelocity:
    """Velocity of a rigid motion: vector (vx, vy) [m/s], angular [rad/s] about a point (x, y) [m]."""

    vector: tuple[float, float] = (0.0, 0.0)
    angular: float = 0.0
    about: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vector", vector("vector of RigidVelocity", self.vector))
        object.__setattr__(self, "about", vector("about of RigidVelocity", self.about))
        finite("angular", self.angular)


def start_state(system: System, start: State | None, name: str = "start") -> np.ndarray:
    """Return the coordinates (n,) to start from: the reference, or those of a state of a like model."""
    if start is None:
        return system.reference.copy()
    if not isinstance(start, State):
        raise InputError(f"{name} must be a state, such as solution[-1], got a {type(start).__name__}")
    return transferred(start, system, name)[0]


def start_velocity(
    system: System,
    p: np.ndarray,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None,
    start: State | None,
) -> np.ndarray:
    """Return p' (n,) of a velocity field at the state p.

    A function takes the reference position (2,) [m] and gives (vx, vy) [m/s]; sections then do not turn.
    """
    result = np.zeros(system.model.size)
    if start is not None and velocity is None:
        result = transferred(start, system, "start")[1]
    if velocity is None:
        return result
    if not isinstance(velocity, RigidVelocity) and not callable(velocity):
        raise InputError(f"velocity must be a RigidVelocity or a function of the position, got {velocity!r}")
    if isinstance(velocity, RigidVelocity):
        return _rigid(system, velocity, p)
    for mesh in system.model.meshes:
        values = np.array([vector("velocity", velocity(x)) for x in mesh.position])
        slopes = _along(mesh, values)
        for label, nodes, dofs in coordinate_columns(mesh):
            if label.startswith(("r^", "r_x^")):
                result[dofs] = (values if label.startswith("r^") else slopes)[nodes, "xy".index(label[-1])]
    return result


def _rigid(system: System, velocity: RigidVelocity, p: np.ndarray) -> np.ndarray:
    """Rates (n,) of a rigid motion from the state p."""
    result = np.zeros(len(p))
    for mesh in system.model.meshes:
        set_rigid_rates(mesh, velocity, p, result)
    return result


def set_rigid_rates(mesh: BeamMesh, velocity: RigidVelocity, p: np.ndarray, rates: np.ndarray) -> None:
    """Write the rates of the coordinates of a beam that moves rigidly from the state p (n,) into `rates` (n,)."""
    columns = coordinate_columns(mesh)
    for place, (label, _, dofs) in enumerate(columns):
        if label == "theta":
            rates[dofs] = velocity.angular
        elif label != "s":
            name, axis = label.split("^")
            component = "xy".index(axis)
            other = columns[place + 1 - 2 * component][2]
            lever = p[other] - (velocity.about[1 - component] if name == "r" else 0.0)
            rates[dofs] = (-1.0 if axis == "x" else 1.0) * velocity.angular * lever
            if name == "r":
                rates[dofs] += velocity.vector[component]


def _along(mesh: BeamMesh, values: np.ndarray) -> np.ndarray:
    """Derivative (nodes, 2) of nodal values along the beam; across a corner each side has its own."""
    result = np.empty_like(values)
    breaks = np.flatnonzero(np.diff(mesh.arc) <= 0.0) + 1
    for part in np.split(np.arange(mesh.nodes), breaks):
        result[part] = np.gradient(values[part], mesh.arc[part], axis=0, edge_order=1)
    return result


def resting_state(system: System, about: State | Solution | None) -> tuple[np.ndarray, float]:
    """Return the coordinates (n,) of a static equilibrium and its load factor: the reference and 0 for None.

    about: a state, or a static solution for its last one; it may come from a model with other supports.
    Raises InputError for a state that moves.
    """
    if isinstance(about, Solution):
        if not about.static:
            raise InputError("about must be a static equilibrium, this solution is a motion; give one of solve_static")
        about = about[-1]
    p = start_state(system, about, "about")
    if about is None:
        return p, 0.0
    if np.any(about.v) or np.any(about.a):
        raise InputError("about must be a state at rest, this one moves; take it from solve_static")
    return p, about.at
