"""Constants of a reduced model as an elastic body in a floating frame."""

from dataclasses import replace

import numpy as np

from beamfem.curves import Line
from beamfem.element.element import CRBF
from beamfem.equations import equations
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError
from beamfem.linalg.tangent import UNROTATED
from beamfem.model.beam import Point
from beamfem.model.rotating_frame import RotatingFrame
from beamfem.parts.floating_body import Carrier, FloatingBody
from beamfem.section import StiffnessSection
from beamfem.solve.linear.linear_model import LinearModel

_NEGLIGIBLE = 1e-12  # stiffness and mass of carriers, relative to the body
_ROUND_OFF = 1e-9  # of the forces of single entries: that of a rigid motion


def floating_body(reduced: LinearModel) -> FloatingBody:
    """Return a reduced model of a free body as a part, see `LinearModel.floating_body`. Raises InputError.

    About the first interface, in axes that turn at 1 rad/s, the Coriolis matrix is 2 C and the force at rest -h.
    """
    model, interfaces, p = reduced.model, reduced.interfaces, reduced.state.p
    if len(interfaces) < 2:
        raise InputError("a floating body needs two interfaces or more, as of reduce(model, [beam.start, beam.end], 4)")
    if model.loads:
        raise InputError("loads do not act on a floating body; leave them out of the model that is reduced")
    x, y = interfaces[0].reference.tolist()
    system = system_of(replace(model, frame=RotatingFrame(1.0, (x, y))), static=False)
    order = _order(reduced)
    rigid = _rigid_motions(system, p, (x, y))[reduced.coordinates[order]] * (reduced.coordinates[order] >= 0)[:, None]
    basis = reduced.transformation[:, order]
    mass, stiffness, damping = (
        matrix[order][:, order].toarray() for matrix in (reduced.mass, reduced.stiffness, reduced.damping)
    )
    for matrix in (stiffness, damping):
        if np.any(np.abs(matrix @ rigid) > _ROUND_OFF * (np.abs(matrix) @ np.abs(rigid)).max(axis=0)):
            raise InputError("a floating body must be free: without supports, springs and dampers to the ground")
    if not np.array_equal(p, system.reference):
        raise InputError("a floating body must be reduced about its reference; leave out about")

    still, free, count = np.zeros_like(p), system.free_dofs, 3 * len(interfaces)
    rates = equations.linearise(system, p, still, still, 0.0, (0.0, 1.0, 0.0))[1].sparse(UNROTATED)
    spinning = 0.5 * (basis[free].T @ rates @ basis[free] - damping)
    outward = -basis.T @ equations.residual(system, p, still, still, 0.0)
    whole, scale = rigid.T @ mass @ rigid, np.ones(len(order))
    scale[count:] = np.sqrt(whole[0, 0])  # amplitudes in m
    moved, outward = (scale[:, None] * (mass @ rigid))[3:], (scale * outward)[3:]
    mass, elastic, lost, spinning = (
        (scale[:, None] * matrix * scale)[3:, 3:] for matrix in (mass, stiffness, damping, spinning)
    )
    lower, below, damped = np.tril_indices(len(moved)), np.tril_indices(len(moved), -1), bool(lost.any())
    numbers = [
        (whole[0, 0], whole[2, 1], -whole[2, 0], whole[2, 2]),
        *(point.reference for point in interfaces),
        *(moved[:, 0], moved[:, 1], outward, moved[:, 2]),
        *(matrix[lower] for matrix in ((mass, elastic, lost) if damped else (mass, elastic))),
        spinning[below],
    ]
    ends = _carriers(interfaces, np.diag(stiffness), float(whole[0, 0]))
    return FloatingBody(ends, float(whole[0, 0]), len(order) - count, tuple(np.concatenate(numbers).tolist()), damped)


def _order(reduced: LinearModel) -> list[int]:
    """Return the numbers of x, y and the angle of each interface among the coordinates z, and then those of the others.

    Raises InputError.
    """
    place = {dof: number for number, dof in enumerate(reduced.coordinates.tolist()) if dof >= 0}
    order = []
    for point in reduced.interfaces:
        mesh = reduced.model.mesh_of(point)
        dofs = mesh.coordinates_of(mesh.node_at(point.fraction))
        if "theta" not in dofs:
            raise InputError("interfaces of a floating body need rotations as coordinates, as those of CRBF(3) have")
        if not {dofs[name] for name in ("r^x", "r^y", "theta")} <= place.keys():
            raise InputError("a floating body must be free: without supports, springs and dampers to the ground")
        order += [place[dofs[name]] for name in ("r^x", "r^y", "theta")]
    return order + [number for number in range(len(reduced)) if number not in order]


def _rigid_motions(system: System, p: np.ndarray, about: tuple[float, float]) -> np.ndarray:
    """Return the rates (n, 3) of two translations and of a rotation."""
    motions = RigidVelocity((1.0, 0.0)), RigidVelocity((0.0, 1.0)), RigidVelocity(angular=1.0, about=about)
    return np.array([rigid_rates(system, motion, p) for motion in motions]).T


def _carriers(interfaces: tuple[Point, ...], stiffness: np.ndarray, mass: float) -> tuple[Point, ...]:
    """Return the interfaces (m,) as ends of beams; stiffness (3 m,): of their coordinates."""
    beams: list[Carrier] = []
    for number, point in enumerate(interfaces[1:], 1):
        axis = Line(tuple(interfaces[0].reference.tolist()), tuple(point.reference.tolist()))
        along, across, turning = (_NEGLIGIBLE * stiffness[3 * number : 3 * number + 3]).tolist()
        stretching, own = axis.length * max(along, across), _NEGLIGIBLE * mass / axis.length
        section = StiffnessSection(stretching, stretching, axis.length * turning, own, own * axis.length**2)
        beams.append(Carrier(axis, 1, CRBF(1), section, first=beams[0] if beams else None))
    return beams[0].start, *(beam.end for beam in beams)
