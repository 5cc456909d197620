"""Check of a connector: analytic, with energies that match its forces, and constraint forces that do no work."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.connectors import (
    AGREE,
    COMPLEX_STEP,
    ROUND_OFF,
    TIMES,
    WIDTH,
    Connector,
    Motion,
    connectors_of,
    gravity_of,
    resting_near,
    somewhere_near,
)
from beamfem.errors import InputError
from beamfem.model.contribution import Contribution, require_connector
from beamfem.model.model import Model
from beamfem.testing.constraint_forces import check_constraint_forces

_BY_Q = (1.0, 0.0, 0.0)


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
