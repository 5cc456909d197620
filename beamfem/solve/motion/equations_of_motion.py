"""User-defined time integrators, and the equations that they solve."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import block_array, block_diag, csc_array, csr_array, dia_array

from beamfem.equations.equations import linearise, residual
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.linalg.lapack import superlu
from beamfem.linalg.tangent import UNROTATED, rotation_to_normals
from beamfem.model.model import Model
from beamfem.reprs import brief
from beamfem.results.solution import Solution, State
from beamfem.results.status import Statistics
from beamfem.solve.motion.start_acceleration import initial_acceleration
from beamfem.solve.newton.newton import Correction, Termination, iterate
from beamfem.solve.start.start_checks import refuse_frame
from beamfem.solve.start.start_state import last_state, transferred
from beamfem.validation import count, positive

_NOISE = 1e-9  # of the model: smaller corrections that no longer decrease are round-off


@dataclass(frozen=True, eq=False)
class EquationsOfMotion:
    """M(p) p'' + inertia of first order + elastic forces - loads = 0, for the unknown coordinates.

    An `Integrator` receives it; `free` (unknown,) are the numbers of the unknown coordinates among all coordinates, and
    `scale` (unknown,) the values relative to which their corrections are measured. Among the unknowns are the
    multipliers of constraints, whose equations are the conditions, and the coordinates that supports move, whose
    equations are p - u(t) = 0: both hold at every time at which an integrator satisfies the equations.

    Parameters
    ----------
    system : System
        The assembled model.
    counted : array of int, (1,)
        Number of calls of `solve`, the iterations of the motion.
    begin : float, [s]
        Time at the start of the step, of the committed history.
    """

    system: System
    counted: np.ndarray
    begin: float = 0.0

    __repr__ = brief

    @classmethod
    def of(cls, model: Model) -> "EquationsOfMotion":
        """Return the equations of a model for solvers of ordinary differential equations, see `rates`.

        Raises InputError for supports that move, and parts with history variables, which need steps.

        >>> from scipy.integrate import solve_ivp
        >>> equations = bf.EquationsOfMotion.of(model)
        >>> solved = solve_ivp(equations.rates, (0.0, 1e-4), equations.coordinates(), method="Radau", rtol=1e-6)
        >>> equations.state(solved.t[-1], solved.y[:, -1]).at
        0.0001
        """
        system = system_of(model, static=False)
        refuse_frame(system, "EquationsOfMotion.of")
        if any(callable(item.value) for item in system.prescribed):
            raise InputError("a model whose supports move has no equations in its free coordinates alone; use simulate")
        if len(system.history.numbers):
            raise InputError("a model with history variables has no rates between steps; use simulate")
        return cls(system, np.zeros(1, dtype=np.int64))

    def rates(self, time: float, y: np.ndarray) -> np.ndarray:
        """Return the derivative of y = (p, p') by time, as `scipy.integrate.solve_ivp` needs it.

        p'' satisfies M p'' = unbalanced forces, with conditions differentiated twice: they are met as well as solutions
        are accurate.

        Parameters
        ----------
        time : float, [s]
            Time.
        y : array, (2 k,)
            The k unknown coordinates without multipliers, and their rates [1/s].

        Returns
        -------
        array, [1/s, 1/s^2], (2 k,)
            The derivative.
        """
        p, v = self._whole(y)
        a = initial_acceleration(self.system, np.array([p, v, np.zeros_like(p)]), float(time))
        return np.concatenate([v[self._unknown], a[self._unknown]])

    def coordinates(self, state: State | Solution | None = None) -> np.ndarray:
        """Return y (2 k,) of a state of the model, see `rates`, by default of the reference at rest."""
        given = last_state(state, "state")
        if given is None:
            return np.concatenate([self.system.reference[self._unknown], np.zeros(len(self._unknown))])
        p, v = transferred(given, self.system, "state")
        return np.concatenate([p[self._unknown], v[self._unknown]])

    def state(self, time: float, y: np.ndarray) -> State:
        """Return the state of y (2 k,) at a time [s], with the multipliers that act there."""
        p, v = self._whole(y)
        state = np.array([p, v, np.zeros_like(p)])
        a = initial_acceleration(self.system, state, float(time))
        return State(state[0], state[1], a, float(time), self.system.model)

    @property
    def _unknown(self) -> np.ndarray:
        return np.setdiff1d(self.system.free_dofs, self.system.connectors.multipliers)

    def _whole(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return p and p' (n,) of y. Raises InputError for another number of values."""
        dofs = self._unknown
        if np.shape(y) != (2 * len(dofs),):
            raise InputError(f"y must have {2 * len(dofs)} values, coordinates and their rates, got {np.shape(y)}")
        p, v = self.system.reference.copy(), np.zeros(self.system.model.size)
        p[self.system.prescribed_dofs] = self.system.prescribed_values(0.0)
        p[dofs], v[dofs] = np.split(np.asarray(y, dtype=float), 2)
        return p, v

    @property
    def free(self) -> np.ndarray:
        """Indices (unknown,) of the unknown coordinates among all n coordinates."""
        return self.system.free_dofs

    @property
    def scale(self) -> np.ndarray:
        """Reference size (unknown,) of a correction of each unknown coordinate.

        The size of the model for positions [m], 1 for rotations and gradients.
        """
        return self.system.scale[self.system.free_dofs]

    def residual(self, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float) -> np.ndarray:
        """Return the left-hand side of the equations in a state.

        Parameters
        ----------
        p, v, a : array, (n,)
            Coordinates, their rates [1/s] and second derivatives [1/s^2].
        time : float, [s]
            Time.

        Returns
        -------
        array, [N, N m], (unknown,)
            The residual; of a condition its own unit, and of a coordinate that a support moves [m, rad].
        """
        unbalanced = residual(self.system, p, v, a, time, time - self.begin)
        dofs, values = driven(self.system, time)
        unbalanced[dofs] = p[dofs] - values
        return unbalanced[self.free]

    def tangent(
        self,
        p: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        time: float,
        weights: tuple[float, float, float],
    ) -> csr_array:
        """Return the derivative of the residual as p, v and a change in a given ratio.

        Parameters
        ----------
        p, v, a : array, (n,)
            Coordinates, their rates [1/s] and second derivatives [1/s^2].
        time : float, [s]
            Time.
        weights : (float, float, float)
            Factors of the derivatives by p, by v [1/s] and by a [1/s^2], which are added.

        Returns
        -------
        csr_array, (unknown, unknown)
            The derivative.
        """
        elapsed = time - self.begin
        whole = linearise(self.system, p, v, a, time, weights, dt=elapsed, moving=True)[1].sparse(UNROTATED)
        if not self.system.driven:
            return whole
        driven = np.isin(self.free, [item.dof for item in self.system.driven])
        keep, own = (dia_array((mask[None], [0]), shape=whole.shape) for mask in (1.0 * ~driven, weights[0] * driven))
        return csr_array(keep @ whole + own)

    def energy(self, p: np.ndarray, time: float) -> float:
        """Return the strain energy and the potential of loads, springs and foundations, see `results.energies`.

        Parameters
        ----------
        p : array, (n,)
            Coordinates.
        time : float, [s]
            Time.

        Returns
        -------
        float, [J]
            Their sum.
        """
        zeros, at = np.zeros((1, len(p))), np.array([time])
        energy = Solution(self.system.model, False, at, p[None], zeros, zeros, Statistics(0, 0, 0, "")).energy()
        return float(energy.strain[0] + energy.potential[0])

    def solve(self, blocks: Sequence[Sequence[csr_array]], right: np.ndarray) -> np.ndarray:
        """Solve a linear system of s x s tangents.

        The solution has no components along the normals of inclined rollers.

        Parameters
        ----------
        blocks : sequence of sequence of csr_array, (s, s)
            The tangents.
        right : array, (s, unknown)
            Right-hand sides.

        Returns
        -------
        array, (s, unknown)
            The solution.

        Raises
        ------
        ConvergenceError
            If the system is singular.
        """
        self.counted[0] += 1
        return self.solver(csr_array(block_array(blocks)))(right.ravel()).reshape(right.shape)

    def solver(self, matrix: csr_array) -> Callable[[np.ndarray], np.ndarray]:
        """Factor a matrix that consists of tangents, and return a function that solves with it.

        Parameters
        ----------
        matrix : csr_array, (s * unknown, s * unknown)
            The matrix, real or complex.

        Returns
        -------
        callable
            Takes a right-hand side (s * unknown,) and returns the solution, which has no components along the normals
            of inclined rollers.

        Raises
        ------
        ConvergenceError
            If the matrix is singular.
        """
        unknown = len(self.free)
        stages = matrix.shape[0] // unknown
        kept = np.ones(unknown, dtype=bool)
        kept[self.system.rotated[0]] = False
        kept = np.tile(kept, stages)
        rotation = csr_array(block_diag([rotation_to_normals(unknown, self.system.rotated)] * stages))
        try:
            factors = superlu(csc_array(csr_array(rotation @ matrix @ rotation.T)[kept][:, kept]))
        except LinAlgError as error:
            raise ConvergenceError("the tangent of a step is singular") from error

        def solve(right: np.ndarray) -> np.ndarray:
            solution = np.zeros(len(kept), dtype=matrix.dtype)
            rotated = (rotation @ (right if np.iscomplexobj(matrix) else right.real))[kept]
            solution[kept] = factors.solve(rotated.astype(matrix.dtype))
            return np.asarray(rotation.T @ solution)

        return solve

    def iterate(
        self,
        linearise: Callable[[], tuple[np.ndarray, Sequence[Sequence[csr_array]]]],
        move: Callable[[np.ndarray], np.ndarray],
        tolerance: float = 1e-11,
        iterations: int = 20,
    ) -> int:
        """Find a step by Newton's method, the loop of all solvers of the package.

        It ends if corrections are small, or if small ones no longer decrease.

        Parameters
        ----------
        linearise : callable
            Returns the left-hand sides (s, unknown) of the equations of the step in the present state, zero for a
            solution, and their s x s tangents.
        move : callable
            Takes a change (s, unknown) of what is sought, adds it, and returns how much p changes (..., unknown).
        tolerance : float, [-], default 1e-11
            Largest change of p relative to `scale` that ends the iteration.
        iterations : int, default 20
            Largest number of iterations.

        Returns
        -------
        int
            Number of iterations.

        Raises
        ------
        ConvergenceError
            If no solution is found.
        InputError
            For results of another shape, or an invalid tolerance or number of iterations.
        """
        problem = _Step(self, linearise, move, positive("tolerance", tolerance))
        found = iterate(problem, count("iterations", iterations))
        if not found.ended.good:
            raise ConvergenceError(f"{found.ended.value}, and the last of them was {problem.size:.2e} of the model")
        return found.iterations


class _Step:
    """The equations of a step of a user-defined integrator."""

    def __init__(
        self,
        motion: EquationsOfMotion,
        linearise: Callable[[], tuple[np.ndarray, Sequence[Sequence[csr_array]]]],
        move: Callable[[np.ndarray], np.ndarray],
        tolerance: float,
    ) -> None:
        self._motion, self._linearise, self._move, self._tolerance = motion, linearise, move, tolerance
        self._number, self.size = 0, np.inf

    def correct(self) -> Correction:
        """Take the next correction. Raises ConvergenceError."""
        left, tangents = self._linearise()
        rows, unknown = np.atleast_2d(left), len(self._motion.free)
        if rows.shape != (len(tangents), unknown) or any(len(row) != len(tangents) for row in tangents):
            raise InputError(
                f"linearise must return left-hand sides ({len(tangents)}, {unknown}), a row for each row of tangents, "
                f"which are as many a row; got {np.shape(left)} and rows of {[len(row) for row in tangents]}"
            )
        moved = np.asarray(self._move(self._motion.solve(tangents, -rows)), dtype=float)
        if not moved.size or moved.shape[-1] != unknown:
            raise InputError(f"move must return how much p changes, as an array (..., {unknown}), got {moved.shape}")
        before, self.size = self.size, float(np.max(np.abs(moved / self._motion.scale), initial=0.0))
        self._number += 1
        return Correction(self._number, self.size, before, 0)

    def check(self, correction: Correction) -> Termination | None:
        """See `loop.Problem`."""
        if correction.diverges:
            return Termination.DIVERGED
        number, size, before, _ = correction
        noise = number > 2 and 0.5 * before < size < _NOISE
        return Termination.CONVERGED if size <= self._tolerance or noise else None


class Integrator(Protocol):
    """A user-defined time integrator, such as one with stages, or with forces between two states."""

    def step(self, motion: EquationsOfMotion, begin: State, end: float) -> State:
        """Return the state after a step.

        Parameters
        ----------
        motion : EquationsOfMotion
            Residual, tangent and solver of the model.
        begin : State
            State at the start of the step, at the time `begin.at`.
        end : float, [s]
            Time at the end of the step.

        Returns
        -------
        State
            State at `end`.

        Raises
        ------
        ConvergenceError
            If no state is found.
        """
        ...


def driven(system: System, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers and values (m,) of the coordinates that supports move, if they count as unknown."""
    dofs = np.array([item.dof for item in system.driven], dtype=np.int64)
    return dofs, system.reference[dofs] + np.array([item.change(time, False) for item in system.driven], dtype=float)
