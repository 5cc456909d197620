"""What adds forces to a model by a rule of its own: between points of beams, with a state of motion as its argument."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point, require_point
from beamfem.validation import count, finite, flag, items


@dataclass(frozen=True, eq=False)
class At:
    """Where a contribution is evaluated.

    q (m, 3): x, y [m] and turn from the reference [rad] of its points; v, a (m, 3): their rates and accelerations, zero
    in statics; own (k,): its own unknowns; memory (h,): what it remembers of the steps before; reference (m, 3): q of
    the stress-free model; time: [s], in statics the load factor; gravity (2,): acceleration [m/s^2] of the model's
    Gravity then.
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    own: np.ndarray
    memory: np.ndarray
    reference: np.ndarray
    time: float
    gravity: np.ndarray


@runtime_checkable
class Contribution(Protocol):
    """A frozen dataclass with these members, given to `Model(connectors=[...])`.

    points: where it acts, m points of beams; unknowns: k, how many multipliers it brings along; conservative: whether
    its force at rest is the derivative of a potential, so that its stiffness is symmetric.

    Tangents are the derivatives of `force` by complex steps, exact to round-off, so that it must consist of analytic
    functions: `x**2` and `np.sqrt`, not `abs`, `np.hypot` or `np.linalg.norm`. This is tested when a model is solved.
    Cases such as contact are told apart by real parts, `np.where(gap.real < 0.0, ...)`.
    """

    @property
    def points(self) -> tuple[Point, ...]:
        """Points of beams."""
        ...

    @property
    def unknowns(self) -> int:
        """Number of multipliers."""
        ...

    @property
    def conservative(self) -> bool:
        """Whether the force at rest has a potential."""
        ...

    def force(self, at: At) -> np.ndarray:
        """Return what it resists with (3 m + k,): fx, fy [N] and moment [N m] at each point, then its conditions.

        The sum of these and of all other forces vanishes in equilibrium: a spring that pulls a point back to the left
        has a positive fx. A condition is a function of q that is zero if it is met; its multiplier times its
        derivative belongs to the forces.
        """
        ...

    def energy(self, at: At) -> tuple[float, float]:
        """Return its kinetic energy and its potential [J], of what has one."""
        ...


@runtime_checkable
class Remembering(Contribution, Protocol):
    """A contribution that depends on its past, such as friction.

    What it remembers is part of a state: a step that is taken back takes it back, and a result has it row by row.
    """

    @property
    def memory(self) -> Sequence[float]:
        """The numbers (h,) that it starts with."""
        ...

    def remember(self, at: At) -> Sequence[float]:
        """Return them anew (h,) after each step that is accepted."""
        ...


def require_connector(connector: Contribution) -> None:
    """Raise InputError if points, unknowns or conservative of a connector are not what they should be."""
    name = type(connector).__name__
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
        raise InputError(f"{name} has a memory, but no remember(at) that returns it anew after a step")
    remembered(connector)
    flag(f"conservative of {name}", connector.conservative)


def remembered(connector: Contribution) -> np.ndarray:
    """Return what a connector remembers at the start (h,). Raises InputError."""
    if not isinstance(connector, Remembering):
        return np.empty(0)
    name = f"memory of {type(connector).__name__}"
    return np.array([finite(name, value) for value in items(name, connector.memory)], dtype=float)
