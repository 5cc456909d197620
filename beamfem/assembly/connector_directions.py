"""The checks of connectors in single directions, for parts of a class of which one has passed those by coordinates.

Each of them has its own parameters and place, and is therefore checked, but at a sixth of the calls.
"""

from collections.abc import Callable

import numpy as np

from beamfem.assembly.connector import COMPLEX_STEP, Connector, Motion
from beamfem.assembly.connector_checks import (
    AGREE,
    ROUND_OFF,
    TIMES,
    WIDTH,
    exact_steps,
    gravity_of,
    resting_near,
    scales_of,
    somewhere_near,
)
from beamfem.errors import InputError

_Values = Callable[..., np.ndarray]


def passes(item: Connector) -> bool:
    """Return whether a connector passes in arbitrary directions; if not, `connector_checks` says what is wrong."""
    try:
        return _analytic(item) and (not item.item.conservative or _conservative(item))
    except InputError:
        return False


def _analytic(item: Connector) -> bool:
    """Return whether derivatives by complex steps are those of differences."""
    moving, number = somewhere_near(item), len(item.dofs)
    coordinates, multipliers = _directions(item)
    agree = _tolerance(item)
    directions = [(0, coordinates), (1, coordinates), (2, coordinates)] + ([(0, multipliers)] if len(item.own) else [])
    for kind, direction in directions:
        exact = _by_complex_step(item, item.force, moving, kind, direction)
        slope, errors = _by_difference(item, item.force, moving, kind, direction)
        for rows in (slice(number), slice(number, None)):
            scale = scales_of(item)[rows]
            apart, size = (np.abs(values[rows] * scale).max(initial=0.0) for values in (exact - slope, slope))
            if not apart <= agree * size + (errors[rows] * scale).max(initial=0.0):
                return False
    if not np.isfinite(_by_complex_step(item, item.force, resting_near(item), 0, coordinates)).all():
        return False
    exact = _by_complex_step(item, _kinetic(item), moving, 1, coordinates)
    slope, errors = _by_difference(item, _kinetic(item), moving, 1, coordinates)
    return bool(np.abs(exact - slope)[0] <= agree * np.abs(slope[0]) + errors[0])


def _conservative(item: Connector) -> bool:
    """Return whether the stiffness is symmetric, and the energies are those of the force."""
    moving, resting, number = somewhere_near(item), resting_near(item), len(item.dofs)
    one, multipliers = _directions(item)
    other, others = (_in_other_ratios(direction) for direction in (one, multipliers))
    agree = _tolerance(item)
    pairs = [(one, other), (multipliers, one), (multipliers, others)] if len(item.own) else [(one, other)]
    for first, second in pairs:
        by_first, by_second = (_by_complex_step(item, item.force, resting, 0, each) for each in (first, second))
        # multipliers have units of their own
        rows = slice(number) if second is not others else slice(None)
        size = np.abs(by_first * scales_of(item))[rows].max(initial=0.0)
        if not abs(second @ by_first - first @ by_second) <= agree * size:
            return False
    resting[0][item.own] = 0.0
    force = item.force(item.at(resting, TIMES[0], gravity_of(item))).real[:number]
    slope, _ = _by_difference(item, _potential(item), resting, 0, one)
    if not abs(force @ one[:number] - slope[0]) <= agree * np.abs(force * item.units).max():
        return False
    speed = np.append(moving[1][:number], np.zeros(len(item.own)))
    inertia = _by_complex_step(item, item.force, moving, 2, speed)[:number]
    momenta = [_by_complex_step(item, _kinetic(item), motion, 1, one)[0] for motion in (moving, resting)]
    apart = inertia @ one[:number] - (momenta[0] - momenta[1])
    return bool(abs(apart) <= agree * np.abs(inertia * item.units).max())


def _tolerance(item: Connector) -> float:
    """Return the relative error that is allowed: what is right may fail here, since it is then checked by coordinates.

    An error in one coordinate must show among the sums over all n. They are up to n times as large as their terms, and
    of an unsymmetric stiffness they show 1 / (2 n) at least.
    """
    return AGREE / (2.0 * len(item.all) ** 2)


def _directions(item: Connector) -> tuple[np.ndarray, np.ndarray]:
    """Return a change (d + k,) of all coordinates and one of all multipliers, each of about its natural unit."""
    rng, number = np.random.default_rng(11), len(item.dofs)
    changes = rng.choice([-1.0, 1.0], len(item.all)) * rng.uniform(0.5, 1.0, len(item.all)) * scales_of(item)
    changes = exact_steps(somewhere_near(item)[0][: len(changes)], WIDTH * changes) / WIDTH
    own = np.arange(len(changes)) >= number
    return np.where(own, 0.0, changes), np.where(own, changes, 0.0)


def _in_other_ratios(direction: np.ndarray) -> np.ndarray:
    """Return a direction in which no two changes have the ratio that they have in a given one."""
    changed = np.flatnonzero(direction)
    result = np.zeros_like(direction)
    result[changed] = direction[changed] * np.linspace(-1.0, 1.0, len(changed))
    return result


def _kinetic(item: Connector) -> _Values:
    return lambda at: np.array([item.energy(at)[0]])


def _potential(item: Connector) -> _Values:
    return lambda at: np.array([item.energy(at)[1]])


def _by_complex_step(item: Connector, values: _Values, motion: Motion, kind: int, direction: np.ndarray) -> np.ndarray:
    moved = [each.astype(complex) if number == kind else each for number, each in enumerate(motion)]
    moved[kind][: len(direction)] += 1j * COMPLEX_STEP * direction
    found = values(item.at((moved[0], moved[1], moved[2]), TIMES[0], gravity_of(item)))
    return np.asarray(np.imag(found)) / COMPLEX_STEP


def _by_difference(
    item: Connector, values: _Values, motion: Motion, kind: int, direction: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivative of values along a direction, and what the round-off of their terms leaves in it."""
    ends = []
    for side in (1.0, -1.0):
        moved = [each.copy() for each in motion]
        moved[kind][: len(direction)] += side * WIDTH * direction
        ends.append(np.real(values(item.at((moved[0], moved[1], moved[2]), TIMES[0], gravity_of(item)))))
    change = ends[0] - ends[1]
    largest = np.maximum(np.abs(ends[0]), np.abs(change) / (2.0 * WIDTH))
    return change / (2.0 * WIDTH), ROUND_OFF / WIDTH * largest
