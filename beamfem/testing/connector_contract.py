"""Check of a connector: analytic, with energies that match its forces, and constraint forces that do no work."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.bound_connector import COMPLEX_STEP, Connector, Motion
from beamfem.equations.connector_traits import AGREE, ROUND_OFF, TIMES, WIDTH, gravity_of, resting_near, somewhere_near
from beamfem.equations.connectors import connectors_of
from beamfem.errors import InputError
from beamfem.model.contribution import Contribution, remembered, require_connector
from beamfem.model.model import Model

_FAR = 1e-2  # distance from the reference, relative to the length, and rotation [rad]
_MET, _TRIES = 1e-10, 30  # of the iteration onto the conditions
_ACTS = 1e-6  # part of the largest force from which on a coordinate counts
_COMBINED = 1e-4
_NEGLIGIBLE = 1e-9  # of forces that depend on nothing else; coefficients of friction may be small
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
            if size <= _COMBINED and opposed < 0:
                return
            if size <= _COMBINED:
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
    opposed = np.flatnonzero((np.diag(coefficients) <= _NEGLIGIBLE) & forces.any(axis=0))
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
            if any(np.abs(each - nominal).max() > _NEGLIGIBLE * np.abs(nominal).max() for each in tangents):
                return True
    return False


def _reversed(item: Connector, motion: Motion) -> Motion:
    """Return the motion with multipliers of the other sign."""
    p = motion[0].copy()
    p[item.own] *= -1.0
    return p, motion[1], motion[2]


def check_connector(connector: Contribution) -> None:
    """Check that a user-defined connector is consistent, at arbitrary states near its reference.

    Its force and kinetic energy are analytic: derivatives by complex steps are those by differences. If it is
    conservative, its stiffness is symmetric, its force is the derivative of the potential energy by q, and the momentum
    of the kinetic energy belongs to the inertia forces. Forces of multipliers do no work in the motions that their
    conditions allow. With ``rotations = False`` it does not depend on rotations.

    Coordinates are measured in the size of the beams and in rad, and forces by their work, so units do not matter.

    Parameters
    ----------
    connector : Contribution
        Connector on points of any beams.

    Raises
    ------
    AssertionError
        If the connector is inconsistent; the message names what is wrong.
    InputError
        If it returns arrays of another shape or numbers that are not finite.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from beamfem.testing import check_connector
    >>> @dataclass(frozen=True)
    ... class Wire:
    ...     point: bf.Point
    ...     stiffness: float  # [N/m]
    ...     unknowns = 0
    ...     conservative = True
    ...     points = property(lambda self: (self.point,))
    ...     def force(self, at):
    ...         return self.stiffness * (at.q - at.reference).ravel() * [1.0, 1.0, 0.0]
    ...     def energy(self, at):
    ...         moved = (at.q - at.reference)[0, :2]
    ...         return 0.0, self.stiffness * moved @ moved
    >>> try:
    ...     check_connector(Wire(beam.end, 5.0))
    ... except AssertionError as error:
    ...     print(str(error).partition(":")[0])
    Wire is conservative, but the potential of its energy() is not that of its force
    """
    require_connector(connector)
    beams = list(dict.fromkeys(point.beam for point in connector.points))
    (item,) = connectors_of(Model(beams, connectors=[connector]), static=True).items
    item = item.alone
    _check_rotations(item)
    _check_analytic(item)
    check_constraint_forces(item)
    _check_energies(item)


def _check_analytic(item: Connector) -> None:
    moving = somewhere_near(item)
    try:
        for kind in range(3):
            exact = item.tangent(moving, TIMES[0], gravity_of(item), [float(kind == number) for number in range(3)])
            _require_same(item, f"force of {item.name}", "qva"[kind], exact, *_slopes(item, item.force, moving, kind))
        item.tangent(resting_near(item), TIMES[0], gravity_of(item), _BY_Q)
    except LinAlgError as error:
        raise AssertionError(f"{error} near the reference") from error
    slopes, errors = _slopes(item, lambda at: np.array([item.energy(at)[0]]), moving, 1)
    momentum = _momentum(item, moving)[None]
    _require_same(item, f"kinetic energy of {item.name}", "v", momentum, slopes[:, : len(item.dofs)], errors)


def _check_energies(item: Connector) -> None:
    if not item.item.conservative:
        return
    moving, resting, number = somewhere_near(item), resting_near(item), len(item.dofs)
    scaled = item.tangent(resting, TIMES[0], gravity_of(item), _BY_Q) * np.multiply.outer(
        _scales_of(item), _scales_of(item)
    )
    uneven = np.abs(scaled - scaled.T)
    for columns in (slice(number), slice(number, None)):  # multipliers have units of their own
        if uneven[:, columns].max(initial=0.0) > AGREE * np.abs(scaled[:, columns]).max(initial=0.0):
            raise AssertionError(
                f"{item.name} is conservative, but its stiffness is not symmetric: its force is not the "
                "derivative of a potential"
            )
    resting[0][item.own] = 0.0
    force = item.force(item.at(resting, TIMES[0], gravity_of(item))).real[:number]
    slope = _slopes(item, lambda at: np.array([item.energy(at)[1]]), resting, 0)[0][0, :number]
    if not _same(item, force, slope):
        raise AssertionError(
            f"{item.name} is conservative, but the potential of its energy() is not that of its force: "
            f"the force is {force}, the derivative of the potential, the second number of energy(), {slope}"
        )
    mass = item.tangent(moving, TIMES[0], gravity_of(item), (0.0, 0.0, 1.0))[:number, :number]
    inertia, momentum = mass @ moving[1][item.dofs], _momentum(item, moving) - _momentum(item, resting)
    if not _same(item, inertia, momentum):
        raise AssertionError(
            f"{item.name} is conservative, but the kinetic energy of its energy() is not that of its "
            f"force: the momentum by the force is {inertia}, the derivative of the kinetic energy {momentum}"
        )


def _check_rotations(item: Connector) -> None:
    if item.per_point == 3:
        return
    at = item.at(somewhere_near(item), TIMES[0], gravity_of(item))
    turn = np.random.default_rng(13).standard_normal((3, *at.q.shape)) * (0.0, 0.0, 1.0)
    turned = replace(at, q=at.q + turn[0], v=at.v + turn[1], a=at.a + turn[2])
    for name, values in (("force", item.force), ("energy", item.energy)):
        if not np.array_equal(values(at), values(turned), equal_nan=True):
            raise AssertionError(
                f"{item.name} has rotations = False, but its {name} depends on the rotations of its points; leave out "
                "rotations = False"
            )


def _scales_of(item: Connector) -> np.ndarray:
    """Return the natural unit (d + k,) of each coordinate and multiplier."""
    return np.concatenate([item.units, np.ones(len(item.own))])


def _same(item: Connector, one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether forces or momenta (d,) agree, each by its work."""
    one, other = one * item.units, other * item.units
    return bool(np.all(np.abs(one - other) <= AGREE * np.maximum(np.abs(one).max(), np.abs(other).max())))


def _require_same(
    item: Connector, name: str, of: str, exact: np.ndarray, slopes: np.ndarray, errors: np.ndarray
) -> None:
    """Compare derivatives (r, d + k); the rows are forces and conditions, or an energy. errors (r,): see `_slopes`."""
    number, scale = len(item.dofs), _scales_of(item)[: exact.shape[1]]
    rows = _scales_of(item) if len(exact) > 1 else np.ones(1)
    errors = errors * rows
    exact, slopes = exact * np.multiply.outer(rows, scale), slopes * np.multiply.outer(rows, scale)
    for own in (slice(number), slice(number, None)):  # conditions and multipliers have units of their own
        for columns in (slice(number), slice(number, None)):
            apart, size = (np.abs(values[own, columns]).max(initial=0.0) for values in (exact - slopes, slopes))
            if not apart <= AGREE * size + errors[own].max(initial=0.0):
                raise AssertionError(
                    f"{name} is no analytic function of {of}: its derivative by complex steps is not that of "
                    "differences. Write lengths as np.sqrt(x**2 + y**2), not abs, np.hypot or np.linalg.norm, and keep "
                    "complex numbers complex: no float()"
                )


def _momentum(item: Connector, motion: Motion) -> np.ndarray:
    """Return the derivative (d,) of the kinetic energy by the velocities, by complex steps."""
    result = np.full(len(item.dofs), np.nan)
    for number, dof in enumerate(item.dofs.tolist()):
        moved = motion[1].astype(complex)
        moved[dof] += 1j * COMPLEX_STEP
        with suppress(InputError):  # such as float() of a complex number
            kinetic = item.energy(item.at((motion[0], moved, motion[2]), TIMES[0], gravity_of(item)))[0]
            result[number] = float(np.imag(kinetic)) / COMPLEX_STEP
    return result


def _slopes(
    item: Connector, values: Callable[..., np.ndarray], motion: Motion, kind: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivative (r, d + k) of `values` with respect to p, p' or p'' (kind 0, 1 or 2), and errors (r,).

    It is a central difference. The errors are those that the round-off of all terms of a value leaves per natural unit
    of a coordinate.
    """
    columns, largest = [], np.zeros(1)
    widths = _exact_steps(motion[kind][item.all], WIDTH * _scales_of(item))
    for dof, unit, width in zip(item.all.tolist(), _scales_of(item).tolist(), widths.tolist(), strict=True):
        ends = []
        for side in (1.0, -1.0):
            moved = (motion[0].copy(), motion[1].copy(), motion[2].copy())
            moved[kind][dof] += side * width
            ends.append(np.real(values(item.at(moved, TIMES[0], gravity_of(item)))))
        slope = (ends[0] - ends[1]) / (2.0 * width)
        columns.append(slope)
        largest = np.maximum(largest, np.maximum(np.abs(ends[0]), unit * np.abs(slope)))
    return np.array(columns).T, ROUND_OFF / WIDTH * largest


def _exact_steps(values: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Return steps (n,) close to given ones that can be added to values (n,) without round-off.

    Coordinates far from the origin, as of maps, would otherwise not move by the step by which a change is divided.
    """
    return (values + np.copysign(np.maximum(np.abs(steps), np.spacing(np.abs(values))), steps)) - values
