"""Checks of connectors: analytic, symmetric if they have a potential, and with energies that match their forces."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.connector import COMPLEX_STEP, Connector, Motion
from beamfem.errors import InputError
from beamfem.model.contribution import remembered

WIDTH = 1e-7  # of the central differences to which complex steps are compared, relative to the natural units
_NEAR = 1e-3  # distance from the reference at which a force is checked, and rates per second, in the same units
AGREE = 1e-4
ROUND_OFF = 16.0 * float(np.finfo(float).eps)  # of the terms of a force
_GRAVITY = np.array([0.3, -0.7])  # arbitrary, of the size of the beams per s^2
_BY_Q = (1.0, 0.0, 0.0)
TIMES = (0.5, 0.0, 0.813)


def require_analytic(item: Connector) -> None:
    """Raise InputError if a force or kinetic energy is not analytic.

    Coordinates are measured in the size of the beams and in rad, forces by their work, so that any units of length and
    force are judged alike, and moments beside forces.
    """
    moving = somewhere_near(item)
    if not np.isfinite(item.force(item.at(moving, TIMES[0], gravity_of(item)))).all():
        raise InputError(f"force of {item.name} is not finite near the reference")
    try:
        for kind in range(3):
            exact = item.tangent(moving, TIMES[0], gravity_of(item), [float(kind == number) for number in range(3)])
            _require_same(item, f"force of {item.name}", "qva"[kind], exact, *_slopes(item, item.force, moving, kind))
        item.tangent(resting_near(item), TIMES[0], gravity_of(item), _BY_Q)
    except LinAlgError as error:
        raise InputError(f"{error} near the reference") from error
    slopes, errors = _slopes(item, lambda at: np.array([item.energy(at)[0]]), moving, 1)
    momentum = _momentum(item, moving)[None]
    _require_same(item, f"kinetic energy of {item.name}", "v", momentum, slopes[:, : len(item.dofs)], errors)


def require_energies(item: Connector) -> None:
    """Raise InputError if a conservative connector has a force that is not that of its energies."""
    if not item.item.conservative:
        return
    moving, resting, number = somewhere_near(item), resting_near(item), len(item.dofs)
    scaled = item.tangent(resting, TIMES[0], gravity_of(item), _BY_Q) * np.multiply.outer(
        scales_of(item), scales_of(item)
    )
    uneven = np.abs(scaled - scaled.T)
    for columns in (slice(number), slice(number, None)):  # multipliers have units of their own
        if uneven[:, columns].max(initial=0.0) > AGREE * np.abs(scaled[:, columns]).max(initial=0.0):
            raise InputError(
                f"{item.name} says that it is conservative, but its stiffness is not symmetric: its force is not the "
                "derivative of a potential"
            )
    resting[0][item.own] = 0.0
    force = item.force(item.at(resting, TIMES[0], gravity_of(item))).real[:number]
    slope = _slopes(item, lambda at: np.array([item.energy(at)[1]]), resting, 0)[0][0, :number]
    if not _same(item, force, slope):
        raise InputError(
            f"{item.name} says that it is conservative, but the potential of its energy() is not that of its force: "
            f"the force is {force}, the derivative of the potential, the second number of energy(), {slope}"
        )
    mass = item.tangent(moving, TIMES[0], gravity_of(item), (0.0, 0.0, 1.0))[:number, :number]
    inertia, momentum = mass @ moving[1][item.dofs], _momentum(item, moving) - _momentum(item, resting)
    if not _same(item, inertia, momentum):
        raise InputError(
            f"{item.name} says that it is conservative, but the kinetic energy of its energy() is not that of its "
            f"force: the momentum by the force is {inertia}, the derivative of the kinetic energy {momentum}"
        )


def require_no_rotations(item: Connector) -> None:
    """Raise InputError if a connector that has no rotations depends on them or has moments."""
    if item.per_point == 3:
        return
    at = item.at(somewhere_near(item), TIMES[0], gravity_of(item))
    turn = np.random.default_rng(13).standard_normal((3, *at.q.shape)) * (0.0, 0.0, 1.0)
    turned = replace(at, q=at.q + turn[0], v=at.v + turn[1], a=at.a + turn[2])
    for name, values in (("force", item.force), ("energy", item.energy)):
        if not np.array_equal(values(at), values(turned), equal_nan=True):
            raise InputError(
                f"{item.name} has rotations = False, but its {name} depends on the rotations of its points; leave out "
                "rotations = False"
            )


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


def scales_of(item: Connector) -> np.ndarray:
    """Return the natural unit (d + k,) of each coordinate and multiplier."""
    return np.concatenate([item.units, np.ones(len(item.own))])


def _same(item: Connector, one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether forces or momenta (d,) agree, each by its work."""
    one, other = one * item.units, other * item.units
    return bool(np.all(np.abs(one - other) <= AGREE * np.maximum(np.abs(one).max(), np.abs(other).max())))


def _require_same(
    item: Connector, name: str, of: str, exact: np.ndarray, slopes: np.ndarray, errors: np.ndarray
) -> None:
    """Raise InputError if derivatives (r, d + k) differ; the rows are forces and conditions, or an energy.

    errors (r,): see `_slopes`.
    """
    number, scale = len(item.dofs), scales_of(item)[: exact.shape[1]]
    rows = scales_of(item) if len(exact) > 1 else np.ones(1)
    errors = errors * rows
    exact, slopes = exact * np.multiply.outer(rows, scale), slopes * np.multiply.outer(rows, scale)
    for own in (slice(number), slice(number, None)):  # conditions and multipliers have units of their own
        for columns in (slice(number), slice(number, None)):
            apart, size = (np.abs(values[own, columns]).max(initial=0.0) for values in (exact - slopes, slopes))
            if not apart <= AGREE * size + errors[own].max(initial=0.0):
                raise InputError(
                    f"{name} is no analytic function of {of}: its derivative by complex steps is not that of "
                    "differences. Write lengths as np.sqrt(x**2 + y**2), not abs, np.hypot or np.linalg.norm, and keep "
                    "complex numbers complex: no float()"
                )


def _by_rates(item: Connector, motion: Motion) -> np.ndarray:
    """Return the derivative (d + k, d + k) of the force of `Connector.alone` by the velocities in a motion of it."""
    return item.alone.tangent(motion, TIMES[0], gravity_of(item), (0.0, 1.0, 0.0))


def _momentum(item: Connector, motion: Motion) -> np.ndarray:
    """Return the derivative (d,) of the kinetic energy by the velocities, by complex steps."""
    return np.array([_kinetic_rate(item, motion, dof) for dof in item.dofs.tolist()])


def _kinetic_rate(item: Connector, motion: Motion, dof: int) -> float:
    moved = motion[1].astype(complex)
    moved[dof] += 1j * COMPLEX_STEP
    try:
        kinetic = item.energy(item.at((motion[0], moved, motion[2]), TIMES[0], gravity_of(item)))[0]
    except InputError:  # such as float() of a complex number
        return np.nan
    return float(np.imag(kinetic)) / COMPLEX_STEP


def _slopes(
    item: Connector, values: Callable[..., np.ndarray], motion: Motion, kind: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivative (r, d + k) of `values` with respect to p, p' or p'' (kind 0, 1 or 2), and errors (r,).

    It is a central difference. The errors are those that the round-off of all terms of a value leaves per natural unit
    of a coordinate.
    """
    columns, largest = [], np.zeros(1)
    widths = exact_steps(motion[kind][item.all], WIDTH * scales_of(item))
    for dof, unit, width in zip(item.all.tolist(), scales_of(item).tolist(), widths.tolist(), strict=True):
        ends = []
        for side in (1.0, -1.0):
            moved = (motion[0].copy(), motion[1].copy(), motion[2].copy())
            moved[kind][dof] += side * width
            ends.append(np.real(values(item.at(moved, TIMES[0], gravity_of(item)))))
        slope = (ends[0] - ends[1]) / (2.0 * width)
        columns.append(slope)
        largest = np.maximum(largest, np.maximum(np.abs(ends[0]), unit * np.abs(slope)))
    return np.array(columns).T, ROUND_OFF / WIDTH * largest


def exact_steps(values: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Return steps (n,) close to given ones that can be added to values (n,) without round-off.

    Coordinates far from the origin, as of maps, would otherwise not move by the step by which a change is divided.
    """
    return (values + np.copysign(np.maximum(np.abs(steps), np.spacing(np.abs(values))), steps)) - values
