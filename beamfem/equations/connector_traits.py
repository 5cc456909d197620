"""What the force of a connector depends on: rates, time, and the side on which it acts."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.bound_connector import Connector, Motion
from beamfem.model.contribution import is_one_sided, remembered
from beamfem.parts.at_points import ANALYTIC

WIDTH = 1e-7  # of the central differences to which complex steps are compared, relative to the natural units
_NEAR = 1e-3  # distance from the reference at which a force is checked, and rates per second, in the same units
AGREE = 1e-4
_PLACES, _FAR = 32, 4.0  # places at which a dissipation function is evaluated, and their distance in natural units
ROUND_OFF = 16.0 * float(np.finfo(float).eps)  # of the terms of a force
_GRAVITY = np.array([0.3, -0.7])  # arbitrary, of the size of the beams per s^2
TIMES = (0.5, 0.0, 0.813)
_OPEN = ANALYTIC._replace(positive=lambda x: 0.0 * x)


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
        return _dissipates_elsewhere(item)
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


def _dissipates_elsewhere(item: Connector) -> bool:
    """Return whether a part dissipates somewhere, such as at a wall that it may hit."""
    if item.compiled is None or item.compiled.dissipation is None:
        return False
    rng, (start, _, _) = np.random.default_rng(7), somewhere_near(item.alone)
    for _ in range(_PLACES):
        p, v = start.copy(), rng.standard_normal(len(start))
        p[item.alone.dofs] += rng.uniform(-_FAR, _FAR, len(item.dofs)) * item.units
        try:
            if _by_rates(item, (p, v, 0.0 * v)).any():
                return True
        except LinAlgError:  # a law of the elongation need not be defined there
            continue
    return False


def follows_time(item: Connector) -> tuple[bool, bool]:
    """Return whether the force and whether the constraint conditions depend on time."""
    item = item.alone
    motion = somewhere_near(item)
    first, *others = (item.force(item.at(motion, time, gravity_of(item))).real for time in TIMES)
    changed = np.any([other != first for other in others], axis=0)
    return bool(changed[: len(item.dofs)].any()), bool(changed[len(item.dofs) :].any())


def lets_go(item: Connector) -> bool:
    """Return whether a part is open in some states: conditions that come and go, or a force of f.positive alone."""
    part, (p, v, _) = item.compiled, somewhere_near(item.alone)
    q, rates = p[item.alone.dofs], v[item.alone.dofs]
    data = (*item.data, *remembered(item.item)) if part is not None else ()
    if part is not None and part.potential is not None:
        return not part.potential(part.split(q), data, gravity_of(item), _OPEN)
    if part is not None and part.along is not None and part.force is not None:
        return not part.force(part.split(q), part.split(rates), data, _OPEN)
    return is_one_sided(item.item)


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
