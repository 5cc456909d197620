"""A connector with the numbers of its coordinates: its force, its tangent by complex steps, and its energy."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.model.contribution import At, Contribution, Remembering, amplitudes_of, uses_rotations
from beamfem.parts.at_points import OnElements, PartAtPoints
from beamfem.physics.compiled_connections import passes_of
from beamfem.physics.connections import TURNING, Connection
from beamfem.validation import called, finite, items, of_package

COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted
_NONE = np.empty(0)

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
    name: str

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
            return _NONE
        zeros, first = np.zeros(len(p)), len(self.dofs)
        gaps = self.force_in((p, zeros, zeros), 0.0, np.zeros(2))[first : first + len(self.values)]
        return np.asarray(p[self.values] + gaps)

    @cached_property
    def alone(self) -> "Connector":
        """The same contribution with coordinates, multipliers and history variables numbered from 0, in this order."""
        dofs, own, memory = np.split(np.arange(self.variables), np.cumsum([len(self.dofs), len(self.own)]))
        return Connector(self.item, dofs, own, memory, self.reference, self.given, self.name)

    @property
    def variables(self) -> int:
        """Number of coordinates, multipliers and history variables."""
        return len(self._used)

    @cached_property
    def _used(self) -> np.ndarray:
        return np.concatenate([self.dofs, self.own, self.memory])

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
        """See `kernels.model_record.Parts`."""
        return self.item.position_step if isinstance(self.item, OnElements) else 0

    @cached_property
    def rows(self) -> Sequence["Row"]:
        """What compiled code evaluates: itself, or one of several."""
        if isinstance(self.item, OnElements):
            elements = zip(self.item.coordinates, self.item.data_of(self.reference), strict=True)
            return [Row(self.all[own], data) for own, data in elements]
        return [Row(self.all, self.data if self.compiled is not None else _NONE)]

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
