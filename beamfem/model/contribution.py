"""User-defined forces between points of beams, as functions of the state of motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, cast, runtime_checkable

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point, require_point
from beamfem.model.supports import Value
from beamfem.physics.connections import Connection
from beamfem.reprs import brief
from beamfem.validation import count, finite, flag, fulfils, items, shown


@dataclass(frozen=True, eq=False)
class At:
    """The state at which a contribution is evaluated.

    Parameters
    ----------
    q : array, (m, 3)
        x, y [m] and rotation from the reference [rad] of its points. Rotations are zero here and in `v` and `a` if the
        contribution has `rotations = False`.
    v : array, (m, 3)
        Velocities [m/s] and angular velocities [rad/s] of its points, zero in statics.
    a : array, (m, 3)
        Accelerations [m/s^2] and angular accelerations [rad/s^2] of its points, zero in statics.
    own : array, (k,)
        Multipliers.
    memory : array, (h,)
        History variables after the last accepted step.
    reference : array, (m, 3)
        q in the stress-free reference.
    time : float, [s]
        Time, in statics the load factor.
    gravity : array, [m/s^2], (2,)
        Acceleration of the model's Gravity at that time.
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    own: np.ndarray
    memory: np.ndarray
    reference: np.ndarray
    time: float
    gravity: np.ndarray

    __repr__ = brief


@runtime_checkable
class Contribution(Protocol):
    """User-defined forces between points of beams: a frozen dataclass with these members, given to
    `Model(connectors=[...])`.

    Tangents are complex-step derivatives of `force`, exact to round-off, so it must consist of analytic functions:
    `x**2` and `np.sqrt`, not `abs`, `np.hypot` or `np.linalg.norm`. `beamfem.testing.check_connector` tests this. Cases
    such as contact are distinguished by real parts, `np.where(gap.real < 0.0, ...)`.

    A class attribute or field `rotations = False` is optional. The force then must not depend on rotations, and its
    moments must be zero. Otherwise each point has an angle as a coordinate, which keeps the thickness of elements with
    gradients constant there.

    With `one_sided = True`, likewise optional, conditions are g <= 0, with multipliers l >= 0 and l g = 0 (Karush, Kuhn
    and Tucker): -g is a gap, and the multiplier the force that keeps it from closing further. In statics only.
    """

    @property
    def points(self) -> tuple[Point, ...]:
        """Points (m,) of beams on which the forces act."""

    @property
    def unknowns(self) -> int:
        """Number k of multipliers, 0 for forces without conditions."""

    @property
    def conservative(self) -> bool:
        """Whether the force at rest has a potential, so that the stiffness is symmetric."""

    def force(self, at: At) -> np.ndarray:
        """Return fx, fy [N] and moment [N m] that resist at each point, then the conditions (3 m + k,).

        Forces have the sign of internal forces: a spring that pulls a point back to the left has a positive fx. A
        condition is a function of q that is zero when it is satisfied; its multiplier times its derivative by q is part
        of the forces.
        """

    def energy(self, at: At) -> tuple[float, float]:
        """Return the kinetic and the potential energy [J]."""


@runtime_checkable
class Remembering(Contribution, Protocol):
    """A contribution with history, such as friction.

    History variables are part of the state: a rejected step restores them, and each row of a result contains them.
    """

    @property
    def memory(self) -> Sequence[float]:
        """Initial history variables (h,)."""

    def remember(self, at: At) -> Sequence[float]:
        """Return the history variables (h,) after an accepted step, from the state at its end."""


def require_connector(connector: Contribution) -> None:
    """Raise InputError if points, unknowns, conservative or rotations of a connector are invalid."""
    name = type(connector).__name__
    if isinstance(connector, type) or not (hasattr(connector, "points") and hasattr(connector, "force")):
        raise InputError(f"a connector is an object with the members of Contribution, got {shown(connector)}")
    flag(f"rotations of {name}", uses_rotations(connector))
    flag(f"one_sided of {name}", is_one_sided(connector))
    points = items(f"points of {name}", connector.points)
    if not points:
        raise InputError(f"{name} has no points: it needs one point of a beam at least")
    for point in points:
        require_point(name, point, "points")
    if len({(id(point.beam), point.fraction) for point in points}) < len(points):
        raise InputError(f"{name} lists a point twice")
    if connector.unknowns:
        count(f"unknowns of {name}", connector.unknowns)
    if hasattr(connector, "memory") and not isinstance(connector, Remembering):
        raise InputError(f"{name} defines memory but no remember(at) to update it after each step")
    remembered(connector)
    flag(f"conservative of {name}", connector.conservative)


def uses_rotations(connector: Contribution) -> bool:
    """Return whether a connector depends on rotations of its points, which then have an angle as a coordinate."""
    return getattr(connector, "rotations", True)


def is_one_sided(connector: Contribution) -> bool:
    """Return whether the conditions of a connector come and go: they are g <= 0."""
    return getattr(connector, "one_sided", False)


def amplitudes_of(connector: Contribution) -> int:
    """Return the number of coordinates that a connector has besides those of its points, none if it is user-defined."""
    definition = getattr(connector, "connection", None)
    return definition.amplitudes if isinstance(definition, Connection) else 0


def prescribed_by(connector: Contribution) -> tuple[Value, ...]:
    """Return the values that a connector prescribes for its conditions, none if it is user-defined."""
    return getattr(connector, "prescribed", ())


def remembered(connector: Contribution) -> np.ndarray:
    """Return the initial history variables of a connector (h,). Raises InputError."""
    if not fulfils(connector, Remembering):
        return np.empty(0)
    name = f"memory of {type(connector).__name__}"
    memory = items(name, cast(Remembering, connector).memory)
    return np.array([finite(name, value) for value in memory], dtype=float)
