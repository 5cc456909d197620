"""Collocation methods of high order: Gauss and Radau IIA."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import get_lapack_funcs
from scipy.sparse import csr_array
from scipy.special import roots_jacobi

from beamfem.equations.equations import INERTIA, STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError
from beamfem.linalg.tangent import BandTangent, Tangent, diagonals
from beamfem.quadrature import gauss
from beamfem.results.solution import State
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion
from beamfem.solve.motion.time_marching import initial_acceleration
from beamfem.validation import number_below

_TOLERANCE = 1e-12  # of the model: error of an iteration
_NOISE = 1e-9  # of the model: smaller corrections that no longer decrease are round-off
_ITERATIONS = 15
_KEPT = 0.1  # convergence factor up to which factors are kept for the next step
_TOGETHER = 10  # steps after a failure of simplified iterations in which they are not tried
_SLOW = 0.8  # convergence factor above which an iteration begins anew with other factors

_RATES = (0.0, 1.0, 0.0)

Solve = Callable[[np.ndarray], np.ndarray]


class Rule(NamedTuple):
    """A collocation method in its nodes c (s,): coefficients A (s, s), weights b (s,), and A = T diag(values) T^-1."""

    nodes: np.ndarray
    coefficients: np.ndarray
    weights: np.ndarray
    values: np.ndarray
    vectors: np.ndarray
    inverse: np.ndarray

    @property
    def ends_with_a_stage(self) -> bool:
        """Whether the last stage is the end of the step."""
        return bool(self.nodes[-1] == 1.0)


def _rule(nodes: np.ndarray) -> Rule:
    """Return the collocation method in given nodes (s,)."""
    powers = np.vander(nodes, increasing=True)
    order = np.arange(1, len(nodes) + 1)
    coefficients = np.linalg.solve(powers.T, (nodes[:, None] ** order / order).T).T
    values, vectors = np.linalg.eig(coefficients)
    return Rule(nodes, coefficients, np.linalg.solve(powers.T, 1.0 / order), values, vectors, np.linalg.inv(vectors))


@dataclass(frozen=True)
class Gauss:
    """Gauss collocation with s stages: order 2 s, without numerical damping, symmetric in time.

    One stage is the implicit midpoint rule. Accelerations at the ends of steps are those of the equations there. If
    supports move, the order falls to s for small steps, measured for one and two stages: their motion is met at the
    stages, which lie within a step.

    Parameters
    ----------
    stages : int, default 3
        Number of stages s, from 1 to 6.

    Raises
    ------
    InputError
        For another number of stages.

    References
    ----------
    Hairer, Lubich and Wanner 2006, II.1.3.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.002, integrator=bf.Gauss(stages=2))
    >>> len(motion)
    11
    """

    stages: int = 3

    def __post_init__(self) -> None:
        object.__setattr__(self, "stages", number_below("stages of Gauss", self.stages, 7, 1))

    @property
    def order(self) -> int:
        """Order of positions, 2 s."""
        return 2 * self.stages

    def run(self) -> "CollocationRun":
        """Return the integrator of one motion, which keeps its factors from step to step."""
        return CollocationRun(_rule(gauss(self.stages)[0]))


def Midpoint() -> Gauss:
    """Return the implicit midpoint rule: Gauss collocation with one stage, order 2, without numerical damping.

    If supports move, the order falls to 1 for small steps, see `Gauss`.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.Midpoint())
    """
    return Gauss(1)


@dataclass(frozen=True)
class Radau:
    """Radau IIA collocation with s stages: order 2 s - 1, L-stable: what a step does not resolve decays.

    The last stage is the end of the step, where equations and conditions hold.

    Parameters
    ----------
    stages : int, default 3
        Number of stages s, from 1 to 5.

    Raises
    ------
    InputError
        For another number of stages.

    References
    ----------
    Hairer and Wanner 1996, IV.5 and IV.8.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.002, integrator=bf.Radau())
    >>> len(motion)
    11
    """

    stages: int = 3

    def __post_init__(self) -> None:
        object.__setattr__(self, "stages", number_below("stages of Radau", self.stages, 6, 1))

    @property
    def order(self) -> int:
        """Order of positions, 2 s - 1."""
        return 2 * self.stages - 1

    def run(self) -> "CollocationRun":
        """Return the integrator of one motion, which keeps its factors from step to step."""
        inner = roots_jacobi(self.stages - 1, 1.0, 0.0)[0] if self.stages > 1 else np.empty(0)
        return CollocationRun(_rule(np.append(0.5 * (inner + 1.0), 1.0)))


class _Factors(NamedTuple):
    """Solvers of M + h z C + (h z)^2 K for the eigenvalues z of A, one of each conjugate pair."""

    step: float
    solvers: dict[int, Solve]


class _Last(NamedTuple):
    """The accelerations (s, n) of the stages of the last step, its end and length [s]."""

    end: float
    step: float
    accelerations: np.ndarray


class CollocationRun:
    """A collocation method within a motion: simplified Newton iterations on its stages, in the eigenvectors of A.

    Unknowns are the accelerations of the stages: p_i = p + c_i h v + h^2 (A^2)_ij a_j, v_i = v + h A_ij a_j. Each
    eigenvalue of A needs one matrix of the size of the model, kept while iterations converge fast (Hairer and Wanner
    1996, IV.8). If they do not converge, the tangents of all stages are solved together.
    """

    def __init__(self, rule: Rule) -> None:
        self._rule, self._squared = rule, rule.coefficients @ rule.coefficients
        self._factors: _Factors | None = None
        self._last: _Last | None = None
        self._together = 0

    def step(self, motion: EquationsOfMotion, begin: State, end: float) -> State:
        """Return the state after a step. Raises ConvergenceError or LinAlgError."""
        h, rule = end - begin.at, self._rule
        a = self._accelerations(motion, begin, h)
        self._last = _Last(end, h, a)
        if rule.ends_with_a_stage:
            p, v = self._stages(begin, h, a)
            return replace(begin, p=p[-1], v=v[-1], a=a[-1], at=end)
        p = begin.p + h * begin.v + h * h * (rule.weights @ rule.coefficients @ a)
        at_end = np.linalg.solve(np.vander(rule.nodes, increasing=True).T, np.ones(len(a))) @ a
        state = np.array([p, begin.v + h * (rule.weights @ a), at_end])
        found = initial_acceleration(system_of(begin.model, static=False), state, end)
        return replace(begin, p=state[0], v=state[1], a=found, at=end)

    def _accelerations(self, motion: EquationsOfMotion, begin: State, h: float) -> np.ndarray:
        """Return the accelerations (s, n) of the stages. Raises ConvergenceError or LinAlgError.

        A start without acceleration is tried if steps do not resolve vibrations, whose accelerations say nothing of the
        next step; the faster iterations are left out for some steps where they fail.
        """
        predicted, rule = self._predicted(begin, h), self._rule
        for start in (predicted, np.zeros_like(predicted)):
            if self._together == 0 or start is not predicted:
                found = self._iterated(motion, begin, h, start)
                if found is not None:
                    return found
                self._together = _TOGETHER
            self._together = max(self._together - 1, 0)
            try:
                return _solved_together(motion, begin, h, rule, start)
            except (ConvergenceError, LinAlgError):
                if start is not predicted:
                    raise
        raise AssertionError("one of both starts returns or raises")

    def _predicted(self, begin: State, h: float) -> np.ndarray:
        """Return accelerations (s, n) of the stages by the polynomial of the last step, or those of the start."""
        last, nodes = self._last, self._rule.nodes
        if last is None or abs(last.end - begin.at) > 1e-9 * h:
            return np.tile(begin.a, (len(nodes), 1))
        known = np.vander(nodes, increasing=True)
        wanted = np.vander(1.0 + nodes * h / last.step, len(nodes), increasing=True)
        return wanted @ np.linalg.solve(known, last.accelerations)

    def _stages(self, begin: State, h: float, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return p and p' (s, n) of the stages."""
        rule = self._rule
        p = begin.p + np.outer(h * rule.nodes, begin.v) + h * h * (self._squared @ a)
        return p, begin.v + h * (rule.coefficients @ a)

    def _iterated(self, motion: EquationsOfMotion, begin: State, h: float, start: np.ndarray) -> np.ndarray | None:
        """Return the accelerations (s, n) of the stages, None if simplified iterations do not converge."""
        if self._factors is not None and abs(self._factors.step - h) > 1e-9 * h:
            self._factors = None
        if self._factors is not None:
            found = self._with_factors(motion, begin, h, start.copy(), self._factors)
            if found is not None:
                return found
        factors = self._factors = self._factored(motion, begin, h, start)
        return None if factors is None else self._with_factors(motion, begin, h, start.copy(), factors)

    def _with_factors(
        self, motion: EquationsOfMotion, begin: State, h: float, a: np.ndarray, factors: _Factors
    ) -> np.ndarray | None:
        free, times, before, factor = motion.free, begin.at + h * self._rule.nodes, np.inf, np.inf
        for _ in range(_ITERATIONS):
            p, v = self._stages(begin, h, a)
            residuals = np.array([motion.residual(*state) for state in zip(p, v, a, times.tolist(), strict=True)])
            change = -self._solve(factors, residuals)
            motion.counted[0] += 1
            a[:, free] += change
            size = h * h * float(np.max(np.abs(self._squared @ change) / motion.scale))
            factor = size / before if before < np.inf else factor
            if not np.isfinite(size) or (factor > _SLOW and factor < np.inf and size > _NOISE):
                return None
            if size == 0.0 or factor * size <= _TOLERANCE * (1.0 - factor) or (size <= _NOISE and factor > _SLOW):
                if factor > _KEPT:
                    self._factors = None
                return a
            before = size
        return None

    def _solve(self, factors: _Factors, right: np.ndarray) -> np.ndarray:
        """Return the solution (s, unknown) of the stages together, by that of each eigenvalue."""
        rule = self._rule
        transformed, solved = rule.inverse @ right, np.zeros(right.shape, dtype=complex)
        for number, value in enumerate(rule.values):
            if number in factors.solvers:
                solved[number] = factors.solvers[number](transformed[number])
            else:
                pair = int(np.argmin(np.abs(rule.values - value.conjugate())))
                solved[number] = factors.solvers[pair](transformed[pair]).conjugate()
        return np.asarray((rule.vectors @ solved).real)

    def _factored(self, motion: EquationsOfMotion, begin: State, h: float, a: np.ndarray) -> _Factors | None:
        """Return the factors at the middle stage, None if one is singular."""
        middle = len(a) // 2
        p, v = self._stages(begin, h, a)
        state = p[middle], v[middle], a[middle], begin.at + h * float(self._rule.nodes[middle])
        solvers = {}
        try:
            combined = _matrices(motion, *state)
            for number, value in enumerate(self._rule.values):
                if value.imag > -1e-12:
                    weight = h * (value.real if abs(value.imag) < 1e-12 else value)
                    solvers[number] = combined(weight)
        except (LinAlgError, ValueError):
            return None
        return _Factors(h, solvers)


def _matrices(
    motion: EquationsOfMotion, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float
) -> Callable[[complex], Solve]:
    """Return a function of z that factors M + z C + z^2 K, the tangents in a state."""
    system, elapsed = motion.system, time - motion.begin

    def tangent(weights: tuple[float, float, float]) -> Tangent:
        return linearise(system, p, v, a, time, weights, dt=elapsed, moving=True)[1]

    if system.unknowns.pattern is None and not system.unknowns.border_size and not len(system.rotated[0]):
        parts = [tangent(weights) for weights in (STATICS, _RATES, INERTIA)]
        if all(isinstance(part, BandTangent) for part in parts) and not system.driven:
            rows = [part.rows for part in parts if isinstance(part, BandTangent)]
            return lambda z: _band_solver(rows[2] + z * rows[1] + z * z * rows[0])
    stiffness, damping, mass = (motion.tangent(p, v, a, time, weights) for weights in (STATICS, _RATES, INERTIA))
    return lambda z: motion.solver(mass + z * damping + z * z * stiffness)


def _band_solver(rows: np.ndarray) -> Solve:
    """Return the solver of a real or complex band matrix (n, 2 w + 1)."""
    half = rows.shape[1] // 2
    factor, solve = get_lapack_funcs(("gbtrf", "gbtrs"), (rows,))
    padded = np.zeros((3 * half + 1, len(rows)), dtype=rows.dtype)
    padded[half:] = diagonals(rows)
    factors, pivots, info = factor(padded, half, half, overwrite_ab=True)
    if info != 0:
        raise LinAlgError("the tangent of a step is singular")
    real = not np.iscomplexobj(rows)
    return lambda right: np.asarray(solve(factors, half, half, right.real if real else right, pivots)[0])


def _solved_together(motion: EquationsOfMotion, begin: State, h: float, rule: Rule, start: np.ndarray) -> np.ndarray:
    """Return the accelerations (s, n) of the stages by Newton's method on all of them. Raises ConvergenceError."""
    a, free, stages = start.copy(), motion.free, range(len(rule.nodes))
    of_p, of_v, times = h * h * rule.coefficients @ rule.coefficients, h * rule.coefficients, begin.at + h * rule.nodes

    def linearised() -> tuple[np.ndarray, list[list[csr_array]]]:
        p, v = begin.p + np.outer(h * rule.nodes, begin.v) + of_p @ a, begin.v + of_v @ a
        states = list(zip(p, v, a, times.tolist(), strict=True))
        left = np.array([motion.residual(*state) for state in states])
        weights = [[(float(of_p[i, j]), float(of_v[i, j]), float(i == j)) for j in stages] for i in stages]
        return left, [[motion.tangent(*states[i], weights[i][j]) for j in stages] for i in stages]

    def move(change: np.ndarray) -> np.ndarray:
        a[:, free] += change
        return of_p @ change

    motion.iterate(linearised, move, 1e-11)
    return a
