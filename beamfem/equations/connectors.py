"""Connectors in a model: forces, tangents by complex steps, energies and momenta."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import coo_array, csr_array

from beamfem.cached_properties import cached_property
from beamfem.element.fields import r_slots, rule_of
from beamfem.equations.equation_numbering import Mesh
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import jacobians, length_points, reference_vectors, scales
from beamfem.model.beam import Point
from beamfem.model.contribution import (
    At,
    Contribution,
    Remembering,
    amplitudes_of,
    is_one_sided,
    prescribed_by,
    remembered,
    uses_rotations,
)
from beamfem.model.load_base import factor
from beamfem.model.model import Model
from beamfem.parts.at_points import ANALYTIC, AxisRows, OnElements, PartAlongBeam, PartAtPoints, Station
from beamfem.physics.compiled_connections import passes_of
from beamfem.physics.connections import TURNING, Connection
from beamfem.physics.stations import GENERATED
from beamfem.validation import called, finite, items, of_package

COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted

Motion = tuple[np.ndarray, np.ndarray, np.ndarray]  # p, p', p'' (n,)


class Row(NamedTuple):
    """Numbers (u,) of coordinates and multipliers, and data (k,)."""

    numbers: np.ndarray
    data: np.ndarray


@dataclass(frozen=True, eq=False)
class Connector:
    """A contribution and the numbers of the coordinates that it acts on.

    dofs (d,): x, y and rotation of each of m points, x and y alone if it has no rotations, and then amplitudes, three
    in each further row of q; own (k,): its multipliers, and then the values that are prescribed for its conditions;
    memory (h,): its history variables; reference (m, 3): q in the reference; given: the part of the model that it
    belongs to, another one than `item` where a part along a beam acts at its nodes.
    """

    item: Contribution
    dofs: np.ndarray
    own: np.ndarray
    memory: np.ndarray
    reference: np.ndarray
    given: Contribution

    @cached_property
    def all(self) -> np.ndarray:
        """Numbers (d + k,) of all coordinates that the force belongs to."""
        return np.concatenate([self.dofs, self.own])

    @property
    def multipliers(self) -> np.ndarray:
        """Numbers of its multipliers."""
        return self.own[: self.item.unknowns]

    @property
    def amplitudes(self) -> np.ndarray:
        """Numbers of the amplitudes, the last ones of its coordinates."""
        return self.dofs[len(self.dofs) - amplitudes_of(self.item) :]

    @property
    def values(self) -> np.ndarray:
        """Numbers of the prescribed values of its conditions."""
        return self.own[self.item.unknowns :]

    def values_in(self, p: np.ndarray) -> np.ndarray:
        """Return the values with which a state p (n,) satisfies their conditions."""
        if not len(self.values):
            return _NOTHING
        zeros, first = np.zeros(len(p)), len(self.dofs)
        gaps = self.force_in((p, zeros, zeros), 0.0, np.zeros(2))[first : first + len(self.values)]
        return np.asarray(p[self.values] + gaps)

    @cached_property
    def alone(self) -> "Connector":
        """The same contribution with coordinates, multipliers and history variables numbered from 0, in this order."""
        dofs, own, memory = np.split(np.arange(self.variables), np.cumsum([len(self.dofs), len(self.own)]))
        return Connector(self.item, dofs, own, memory, self.reference, self.given)

    @property
    def variables(self) -> int:
        """Number of coordinates, multipliers and history variables."""
        return len(self._used)

    @cached_property
    def _used(self) -> np.ndarray:
        return np.concatenate([self.dofs, self.own, self.memory])

    @property
    def name(self) -> str:
        return type(self.given).__name__

    @cached_property
    def compiled(self) -> Connection | None:
        """The definition by which compiled code evaluates it, None for a user-defined contribution."""
        return self.item.connection if isinstance(self.item, PartAtPoints) else None

    @property
    def definition(self) -> Connection | None:
        """The definition of what compiled code evaluates, None for a user-defined contribution."""
        return self.item.connection if isinstance(self.item, OnElements) else self.compiled

    @property
    def position_step(self) -> int:
        """See `kernels.record.Parts`."""
        return self.item.position_step if isinstance(self.item, OnElements) else 0

    @cached_property
    def rows(self) -> Sequence["Row"]:
        """What compiled code evaluates: itself, or one of several."""
        if isinstance(self.item, OnElements):
            elements = zip(self.item.coordinates, self.item.data_of(self.reference), strict=True)
            return [Row(self.all[own], data) for own, data in elements]
        return [Row(self.all, self.data if self.compiled is not None else _NOTHING)]

    @property
    def coupled(self) -> list[np.ndarray]:
        """Numbers (u,) that each row couples; a rotation is in place of x and y of its point too where they are not."""
        if self.compiled in TURNING:
            return [np.append(np.repeat(self.dofs[2::3], 3), self.own)]
        return [row.numbers for row in self.rows]

    @property
    def dissipated(self) -> np.ndarray:
        """Number (1,) of the history variable with the energy [J] that it has dissipated, if it has one (0,)."""
        names = self.compiled.memory if self.compiled is not None else ()
        return self.memory[[name == "dissipated" for name in names]] if names else self.memory[:0]

    @property
    def lets_go(self) -> bool:
        """Whether it is open in some states: its conditions come and go, or its force is one of f.positive alone."""
        part, item = self.compiled, self.alone
        p, v, _ = somewhere_near(item)
        data = (*self.data, *remembered(self.item)) if part is not None else ()
        if part is not None and part.potential is not None:
            return not part.potential(part.split(p[item.dofs]), data, gravity_of(item), _OPEN)
        if part is not None and part.along is not None and part.force is not None:
            return not part.force(part.split(p[item.dofs]), part.split(v[item.dofs]), data, _OPEN)
        return is_one_sided(self.item)

    @cached_property
    def data(self) -> np.ndarray:
        """Numbers of a compiled part, see `physics.connections`."""
        assert isinstance(self.item, PartAtPoints)
        connection = self.item.connection
        if connection.points != (found := len(self.item.points)):
            raise InputError(
                f"{connection.name} is defined for {connection.points} point{'s' * (connection.points > 1)}, but "
                f"{self.name} has {found}"
            )
        given = called(f"data of {self.name}", self.item.data, self.reference)
        numbers, names = items(f"data of {self.name}", given), connection.data
        if len(numbers) != len(names):
            raise InputError(
                f"data of {self.name} must return {len(names)} numbers ({', '.join(names)}), got {len(numbers)}"
            )
        return np.array([finite(f"{name} of {self.name}", x) for name, x in zip(names, numbers, strict=True)])

    @cached_property
    def per_point(self) -> int:
        """Number of coordinates of a point, 3 with its rotation or 2 without."""
        return 3 if uses_rotations(self.item) else 2

    @cached_property
    def places(self) -> np.ndarray:
        """Places (d,) of the coordinates among those of q (m, 3)."""
        every = np.arange(self.reference.size)
        return every[every % 3 < self.per_point][: len(self.dofs)]

    @cached_property
    def undeformed(self) -> np.ndarray:
        """Coordinates (d,) in the reference."""
        return self.reference.ravel()[self.places]

    @cached_property
    def turns(self) -> np.ndarray:
        """Which of the coordinates (d,) are rotations."""
        turning = self.places % 3 == 2
        turning[len(turning) - len(self.amplitudes) :] = False
        return turning

    @cached_property
    def units(self) -> np.ndarray:
        """Natural unit (d,) of each coordinate: the length [m] of the longest connected beam, and 1 rad."""
        size = max(point.beam.curve.length for point in self.item.points)
        return np.where(self.turns, 1.0, size)

    def by_point(self, values: np.ndarray) -> np.ndarray:
        """Return values (..., d) of the coordinates as (..., m, 3), zero for rotations that are none of them."""
        result = np.zeros((*values.shape[:-1], self.reference.size), dtype=values.dtype)
        result[..., self.places] = values
        return result.reshape(*values.shape[:-1], *self.reference.shape)

    def on_points(self, forces: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Return forces (..., d) as forces and moments on its points (..., m, 3), in a state q."""
        result = self.by_point(forces)
        return result if len(q) == len(self.item.points) else self.item.on_points(result, q)  # type: ignore[attr-defined]

    def at(self, motion: Motion, time: float, gravity: np.ndarray) -> At:
        """Return the state at which the contribution is evaluated; the motion may be complex."""
        q, rate, second = (self.by_point(values[self.dofs]) for values in motion)
        memory = motion[0][self.memory].real
        return At(q, rate, second, motion[0][self.own], memory, self.reference, time, gravity)

    def force(self, at: At) -> np.ndarray:
        """Return the force (d + k,). Raises InputError for an invalid result."""
        with np.errstate(all="ignore"):  # far from equilibrium a force may overflow; the iteration recovers from it
            return self._force(at)

    def _force(self, at: At) -> np.ndarray:
        force = np.asarray(called(f"force of {self.name}", self.item.force, at))
        count = self.reference.size + len(self.own)
        if force.shape != (count,) or force.dtype.kind not in "fic":
            flat = "; .ravel() makes it flat" if force.size == count and force.ndim > 1 else ""
            raise InputError(
                f"force of {self.name} must return {count} numbers, fx, fy and moment at each of its "
                f"{len(self.reference)} points and {len(self.own)} conditions, as an array ({count},), got "
                f"{force.dtype} {force.shape}{flat}"
            )
        return force[self._components] if self.per_point == 3 else self._without_moments(force)

    def _without_moments(self, force: np.ndarray) -> np.ndarray:
        """Return the force (2 m + k,) of one (3 m + k,) whose moments are zero. Raises InputError if they are not."""
        moments = force[2 : self.reference.size : 3]
        forces = force[self._components]
        if moments.any() and np.isfinite(forces).all():  # of forces that overflow, moments may be 0 times inf
            number = int(np.flatnonzero(moments)[0])
            raise InputError(
                f"{self.name} has rotations = False, so its moments must be zero, but its force has the moment "
                f"{moments[number].real:g} at points[{number}]; leave out rotations = False"
            )
        return np.asarray(forces)

    @cached_property
    def _components(self) -> np.ndarray:
        """Numbers (2 m + k,) of forces and conditions among those (3 m + k,) with moments."""
        return np.append(self.places, self.reference.size + np.arange(len(self.own)))

    def remember(self, at: At) -> np.ndarray:
        """Return the history variables (h,) after an accepted step. Raises InputError for an invalid result."""
        if not len(self.memory):
            return np.empty(0)
        assert isinstance(self.item, Remembering)
        history = np.asarray(called(f"remember of {self.name}", self.item.remember, at))
        if history.shape != self.memory.shape or history.dtype.kind not in "fi" or not np.isfinite(history).all():
            raise InputError(f"remember of {self.name} must return {len(self.memory)} finite numbers, got {history}")
        return history

    def energy(self, at: At) -> tuple[complex, complex]:
        """Return kinetic and potential energy [J]. Raises InputError for an invalid result."""
        energies = np.asarray(called(f"energy of {self.name}", self.item.energy, at))
        if energies.shape != (2,) or energies.dtype.kind not in "fic":
            raise InputError(
                f"energy of {self.name} must return two numbers, kinetic and potential energy in this order, "
                f"got {energies}"
            )
        kinetic, potential = energies.tolist()
        return kinetic, potential

    def energies(self, motion: Motion, times: np.ndarray, gravity: np.ndarray) -> np.ndarray:
        """Return kinetic and potential energy (rows, 2) [J] in motions (rows, n), with gravity (rows, 2).

        Parts of the package have energies that do not depend on time.
        """
        if isinstance(self.item, PartAtPoints) and of_package(type(self.item)):
            q, rate, second = (np.moveaxis(self.by_point(values[:, self.dofs]), 0, -1) for values in motion)
            own, memory = (motion[0][:, numbers].T for numbers in (self.own, self.memory))
            both = self.item.energy(At(q, rate, second, own, memory, self.reference, 0.0, gravity.T))
            return np.column_stack([np.broadcast_to(each, times.shape) for each in both])
        rows = zip(*motion, times.tolist(), gravity, strict=True)
        energies = [self.energy(self.at((p, v, a), time, acting)) for p, v, a, time, acting in rows]
        return np.array(energies).reshape(-1, 2).real

    def own_motion(self, motion: Motion) -> Motion:
        """Return the motion (n,) of what the contribution acts on, complex, numbered as `alone`."""
        p, v, a = (values[self._used].astype(complex) for values in motion)
        return p, v, a

    def tangent(self, motion: Motion, time: float, gravity: np.ndarray, weights: Sequence[float]) -> np.ndarray:
        """Return the tangent (d + k, d + k) of the force for weights of p, p' and p'', by complex steps.

        Raises LinAlgError if it is not finite.
        """
        if self.compiled is not None:
            return self._compiled_tangent(self.compiled, motion, gravity, weights)
        return self.linearised(motion, time, gravity, weights)[1]

    def linearised(
        self, motion: Motion, time: float, gravity: np.ndarray, weights: Sequence[float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return force (d + k,) and tangent of a user-defined contribution; the steps leave the force as it is.

        Raises LinAlgError if the tangent is not finite.
        """
        at = self.at(motion, time, gravity)
        if hasattr(self.item, "exact_tangent"):
            return self.force(at).real, np.asarray(weights[0] * self.item.exact_tangent(at))
        places, size = len(self.dofs), len(self.all)
        state = at.q, at.v, at.a, at.own
        own = q, v, a, held = [values.astype(complex) for values in state]
        at, columns = At(q, v, a, held, at.memory, at.reference, time, gravity), np.empty((size, size), dtype=complex)
        steps = [(each, 1j * COMPLEX_STEP * weight) for each, weight in zip((q, v, a), weights, strict=True) if weight]
        with np.errstate(all="ignore"):  # see `force`
            for number in range(size):
                for values, real in zip(own, state, strict=True):
                    values[...] = real  # anew, as users may have changed them
                if number < places:
                    place = divmod(int(self.places[number]), 3)
                    for values, step in steps:
                        values[place] += step
                else:
                    held[number - places] += 1j * COMPLEX_STEP * weights[0]
                columns[number] = self._force(at)
        tangent = np.ascontiguousarray(columns.imag.T) / COMPLEX_STEP
        if not np.isfinite(tangent).all():
            raise LinAlgError(f"force of {self.name} is not finite")
        return columns[-1].real, tangent

    def force_in(self, motion: Motion, time: float, gravity: np.ndarray) -> np.ndarray:
        """Return the force (d + k,) in a real motion."""
        if self.compiled is None:
            return self.force(self.at(motion, time, gravity)).real
        result = np.empty(len(self.all))
        passes_of(self.compiled).force(*self.numbers(motion, gravity), result)
        return result

    def _compiled_tangent(
        self, connection: Connection, motion: Motion, gravity: np.ndarray, weights: Sequence[float]
    ) -> np.ndarray:
        result = np.empty((len(self.all), len(self.all)))
        passes_of(connection).tangent(*self.numbers(motion, gravity), *map(float, weights), result)
        if not np.isfinite(result).all():
            raise LinAlgError(f"force of {self.name} is not finite")
        return result

    def numbers(self, motion: Motion, gravity: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return the arguments of compiled forces and tangents."""
        q, v, a = (values[self.dofs] for values in motion)
        turned = np.column_stack([np.cos(q[self.turns]), np.sin(q[self.turns])])
        past = motion[0][self.memory]
        data = np.concatenate([self.data, past]) if len(past) else self.data
        return q, v, a, motion[0][self.own], turned, data, gravity


WIDTH = 1e-7  # of the central differences to which complex steps are compared, relative to the natural units
_NEAR = 1e-3  # distance from the reference at which a force is checked, and rates per second, in the same units
AGREE = 1e-4
_PLACES, _FAR = 32, 4.0  # places at which a dissipation function is evaluated, and their distance in natural units
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
        if _by_rates(item, (p, v, 0.0 * v)).any():
            return True
    return False


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


SHORT_TIME = 1e-4  # [s] of the differences that give rates of conditions
_FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0  # functions of time need not be defined before the start
_ROUND_OFF = 1e-13  # relative to the largest stiffness of a contribution
_COORDINATES = ("r^x", "r^y", "theta")
_TURNED = np.array([0.0, 0.0, 0.1])  # arbitrary
_OPEN = ANALYTIC._replace(positive=lambda x: 0.0 * x)
_NO_NUMBERS, _NOTHING = np.empty(0, dtype=np.int64), np.empty(0)


@dataclass(frozen=True, eq=False)
class Connectors:
    """All connectors of a model.

    left_out (d,): numbers of the multipliers of redundant conditions, which are no unknowns.
    """

    model: Model
    static: bool
    items: tuple[Connector, ...]
    left_out: np.ndarray = field(default_factory=lambda: _NO_NUMBERS)

    @cached_property
    def every_multiplier(self) -> np.ndarray:
        """Numbers of all multipliers."""
        return np.concatenate([_NO_NUMBERS, *(item.multipliers for item in self.items)])

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Numbers (k,) of the multipliers that are unknowns."""
        every = self.every_multiplier
        return every[~np.isin(every, self.left_out)] if len(self.left_out) else every

    @cached_property
    def one_sided(self) -> np.ndarray:
        """Numbers (k,) of the multipliers whose conditions come and go."""
        return np.concatenate([_NO_NUMBERS, *(item.multipliers for item in self.items if is_one_sided(item.item))])

    def gradients(self, p: np.ndarray, load_factor: float) -> csr_array:
        """Return the gradients (k, n) of the conditions that come and go, in a state p (n,)."""
        zeros, gravity, size = np.zeros(len(p)), np.zeros(2), (len(self.one_sided), len(p))
        entries, places, first = [_NOTHING], [np.empty((2, 0), dtype=np.int64)], 0
        for item in (each for each in self.items if is_one_sided(each.item)):
            d = len(item.dofs)
            rates = item.tangent((p, zeros, zeros), load_factor, gravity, (1.0, 0.0, 0.0))[d:, :d]
            row, column = np.indices(rates.shape)
            entries.append(rates.ravel())
            places.append(np.stack([first + row.ravel(), item.dofs[column.ravel()]]))
            first += len(rates)
        return csr_array(coo_array((np.concatenate(entries), tuple(np.concatenate(places, axis=1))), shape=size))

    @property
    def bodies(self) -> list[Mesh]:
        """The parts with amplitudes, as meshes of one element: nodes of three coordinates, and of one."""
        found = []
        for item in (each for each in self.items if len(each.amplitudes)):
            alone = np.column_stack([item.amplitudes, np.full((len(item.amplitudes), 2), -1)])
            dof = np.vstack([item.dofs[: -len(alone)].reshape(-1, 3), alone])
            found.append(Mesh(np.arange(len(dof))[None], dof))
        return found

    @cached_property
    def memory(self) -> np.ndarray:
        """Numbers (h,) of the history variables."""
        return np.concatenate([_NO_NUMBERS, *(item.memory for item in self.items)]) if self.items else _NO_NUMBERS

    @cached_property
    def start(self) -> np.ndarray:
        """Initial values (h,) of the history variables."""
        return np.concatenate([_NOTHING, *(remembered(item.item) for item in self.items)]) if self.items else _NOTHING

    def remember(self, motion: Motion, time: float) -> np.ndarray:
        """Return the history variables (h,) after an accepted step to this state."""
        gravity = self.gravity(time)
        return np.concatenate([np.empty(0), *(item.remember(item.at(motion, time, gravity)) for item in self.items)])

    @property
    def conservative(self) -> bool:
        return all(item.item.conservative for item in self.items)

    @cached_property
    def keep_energy(self) -> bool:
        """Whether no connector adds energy to a motion or dissipates it."""
        return self.conservative and not self.damp and not self.follow_time

    @cached_property
    def follow_time(self) -> bool:
        """Whether a force or a condition depends on time other than by gravity or a prescribed value."""
        return any(any(follows_time(item)) for item in self.items)

    @cached_property
    def conditions_follow_time(self) -> bool:
        """Whether a condition depends on time other than by a prescribed value."""
        return any(follows_time(item)[1] for item in self.items)

    @cached_property
    def driving(self) -> "Connectors":
        """Those whose forces do work; others conserve energy or dissipate it."""

        def drives(item: Connector) -> bool:
            return (not item.item.conservative and not len(item.dissipated)) or any(follows_time(item))

        return Connectors(self.model, self.static, tuple(filter(drives, self.items)))

    @cached_property
    def damp(self) -> bool:
        """Whether a connector resists rates."""
        return any(resists_rates(item) for item in self.items)

    def gravity(self, time: float) -> np.ndarray:
        """Return the acceleration (2,) [m/s^2] of all gravity loads at a time."""
        result = np.zeros(2)
        for load in self.model.gravity:
            result += np.array(load.vector) * factor(load, time, self.static)
        return result

    def add_forces(self, residual: np.ndarray, motion: Motion, time: float) -> None:
        """Add the forces of all connectors to a residual (n,)."""
        gravity = self.gravity(time) if self.items else np.zeros(2)
        for item in self.items:
            np.add.at(residual, item.all, item.force_in(motion, time, gravity))

    def tangents(self, motion: Motion, time: float, weights: Sequence[float]) -> list[np.ndarray]:
        """Return the tangent (d + k, d + k) of each connector for weights of p, p' and p''."""
        gravity = self.gravity(time) if self.items else np.zeros(2)
        return [item.tangent(motion, time, gravity, weights) for item in self.items]

    def energies(self, motion: Motion, times: np.ndarray) -> np.ndarray:
        """Return the total kinetic and potential energy (rows, 2) [J] in motions p, p', p'' (rows, n) at times."""
        gravity = np.array([self.gravity(time) for time in times.tolist() if self.items]).reshape(-1, 2)
        return sum((item.energies(motion, times, gravity) for item in self.items), np.zeros((len(times), 2)))

    def momenta(self, motion: Motion, time: float) -> np.ndarray:
        """Return the linear momentum [kg m/s] and the angular momentum about the origin [kg m^2/s] (3,)."""
        gravity, result = self.gravity(time), np.zeros(3)
        for item in self.items:
            momenta = np.empty(len(item.dofs))
            for number in range(len(item.dofs)):
                p, v, a = item.own_motion(motion)
                v[number] += 1j * COMPLEX_STEP
                moved = p.real, v, a.real
                momenta[number] = np.imag(item.energy(item.alone.at(moved, time, gravity))[0]) / COMPLEX_STEP
            q = item.by_point(motion[0][item.dofs])
            for (x, y, _), (px, py, turn) in zip(q, item.on_points(momenta, q), strict=False):
                result += px, py, x * py - y * px + turn
        return result

    def conditions(self, p: np.ndarray, rate: np.ndarray, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the residuals (k,) of all conditions in a state p (n,) at a time, and their rates for p' (n,)."""
        zeros, gravity = np.zeros(len(p)), np.zeros(2)
        values, rates = [_NOTHING], [_NOTHING]
        for item in (each for each in self.items if len(each.own)):
            d, motion = len(item.dofs), (p, zeros, zeros)
            rows, moved = slice(d, d + len(item.multipliers)), rate[item.all]
            moved[rows] = 0.0
            values.append(item.force_in(motion, time, gravity)[rows])
            rates.append(item.tangent(motion, time, gravity, (1.0, 0.0, 0.0))[rows] @ moved)
            if item.compiled is None:
                later = [item.force_in(motion, time + k * SHORT_TIME, gravity)[rows] for k in range(len(_FORWARD))]
                rates[-1] += _FORWARD @ later / SHORT_TIME
        return np.concatenate(values), np.concatenate(rates)

    @cached_property
    def errors(self) -> np.ndarray:
        """Residual (2, n) per unit relative error: in positions of 1 m [1/m], and in directions."""
        result = np.zeros((2, self.model.size))
        if not self.items:
            return result
        for item, stiffness in zip(self.items, self._stiffness, strict=True):
            turns = np.append(item.turns, np.ones(len(item.own), dtype=bool))
            for row, columns in zip(result, (~turns, turns), strict=True):
                np.add.at(row, item.all, np.abs(stiffness[:, columns]).sum(axis=1))
        return result

    def stopped(self) -> list[tuple[Connector, np.ndarray]]:
        """Return each connector with the normalised motions (r, 3 m) of its points that it resists in the reference."""
        result = []
        for item, stiffness in zip(self.items, self._stiffness, strict=True):
            forces = stiffness[: len(item.dofs), : len(item.dofs)].copy()
            # makes moments comparable with forces
            length = max(point.beam.curve.length for point in item.item.points)
            forces[item.turns] /= length
            sizes = np.abs(forces).max(axis=1, initial=0.0)
            forces[sizes <= _ROUND_OFF * sizes.max(initial=0.0)] = 0.0
            conditions = stiffness[len(item.dofs) :, : len(item.dofs)]
            rows = np.vstack([forces, conditions])
            sizes = np.abs(rows).max(axis=1, initial=0.0)
            motions = rows[sizes > 0.0] / sizes[sizes > 0.0, None]
            result.append(
                (item, item.on_points(motions, item.reference).reshape(len(motions), 3 * len(item.item.points)))
            )
        return result

    @cached_property
    def _stiffness(self) -> list[np.ndarray]:
        """Tangent of each connector in the reference."""
        p, zeros = np.zeros(self.model.size), np.zeros(self.model.size)
        for item in self.items:
            p[item.dofs] = item.undeformed
        p[self.memory] = self.start
        return self.tangents((p, zeros, zeros), 0.0, (1.0, 0.0, 0.0))


def connectors_of(model: Model, static: bool) -> Connectors:
    """Return the connectors of a model with their coordinates. Raises InputError for wrong shapes."""
    if not model.at_points:
        return Connectors(model, static, ())
    if "connectors" not in model.tables:  # checked once for statics and motions
        model.tables["connectors"] = _checked_connectors(model)
    return Connectors(model, static, model.tables["connectors"])


def _checked_connectors(model: Model) -> tuple[Connector, ...]:
    """Return the connectors of a model, evaluated once to check shapes and finite values."""
    amplitude, first, connectors = model.coordinates - sum(map(amplitudes_of, model.at_points)), model.coordinates, []
    value = first_value(model)
    behind = value + sum(len(prescribed_by(item)) for item in model.at_points)
    for given in model.at_points:
        for item, nodes in _with_nodes(given, model):
            dofs, positions = [], []
            for mesh, node, *slope in nodes:
                numbers, place = mesh.coordinates_of(node), slope[0] if slope else mesh.position[node].tolist()
                names = ("r_x^x", "r_x^y") if slope else _COORDINATES[: 3 if uses_rotations(item) else 2]
                dofs += [numbers[name] for name in names]
                positions.append([*place, 0.0])
            dofs += range(amplitude, amplitude + amplitudes_of(item))
            positions += [[0.0] * 3] * -(-amplitudes_of(item) // 3)
            amplitude += amplitudes_of(item)
            values = len(prescribed_by(item))
            own = np.concatenate([np.arange(first, first + item.unknowns), np.arange(value, value + values)])
            first, value = first + item.unknowns, value + values
            memory = np.arange(behind, behind + len(remembered(item)))
            behind += len(memory)
            place = np.array(dofs, dtype=np.int64), own, memory, np.array(positions)
            connectors.append(Connector(item, *place, given))
    for connector in connectors:
        if connector.compiled is None:
            _require_finite(connector.alone)
        elif connector.compiled not in GENERATED:
            _require_usable(connector.alone)
    return tuple(connectors)


def first_value(model: Model) -> int:
    """Return the number of the first coordinate that is a prescribed value of a condition; they follow multipliers."""
    return model.coordinates + sum(item.unknowns for item in model.at_points)


_Nodes = list[tuple[Any, ...]]  # a mesh and a node, and the reference slope if r_x is meant


def _with_nodes(given: Contribution, model: Model) -> list[tuple[Contribution, _Nodes]]:
    """Return a part with its nodes; of one along a beam, what acts at its nodes and quadrature points."""
    if not isinstance(given, PartAlongBeam):
        places = [(model.mesh_of(point), point.fraction) for point in given.points]
        return [(given, [(mesh, mesh.node_at(fraction)) for mesh, fraction in places])]
    mesh = model.mesh_of(given.beam.start)
    element = mesh.beam.element
    if given.rotations and any("theta" not in mesh.coordinates_of(node) for node in range(mesh.nodes)):
        raise InputError(
            f"{type(given).__name__} acts on rotations along a beam, and the nodes of {element.name} have none; take "
            "an element with rotations, such as CRBF"
        )
    xi, weights = rule_of(element.field)
    lengths, arcs = np.zeros(len(mesh.position)), np.zeros(len(mesh.position))
    np.add.at(lengths, mesh.node, mesh.lengths[:, None] * weights)
    elements = np.repeat(np.arange(mesh.elements), len(xi))
    arcs[mesh.node.ravel()] = mesh.arc_length(elements, np.tile(xi, mesh.elements))
    points = [given.beam.at(min(arc / given.beam.curve.length, 1.0)) for arc in arcs.tolist()]
    if type(given).on_axis is not PartAlongBeam.on_axis:
        return [_on_axis(given, mesh, points, model)]
    at_nodes = [(item, [(mesh, node)]) for node, item in enumerate(given.at_nodes(points, lengths))]
    return [*at_nodes, *_at_stations(given, mesh, points)]


def _on_axis(given: PartAlongBeam, mesh: BeamMesh, points: list[Point], model: Model) -> tuple[Contribution, _Nodes]:
    """Return what acts on the axis of a beam and on a point, with its rows: the first node, the point, the others."""
    element, field, point = mesh.beam.element, mesh.beam.element.field, given.points[1]
    wanted = [name for name in field.vectors if name in ("r", "r_x")]
    if any(f"{name}^x" not in mesh.labels(node) for node in range(mesh.nodes) for name in wanted):
        raise InputError(
            f"{type(given).__name__} needs r_x as a coordinate, which the nodes of {element.name} do not have; take "
            "another element, such as CRBF(3)"
        )
    vectors = reference_vectors(mesh, np.arange(mesh.elements)).reshape(*mesh.node.shape, -1, 2)
    slope = np.zeros((mesh.nodes, 2))
    slope[mesh.node] = vectors[:, :, len(wanted) - 1]
    other = model.mesh_of(point)
    rows: _Nodes = [(mesh, node) for node in range(mesh.nodes)]
    rows.insert(1, (other, other.node_at(point.fraction)))
    rows += [(mesh, node, slope[node].tolist()) for node in range(mesh.nodes) if "r_x" in wanted]
    places = np.stack([mesh.node + (mesh.node > 0), mesh.node + mesh.nodes + 1][: len(wanted)], axis=2)
    scale = scales(element, mesh.lengths)[:, r_slots(field)]
    axis = AxisRows(field, places.reshape(mesh.elements, -1), scale, (points[0], point, *points[1:]))
    return given.on_axis(axis), rows


def _at_stations(given: PartAlongBeam, mesh: BeamMesh, points: Sequence[Point]) -> list[tuple[Contribution, _Nodes]]:
    """Return what acts at the quadrature points of a part along a beam, with the nodes of the element."""
    if type(given).at_stations is PartAlongBeam.at_stations:
        return []
    field = mesh.beam.element.field
    if "r_x" in field.vectors:
        raise InputError(
            f"{type(given).__name__} acts at stations along a beam, which the {field.name} field with r_x does "
            "not have; take elements of an order, such as CRBF(3)"
        )
    element, xi, weight = length_points(mesh)
    slopes = field.centreline(xi, 1) / jacobians(mesh, element, xi)[0][:, None]
    nodes = mesh.node[element]
    rows = zip(nodes.tolist(), field.centreline(xi), slopes, weight.tolist(), strict=True)
    stations = [Station(tuple(points[node] for node in own), *row) for own, *row in rows]
    found = given.at_stations(stations)
    if len(found) != len(stations):
        raise InputError(
            f"at_stations of {type(given).__name__} must return a part for each of {len(stations)}, got {len(found)}"
        )
    return [(item, [(mesh, node) for node in own]) for own, item in zip(nodes.tolist(), found, strict=True)]


def _require_finite(item: Connector) -> None:
    """Raise InputError if the force of a connector is not finite near the reference, or a shape is wrong.

    Points are turned even without rotations, so that moments which rotations would cause are refused too.
    """
    at = item.at(somewhere_near(item), TIMES[0], gravity_of(item))
    if item.per_point == 2:
        at = replace(at, q=at.q + _TURNED, v=at.v + _TURNED, a=at.a + _TURNED)
    if not (np.isfinite(item.force(at)).all() and np.isfinite(item.energy(at)).all()):
        raise InputError(f"force or energy of {item.name} is not finite near the reference")


def _require_usable(item: Connector) -> None:
    """Raise InputError if a part in formulas or C has numbers that are not finite at the start, or lacks a potential.

    Motions judge their steps by the energy, in which the work of a force without its potential would be missing.
    """
    p, v, a = somewhere_near(item)
    gravity, still, definition = gravity_of(item), np.zeros_like(p), item.compiled
    if definition is not None and item.item.conservative and type(item.item).energy is PartAtPoints.energy:
        none = definition.potential is definition.kinetic is None and not definition.multipliers
        if none and item.force_in((p, still, still), TIMES[0], gravity).any():
            raise InputError(
                f"{item.name} is conservative, but {definition.name} has a force at rest without its potential; give "
                f"the potential as well, or {item.name} conservative = False"
            )
    p[item.dofs] = item.undeformed
    try:
        item.tangent((p, v, a), TIMES[0], gravity, (1.0, 0.0, 0.0))
    except LinAlgError:
        raise InputError(f"force of {item.name} or its derivative is not finite in the reference") from None
    with np.errstate(all="ignore"):
        item.remember(item.at((p, v, a), TIMES[0], gravity))


def same_connectors(own: Connectors, others: Connectors) -> dict[Connector, Connector]:
    """Return the connectors of a model that are in another one, too, each with the one there."""
    known = {id(item.item): item for item in others.items}
    return {item: known[id(item.item)] for item in own.items if id(item.item) in known}
