"""Check that constraint forces of a connector do no work in the motions that its conditions allow."""

from collections.abc import Iterator

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.connectors import Connector, Motion
from beamfem.errors import InputError
from beamfem.model.contribution import remembered

_FAR = 1e-2  # distance from the reference, relative to the length, and rotation [rad]
_MET, _TRIES = 1e-10, 30  # of the iteration onto the conditions
_ACTS = 1e-6  # part of the largest force from which on a coordinate counts
_AGREE = 1e-4
_ROUND_OFF = 1e-9  # of forces that depend on nothing else; coefficients of friction may be small
_SPEEDS = (1.0, -1.0, 1e-6, -1e-6, 1e3, -1e3)  # beam lengths and rad per s, at which a friction would turn over
_PASTS = (1.0, -1.0, 1e-3, -1e-3, 1e6, -1e6)  # added to history variables
_TIME, _GRAVITY = 0.5, np.zeros(2)  # arbitrary
_BY_Q, _BY_V = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def check_constraint_forces(item: Connector) -> None:
    """Raise AssertionError if the forces of multipliers are nowhere combinations of the derivatives of the conditions.

    Friction that grows with a multiplier has forces besides: it takes its direction from velocities or from the past,
    or vanishes where nothing has slid, and passes. So do forces that are right only where the conditions are met, and
    multipliers in another unit, but not of the other sign: stability is counted by signs. A condition that contains its
    multiplier, such as that of an open contact, tells nothing.
    """
    least, least_row, wrong = np.inf, 0, -1
    for motion in _on_the_conditions(item) if len(item.own) else ():
        pairs = [pair for pair in (_derivatives(item, motion), _derivatives(item, _reversed(item, motion))) if pair]
        if len(pairs) == 2:  # a friction that grows with |lambda| has a slope of either sign
            pairs.append((0.5 * (pairs[0][0] + pairs[1][0]), pairs[0][1]))
        for forces, conditions in pairs:
            size, row, opposed = _besides(item, forces, conditions)
            if size <= _AGREE and opposed < 0:
                return
            if size <= _AGREE:
                wrong = opposed
            if size < least:
                least, least_row = size, row
    if wrong >= 0:
        raise AssertionError(
            f"force of {item.name}: multiplier {wrong} does not act along the derivative of its condition by q; the "
            "force must contain each multiplier times the derivative of its own condition, with this sign"
        )
    if least == np.inf or _depends_on_sliding(item):
        return
    point, direction = divmod(least_row, item.per_point)
    raise AssertionError(
        f"force of {item.name}: the forces of its multipliers do work in motions that its conditions allow; "
        f"{('fx', 'fy', 'the moment')[direction]} at points[{point}] is not the multipliers times the derivatives of "
        "the conditions by q there. A friction that grows with a multiplier takes its direction from at.v or at.memory"
    )


def _on_the_conditions(item: Connector) -> Iterator[Motion]:
    """Yield states at rest that meet the conditions: one near the reference, others further away.

    Those are where arms that are wrong show; near the reference nothing has slid.
    """
    rng, units = np.random.default_rng(5), item.units
    for far in (0.0, _FAR, _FAR):
        moved, multipliers = far * units * rng.standard_normal(len(item.dofs)), rng.standard_normal(len(item.own))
        for side in (1.0, -1.0):  # a contact may be open for one of them
            p, zeros = np.zeros(item.variables), np.zeros(item.variables)
            p[item.dofs], p[item.own] = item.undeformed + moved, side * multipliers
            p[item.memory] = remembered(item.item)
            if _meets(item, (p, zeros, zeros)):
                yield p, zeros, zeros
                break


def _meets(item: Connector, motion: Motion) -> bool:
    """Move a state onto the conditions, in place, by Gauss-Newton steps; return whether it arrives."""
    number, units = len(item.dofs), item.units
    for _ in range(_TRIES):
        try:
            slope = item.tangent(motion, _TIME, _GRAVITY, _BY_Q)[number:, :number] * units
            missed = item.force(item.at(motion, _TIME, _GRAVITY)).real[number:]
            change = np.linalg.lstsq(slope, missed, rcond=1e-9)[0]
        except (InputError, LinAlgError):
            return False
        if np.all(np.abs(missed) <= _MET * np.abs(slope).max(axis=1)):
            return True
        motion[0][item.dofs] -= units * change
    return False


def _derivatives(item: Connector, motion: Motion) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the derivatives (d, k) of the forces by the multipliers, and (d, k) of the conditions by q.

    None if the conditions depend on multipliers or velocities there.
    """
    number = len(item.dofs)
    try:
        tangent, resisted = (item.tangent(motion, _TIME, _GRAVITY, weights) for weights in (_BY_Q, _BY_V))
    except (InputError, LinAlgError):
        return None
    if tangent[number:, number:].any() or resisted[number:].any():
        return None
    return tangent[:number, number:], tangent[number:, :number].T


def _besides(item: Connector, forces: np.ndarray, conditions: np.ndarray) -> tuple[float, int, int]:
    """Return the largest force that is no combination of the conditions, relative to all at its place, and its place.

    Third, a multiplier whose part of its own condition is not positive, -1 if there is none. Every coordinate is scaled
    to 1, so that short arms count as much as long ones.
    """
    works = (item.units[:, None] * table for table in (forces, conditions))  # moments and forces become comparable
    forces, conditions = (table / np.maximum(np.abs(table).max(axis=0), np.finfo(float).tiny) for table in works)
    sizes = np.maximum(np.abs(forces), np.abs(conditions)).max(axis=1, keepdims=True)
    forces, conditions = (table / np.maximum(sizes, _ACTS) for table in (forces, conditions))
    coefficients = np.linalg.lstsq(conditions, forces, rcond=1e-9)[0]
    residual = np.abs(forces - conditions @ coefficients).max(axis=1)
    opposed = np.flatnonzero((np.diag(coefficients) <= _ROUND_OFF) & forces.any(axis=0))
    return float(residual.max()), int(residual.argmax()), int(opposed[0]) if len(opposed) else -1


def _depends_on_sliding(item: Connector) -> bool:
    """Return whether the forces of the multipliers depend on velocities or on the past, as those of friction do."""
    number, rng = len(item.dofs), np.random.default_rng(7)
    for motion in _on_the_conditions(item):
        p, v, a = motion
        motions: list[Motion] = []
        for speed in _SPEEDS:
            moving = v.copy()
            moving[item.dofs] = speed * item.units * rng.standard_normal(number)
            motions.append((p, moving, a))
        for past in _PASTS if len(item.memory) else ():
            later = p.copy()
            later[item.memory] += past * rng.standard_normal(len(item.memory))
            motions.append((later, v, a))
        for turned in (lambda one: one, lambda one: _reversed(item, one)):
            try:
                nominal, *tangents = (
                    item.tangent(turned(each), _TIME, _GRAVITY, _BY_Q)[:number, number:] for each in (motion, *motions)
                )
            except (InputError, LinAlgError):  # a past that cannot be: it may well be friction
                return True
            if any(np.abs(each - nominal).max() > _ROUND_OFF * np.abs(nominal).max() for each in tangents):
                return True
    return False


def _reversed(item: Connector, motion: Motion) -> Motion:
    """Return the motion with multipliers of the other sign."""
    p = motion[0].copy()
    p[item.own] *= -1.0
    return p, motion[1], motion[2]
