"""A contribution with its coordinates in the model: force, energies, and tangent by complex steps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.model.contribution import At, Contribution, Remembering
from beamfem.validation import called

COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted

Motion = tuple[np.ndarray, np.ndarray, np.ndarray]  # p, p', p'' (n,)


@dataclass(frozen=True, eq=False)
class Connector:
    """A contribution and the numbers of the coordinates that it acts on.

    dofs (d,): x, y and rotation of each of m points, x and y alone if it has no rotations; own (k,): its multipliers;
    memory (h,): its history variables; reference (m, 3): q in the reference.
    """

    item: Contribution
    dofs: np.ndarray
    own: np.ndarray
    memory: np.ndarray
    reference: np.ndarray

    @cached_property
    def all(self) -> np.ndarray:
        """Numbers (d + k,) of all coordinates that the force belongs to."""
        return np.concatenate([self.dofs, self.own])

    @cached_property
    def alone(self) -> "Connector":
        """The same contribution with coordinates, multipliers and history variables numbered from 0, in this order."""
        dofs, own, memory = np.split(np.arange(self.variables), np.cumsum([len(self.dofs), len(self.own)]))
        return Connector(self.item, dofs, own, memory, self.reference)

    @property
    def variables(self) -> int:
        """Number of coordinates, multipliers and history variables."""
        return len(self._used)

    @cached_property
    def _used(self) -> np.ndarray:
        return np.concatenate([self.dofs, self.own, self.memory])

    @property
    def name(self) -> str:
        return type(self.item).__name__

    @property
    def per_point(self) -> int:
        """Number of coordinates of a point, 3 with its rotation or 2 without."""
        return len(self.dofs) // len(self.reference)

    @cached_property
    def undeformed(self) -> np.ndarray:
        """Coordinates (d,) in the reference."""
        return self.reference[:, : self.per_point].ravel()

    @cached_property
    def turns(self) -> np.ndarray:
        """Which of the coordinates (d,) are rotations."""
        return np.arange(len(self.dofs)) % self.per_point == 2

    @cached_property
    def units(self) -> np.ndarray:
        """Natural unit (d,) of each coordinate: the length [m] of the longest connected beam, and 1 rad."""
        size = max(point.beam.curve.length for point in self.item.points)
        return np.tile([size, size, 1.0][: self.per_point], len(self.reference))

    def by_point(self, values: np.ndarray) -> np.ndarray:
        """Return values (..., d) of the coordinates as (..., m, 3), zero for rotations that are none of them."""
        result = values.reshape(*values.shape[:-1], len(self.reference), self.per_point)
        if self.per_point == 3:
            return result
        return np.concatenate([result, np.zeros_like(result[..., :1])], axis=-1)

    def at(self, motion: Motion, time: float, gravity: np.ndarray) -> At:
        """Return the state at which the contribution is evaluated; the motion may be complex."""
        q, rate, second = (self.by_point(values[self.dofs]) for values in motion)
        memory = motion[0][self.memory].real
        return At(q, rate, second, motion[0][self.own], memory, self.reference, time, gravity)

    def force(self, at: At) -> np.ndarray:
        """Return the force (d + k,). Raises InputError for an invalid result."""
        with np.errstate(all="ignore"):  # far from equilibrium a force may overflow; the iteration recovers from it
            force = np.asarray(called(f"force of {self.name}", self.item.force, at))
        count = self.reference.size + len(self.own)
        if force.shape != (count,) or force.dtype.kind not in "fic":
            flat = "; .ravel() makes it flat" if force.size == count and force.ndim > 1 else ""
            raise InputError(
                f"force of {self.name} must return {count} numbers, fx, fy and moment at each of its "
                f"{len(self.reference)} points and {len(self.own)} conditions, as an array ({count},), got "
                f"{force.dtype} {force.shape}{flat}"
            )
        return force if self.per_point == 3 else self._without_moments(force)

    def _without_moments(self, force: np.ndarray) -> np.ndarray:
        """Return the force (2 m + k,) of one (3 m + k,) whose moments are zero. Raises InputError if they are not."""
        table, conditions = np.split(force, [self.reference.size])
        table = table.reshape(-1, 3)
        forces, moments = table[:, :2].ravel(), table[:, 2]
        if moments.any() and np.isfinite(forces).all():  # of forces that overflow, moments may be 0 times inf
            number = int(np.flatnonzero(moments)[0])
            raise InputError(
                f"{self.name} has rotations = False, so its moments must be zero, but its force has the moment "
                f"{moments[number].real:g} at points[{number}]; leave out rotations = False"
            )
        return np.concatenate([forces, conditions])

    def remember(self, at: At) -> np.ndarray:
        """Return the history variables (h,) after an accepted step. Raises InputError for an invalid result."""
        if not isinstance(self.item, Remembering):
            return np.empty(0)
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

    def own_motion(self, motion: Motion) -> Motion:
        """Return the motion (n,) of what the contribution acts on, complex, numbered as `alone`."""
        p, v, a = (values[self._used].astype(complex) for values in motion)
        return p, v, a

    def tangent(
        self,
        motion: Motion,
        time: float,
        gravity: np.ndarray,
        weights: Sequence[float],
    ) -> np.ndarray:
        """Return the tangent (d + k, d + k) of the force for weights of p, p' and p'', by complex steps.

        Raises LinAlgError if it is not finite.
        """
        alone, columns = self.alone, []
        for number in range(len(self.dofs) + len(self.own)):
            moved = p, v, a = self.own_motion(motion)
            for values, weight in zip((p, v, a), weights, strict=True):
                values[number] += 1j * COMPLEX_STEP * weight
            columns.append(self.force(alone.at(moved, time, gravity)).imag / COMPLEX_STEP)
        result = np.array(columns).T
        if not np.isfinite(result).all():
            raise LinAlgError(f"force of {self.name} is not finite")
        return result
