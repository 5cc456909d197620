"""What a motion starts from."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.analysis.transfer import transferred
from beamfem.element.axis import cross, dot
from beamfem.element.coordinates import labels
from beamfem.errors import InputError
from beamfem.fitting import require_finite
from beamfem.kernels.block import SHEAR_RIGID, STRETCH
from beamfem.model.mesh import BeamMesh
from beamfem.model.reference import reference_position
from beamfem.model.system import System, coordinate_columns
from beamfem.postprocess import nodal_vectors
from beamfem.solution import Solution, State
from beamfem.validation import called, convert, finite, squared, vector

_NEAR = 0.01  # of an element, between the points of a difference
_FORWARD = (-25.0, 48.0, -36.0, 16.0, -3.0)  # twelfths


@dataclass(frozen=True)
class RigidVelocity:
    """Velocity of a rigid motion: vector (vx, vy) [m/s], angular [rad/s] about a point (x, y) [m]."""

    vector: tuple[float, float] = (0.0, 0.0)
    angular: float = 0.0
    about: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector", "about")
        convert(self, squared(finite), "angular")


def start_state(system: System, start: State | None, name: str = "start") -> np.ndarray:
    """Return the coordinates (n,) to start from: the reference, or those of a state of a like model."""
    if start is None:
        return system.reference.copy()
    if not isinstance(start, State):
        raise InputError(f"{name} must be a state, such as solution[-1], got a {type(start).__name__}")
    require_finite(name, start)
    return transferred(start, system, name)[0]


def start_velocity(
    system: System,
    p: np.ndarray,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None,
    start: State | None,
) -> np.ndarray:
    """Return p' (n,) of a velocity field at the state p.

    A function takes the reference position (2,) [m] and gives (vx, vy) [m/s]. Sections then do not turn, unless their
    element ties them to the axis.
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
    return _of_field(system, velocity, p)


def _of_field(system: System, velocity: Callable[[np.ndarray], np.ndarray], p: np.ndarray) -> np.ndarray:
    """Rates (n,) of a velocity field from the state p; a shared coordinate takes the mean of what its beams say."""
    total, times = np.zeros(len(p)), np.zeros(len(p))
    for mesh in system.model.meshes:
        values = np.array([vector("velocity", called("velocity", velocity, x)) for x in mesh.position])
        slopes = _along(mesh, velocity) if "r_x" in mesh.vectors else values
        e = nodal_vectors(mesh, p[None])[0]
        for code, nodes in mesh.carriers:
            names = labels(code, mesh.vectors)
            rates = {"r": values[nodes], "r_x": slopes[nodes]}
            if code in (STRETCH, SHEAR_RIGID):
                # r_x = s t: its rate along t is that of s, across it s times that of the angle
                r_x = e[nodes, mesh.vectors.index("r_x")]
                length = np.linalg.norm(r_x, axis=1)
                turning, stretching = cross(r_x, slopes[nodes]) / length**2, dot(r_x, slopes[nodes]) / length
                rates |= {"theta": turning, "s": stretching}
            for column, label in enumerate(names):
                name, _, axis = label.partition("^")
                if name in rates:
                    dofs = mesh.carried.dof[nodes, column]
                    total[dofs] += rates[name][:, "xy".index(axis)] if axis else rates[name]
                    times[dofs] += 1.0
    return total / np.maximum(times, 1.0)


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


def _along(mesh: BeamMesh, velocity: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Derivative (nodes, 2) [1/s] of a velocity field along the beam, at the ends of its elements.

    By differences of fourth order inside each element, so that the field is asked on the beam only; where two elements
    meet in a node, the mean of both, across a corner each side has its own.
    """
    total, elements = np.zeros((mesh.nodes, 2)), np.zeros((mesh.nodes, 1))
    number = np.arange(mesh.elements)
    for end, inward in ((0, 1.0), (-1, -1.0)):
        slope = np.zeros((mesh.elements, 2))
        for k, weight in enumerate(_FORWARD):
            xi = np.full(mesh.elements, -min(inward, 0.0) + inward * k * _NEAR)
            places = reference_position(mesh, number, xi)
            slope += weight * np.array([vector("velocity", called("velocity", velocity, x)) for x in places])
        nodes = mesh.node[:, end]
        np.add.at(total, nodes, inward * slope / (12.0 * _NEAR * mesh.lengths[:, None]))
        np.add.at(elements, nodes, 1.0)
    return total / np.maximum(elements, 1.0)


def resting_state(system: System, about: State | Solution | None) -> tuple[np.ndarray, float]:
    """Return the coordinates (n,) of a static equilibrium and its load factor: the reference and 0 for None.

    about: a state, or a static solution for its last one; it may come from a model with other supports.
    Raises InputError for a state that moves.
    """
    if isinstance(about, Solution):
        if not about.static:
            raise InputError("about must be a static equilibrium, this solution is a motion; give one of solve_static")
        if not len(about):
            raise InputError("about must be a state, but this solution has no rows")
        about = about[-1]
    p = start_state(system, about, "about")
    if about is None:
        return p, 0.0
    if np.any(about.v) or np.any(about.a):
        raise InputError("about must be a state at rest, this one moves; take it from solve_static")
    return p, about.at
