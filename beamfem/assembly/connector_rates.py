"""How the force of a connector depends on velocities and on time, from evaluations near the reference."""

import numpy as np

from beamfem.assembly.connector import Connector, Motion
from beamfem.model.contribution import remembered

WIDTH = 1e-7  # of the central differences to which complex steps are compared, relative to the natural units
_NEAR = 1e-3  # distance from the reference at which a force is checked, and rates per second, in the same units
AGREE = 1e-4
ROUND_OFF = 16.0 * float(np.finfo(float).eps)  # of the terms of a force
_GRAVITY = np.array([0.3, -0.7])  # arbitrary, of the size of the beams per s^2
TIMES = (0.5, 0.0, 0.813)


def damps_at_rest(item: Connector) -> bool:
    """Return whether the force of small motions about rest depends on velocities; centrifugal forces vanish there."""
    resting, moving = (_by_rates(item, motion) for motion in (resting_near(item.alone), somewhere_near(item.alone)))
    return float(np.abs(resting).max(initial=0.0)) > ROUND_OFF * float(np.abs(moving).max(initial=0.0))


def resists_rates(item: Connector) -> bool:
    """Return whether forces that depend on velocities do work beyond the change of the kinetic energy.

    Those of an eccentric mass do not: at constant velocities, f(q, v) - f(q, 0) has the power dT/dt.
    """
    alone, gravity = item.alone, gravity_of(item)
    if not _by_rates(item, somewhere_near(alone)).any():
        return False
    if damps_at_rest(item) or not item.item.conservative:
        return True
    (p, v, a), number = somewhere_near(alone), len(alone.dofs)
    p[alone.own], a = 0.0, 0.0 * a
    forces = [alone.force(alone.at((p, rate, a), TIMES[0], gravity)).real[:number] for rate in (v, 0.0 * v)]
    power = float((forces[0] - forces[1]) @ v[alone.dofs])
    change = WIDTH / _NEAR * v
    change[alone.memory] = 0.0
    after, before = (alone.energy(alone.at((p + side * change, v, a), TIMES[0], gravity))[0] for side in (1.0, -1.0))
    gained = float(np.real(after - before)) / (2.0 * WIDTH / _NEAR)
    round_off = ROUND_OFF * float((np.abs(forces[0]) + np.abs(forces[1])) @ np.abs(v[alone.dofs]))
    round_off += ROUND_OFF * abs(after) / (WIDTH / _NEAR)
    return abs(power - gained) > AGREE * max(abs(power), abs(gained)) + round_off


def follows_time(item: Connector) -> tuple[bool, bool]:
    """Return whether the force and whether the constraint conditions depend on time."""
    item = item.alone
    motion = somewhere_near(item)
    first, *others = (item.force(item.at(motion, time, gravity_of(item))).real for time in TIMES)
    changed = np.any([other != first for other in others], axis=0)
    return bool(changed[: len(item.dofs)].any()), bool(changed[len(item.dofs) :].any())


def somewhere_near(item: Connector) -> Motion:
    """Return an arbitrary motion near the reference; item: `Connector.alone`, as all of these."""
    rng = np.random.default_rng(3)
    p, v, a = (_NEAR * rng.standard_normal(item.variables) for _ in range(3))
    for values in (p, v, a):
        values[item.dofs] *= item.units
    p[item.dofs] += item.undeformed
    p[item.memory] = remembered(item.item)
    return p, v, a


def resting_near(item: Connector) -> Motion:
    """Return an arbitrary state at rest near the reference."""
    p, v, a = somewhere_near(item)
    return p, 0.0 * v, 0.0 * a


def gravity_of(item: Connector) -> np.ndarray:
    """Return an arbitrary acceleration (2,) of gravity."""
    return _GRAVITY * item.units[0]


def _by_rates(item: Connector, motion: Motion) -> np.ndarray:
    """Return the derivative (d + k, d + k) of the force of `Connector.alone` by the velocities in a motion of it."""
    return item.alone.tangent(motion, TIMES[0], gravity_of(item), (0.0, 1.0, 0.0))
