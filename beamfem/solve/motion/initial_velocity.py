"""Initial velocities of a motion."""

from collections.abc import Callable

import numpy as np

from beamfem.assembly.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.assembly.system import System
from beamfem.element.axis import cross, dot
from beamfem.element.coordinates import labels
from beamfem.errors import InputError
from beamfem.kernels.block import SHEAR_RIGID, STRETCH
from beamfem.model.beam_mesh import BeamMesh
from beamfem.model.reference import reference_position
from beamfem.results.postprocess import nodal_vectors
from beamfem.results.solution import State
from beamfem.solve.start.transfer import transferred
from beamfem.validation import called, vector

_NEAR = 0.01  # of an element, between the points of a difference
_FORWARD = (-25.0, 48.0, -36.0, 16.0, -3.0)  # twelfths


def start_velocity(
    system: System,
    p: np.ndarray,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None,
    start: State | None,
) -> np.ndarray:
    """Return p' (n,) of a velocity field at the state p.

    A function takes the reference position (2,) [m] and returns (vx, vy) [m/s]. Sections then do not rotate, unless
    their element ties them to the axis.
    """
    result = np.zeros(system.model.size)
    if start is not None and velocity is None:
        result = transferred(start, system, "start")[1]
    if velocity is None:
        return result
    if not isinstance(velocity, RigidVelocity) and not callable(velocity):
        raise InputError(f"velocity must be a RigidVelocity or a function of the position, got {velocity!r}")
    if isinstance(velocity, RigidVelocity):
        return rigid_rates(system, velocity, p)
    return _of_field(system, velocity, p)


def _of_field(system: System, velocity: Callable[[np.ndarray], np.ndarray], p: np.ndarray) -> np.ndarray:
    """Return the rates (n,) of a velocity field at the state p; a shared coordinate takes the mean of its beams."""
    total, times = np.zeros(len(p)), np.zeros(len(p))
    for mesh in system.model.meshes:
        values = np.array([vector("velocity", called("velocity", velocity, x)) for x in mesh.position])
        slopes = _along(mesh, velocity) if "r_x" in mesh.vectors else values
        e = nodal_vectors(mesh, p[None])[0]
        for code, nodes in mesh.node_kinds:
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
                    dofs = mesh.kinematics.dof[nodes, column]
                    total[dofs] += rates[name][:, "xy".index(axis)] if axis else rates[name]
                    times[dofs] += 1.0
    return total / np.maximum(times, 1.0)


def _along(mesh: BeamMesh, velocity: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Return the derivative (nodes, 2) [1/s] of a velocity field along the beam, at the ends of its elements.

    It is a difference of fourth order inside each element, so that the field is evaluated on the beam only; at a node
    of two elements it is the mean of both, but at a corner each side has its own.
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
