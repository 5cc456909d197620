"""A contribution with its coordinates in the model: force, energies, and tangent by complex steps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.errors import InputError
from beamfem.model.contribution import At, Contribution, Remembering
from beamfem.once import cached_property
from beamfem.validation import called

COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted

Motion = tuple[np.ndarray, np.ndarray, np.ndarray]  # p, p', p'' (n,)


@dataclass(frozen=True, eq=False)
class Connector:
    """A contribution and the numbers of the coordinates that it acts on.

    dofs (3 m,): x, y and rotation of each point; own (k,): its multipliers; memory (h,): its history variables;
    reference (m, 3): q in the reference.
    """

    item: Contribution
    dofs: np.ndarray
    own: np.ndarray
    memory: np.ndarray
    reference: np.ndarray

    @cached_property
    def all(self) -> np.ndarray:
        """Numbers (3 m + k,) of all coordinates that the force belongs to."""
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

    @cached_property
    def units(self) -> np.ndarray:
        """Natural unit (3 m,) of each coordinate: the length [m] of the longest connected beam, and 1 rad."""
        size = max(point.beam.curve.length for point in self.item.points)
        return np.tile([size, size, 1.0], len(self.reference))

    def at(self, motion: Motion, time: float, gravity: np.ndarray) -> At:
        """Return the state at which the contribution is evaluated; the motion may be complex."""
        q, rate, second = (values[self.dofs].reshape(-1, 3) for values in motion)
        memory = motion[0][self.memory].real
        return At(q, rate, second, motion[0][self.own], memory, self.reference, time, gravity)

    def force(self, at: At) -> np.ndarray:
        """Return the force (3 m + k,). Raises InputError for an invalid result."""
        with np.errstate(all="ignore"):  # far from equilibrium a force may overflow; the iteration recovers from it
            force = np.asarray(called(f"force of {self.name}", self.item.force, at))
        if force.shape != (len(self.dofs) + len(self.own),) or force.dtype.kind not in "fic":
            count = len(self.dofs) + len(self.own)
            flat = "; .ravel() makes it flat" if force.size == count and force.ndim > 1 else ""
            raise InputError(
                f"force of {self.name} must return {count} numbers, fx, fy and moment at each of its "
                f"{len(self.reference)} points and {len(self.own)} conditions, as an array ({count},), got "
                f"{force.dtype} {force.shape}{flat}"
            )
        return force

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
        """Return the tangent (3 m + k, 3 m + k) of the force for weights of p, p' and p'', by complex steps.

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
