"""Velocities and accelerations of a model that is described in a rotating frame.

When the rotating axes have the directions of axes at rest, coordinates p and their rates in the rotating frame are
those of the motion seen from rest

    p,   v + w (J (p - c) + t),   a + 2 w J v - w^2 N (p - c),

where J turns nodal vectors by a right angle, N = -J^2 selects their components, c has the center of the rotation in
place of each position, and t is one for each angle. All equations are therefore those of a frame at rest.
"""

from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.equations.bound_connector import Connector
from beamfem.equations.connector_traits import TIMES, gravity_of, resting_near
from beamfem.equations.model_coordinates import columns_of
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import System
from beamfem.errors import InputError

_NEGLIGIBLE = 1e-9  # of the power of single forces: that of all forces of a rigid rotation


def speeds(system: System, time: float) -> tuple[tuple[float, float], ...]:
    """Return weights and speeds [rad/s] whose weighted equations are those at a time, in statics at a load factor.

    Centrifugal forces are proportional to the load factor, negative ones included.
    """
    assert system.model.frame is not None
    speed = system.model.frame.speed
    if not system.static or time == 1.0:
        return ((1.0, speed),)
    if time >= 0.0:
        return ((1.0, np.sqrt(time) * speed),)
    return (2.0, 0.0), (-1.0, np.sqrt(-time) * speed)


def absolute(
    system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return p' and p'' (n,) of the motion at rest."""
    assert system.model.frame is not None
    spin = rigid_rates(system, RigidVelocity(angular=speed, about=system.model.frame.about), p)
    return v + spin, a + speed * (right_angle(system) @ (2.0 * v + spin))


def seen_from_rest(
    system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, times: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return p' and p'' (rows, n) of rows of a solution, whose own are those in the frame of the model.

    times (rows,): times [s], in statics load factors. Raises InputError for negative load factors.
    """
    if system.model.frame is None or not len(p):
        return v, a
    if system.static and times.min() < 0.0:
        raise InputError("section forces in a rotating frame are known for load factors >= 0 only")
    turning = [speeds(system, time)[0][1] for time in times.tolist()]
    found = np.array([absolute(system, *row) for row in zip(p, v, a, turning, strict=True)])
    return found[:, 0], found[:, 1]


def right_angle(system: System) -> csr_array:
    """Return J (n, n), which turns nodal vectors by a right angle, counter-clockwise."""
    return system.table(_right_angle)


def _right_angle(system: System) -> csr_array:
    for item in system.connectors.items:
        _require_frame_indifferent(item, system)
    pairs = [np.empty((0, 2), dtype=np.int64)]  # numbers of x and y of nodal vectors
    for block, element in zip(system.blocks, system.model.groups, strict=True):
        columns = columns_of(block.node_kind, block.dof, element.field.vectors)
        pairs += [np.column_stack([x, y]) for (label, _, x), (_, _, y) in pairwise(columns) if label.endswith("^x")]
    x, y = np.unique(np.concatenate(pairs), axis=0).T
    entries = np.concatenate([np.full(len(x), -1.0), np.ones(len(x))])
    places = np.append(x, y), np.append(y, x)
    return csr_array(coo_array((entries, places), shape=(system.model.size, system.model.size)))


def _require_frame_indifferent(item: Connector, system: System) -> None:
    """Raise InputError if a connector resists the rotation of the frame, as a damper to the ground would."""
    assert system.model.frame is not None
    alone, gravity = item.alone, gravity_of(item)
    p, zeros, _ = resting_near(alone)
    x, y, _ = (alone.by_point(p[alone.dofs]) - [*system.model.frame.about, 0.0]).T
    v, a = zeros.copy(), zeros.copy()
    v[alone.dofs] = np.column_stack([-y, x, np.ones(len(x))]).ravel()[alone.places]
    a[alone.dofs] = np.column_stack([-x, -y, np.zeros(len(x))]).ravel()[alone.places]
    v[alone.amplitudes] = a[alone.amplitudes] = 0.0
    turning, resting = (alone.force_in(motion, TIMES[0], gravity) for motion in ((p, v, a), (p, zeros, zeros)))
    power = (turning - resting)[: len(alone.dofs)] * v[alone.dofs]
    if abs(power.sum()) > _NEGLIGIBLE * np.abs(power).sum():
        raise InputError(f"{item.name} resists the rotation of a RotatingFrame, as a damper to a ground at rest would")


def right_angle_of_unknowns(system: System) -> tuple[np.ndarray, csr_array]:
    """Return the prescribed coordinates (k,) that J takes unknowns to, and the rows (u + k, u) of J.

    The rows are those of the unknowns, and then of these coordinates: at a roller, the speed along it turns into an
    acceleration across it.
    """
    free, turn = system.free_dofs, right_angle(system)
    prescribed = system.prescribed_dofs
    taken = prescribed[abs(turn[prescribed][:, free]).sum(axis=1) > 0.0]
    return taken, csr_array(turn[np.append(free, taken)][:, free])
