"""State of rest of a structure that snaps at a limit point under constant load.

Slow loading and damping: the motion is overdamped, M q' = -r(q), in implicit Euler steps that grow as it comes to rest.
Under loads of constant direction the potential energy decreases in every step, so the motion ends in a stable
equilibrium, as long as no step leaves its potential well: M / dt + K must be positive definite in every step.
"""

import numpy as np

from beamfem.assembly.equations import INERTIA, linearise, residual
from beamfem.assembly.system import System
from beamfem.linalg.tangent import UNROTATED
from beamfem.solve.newton.convergence import Correction
from beamfem.solve.newton.iteration import Newton, NewtonResult, Termination
from beamfem.solve.newton.iteration_loop import SingleCorrections, iterate
from beamfem.solve.newton.newton import solve_equilibrium

_STEPS = 2000
_ITERATIONS = 8  # of Newton's method in a step
_SHORTEST = 1e-9  # of the first step, which moves far: shorter ones are given up
_LARGEST_MOVE = 0.1  # in a step: lengths of the model, radians
_NEAR = 1e-3  # a step that moves less than this, however long, is close to rest
_CLOSE = 1e-9  # of the movement: size of the last correction of a step
_SAME_LOAD = 1e-6  # limit points are located to about 1e-8
# of the model, or of a gradient: states at load factors 1e-6 apart differ by the square root near a limit point
_SAME_PLACE = 1e-3


def rest_state(
    system: System, limit: np.ndarray, beyond: np.ndarray, newton: Newton, farthest: float = np.inf
) -> NewtonResult:
    """Return the equilibrium to which the structure snaps at the load of a limit point (n + 1,).

    beyond (n + 1,): a point of the path after the limit point, on the side of departure; farthest: search distance from
    the limit point, in sizes of the model.
    """
    load_factor, free = float(limit[-1]), system.free_dofs
    aside = np.zeros(len(limit) - 1)
    aside[free] = (beyond - limit)[:-1][free]
    aside *= min(1.0, min(_LARGEST_MOVE, 0.5 * farthest) / _size(system, aside))
    p = limit[:-1] + aside
    p[system.prescribed_dofs] = system.prescribed_values(load_factor)
    mass = _mass(system, p, load_factor)
    pull = abs(float(aside[free] @ _unbalanced(system, p, load_factor)[free]))
    time = float(aside[free] @ (mass @ aside[free])) / max(pull, np.finfo(float).tiny)
    iterations = waits = wait = 0
    shortest = _SHORTEST * time
    for _ in range(_STEPS):
        if time < shortest:
            break
        moved, used = _step(system, p, load_factor, time)
        iterations += used
        size = np.inf if moved is None else _size(system, moved - p)
        if moved is None or size > _LARGEST_MOVE:
            time *= 0.5
            continue
        p = moved
        if _size(system, p - limit[:-1]) > farthest:
            break
        time *= 2.0
        waits += 1
        if size < _NEAR and waits > wait:
            waits, wait = 0, 2 * wait + 1  # Newton's method costs several steps: if it fails, the next attempt waits
            result = solve_equilibrium(system, p, load_factor, newton, keep=0)
            iterations += result.iterations
            near = _size(system, result.state - p) < _LARGEST_MOVE
            near &= _size(system, result.state - limit[:-1]) <= farthest
            if result.ended.good and result.negative_pivots == 0 and near:
                return NewtonResult(result.state, iterations, result.ended)
    return NewtonResult(p, iterations, Termination.EXHAUSTED)


def same_point(system: System, one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two limit points (n + 1,) are equal except for full turns, which follower loads may add.

    Slow loading never lowers the load factor, so a limit point met again at the same load factor closes a cycle.
    """
    if abs(one[-1] - other[-1]) > _SAME_LOAD * abs(one[-1]):
        return False
    nodes = [system.assembler().nodal_vectors(np.ascontiguousarray(y[:-1])) for y in (one, other)]
    changes = [np.abs(a - b) for a, b in zip(*nodes, strict=True)]
    positions = max(float(change[:, :2].max()) for change in changes) / system.extent
    return max(positions, *(float(change[:, 2:].max()) for change in changes)) < _SAME_PLACE


def _step(system: System, p: np.ndarray, load_factor: float, time: float) -> tuple[np.ndarray | None, int]:
    """Return the state after an implicit Euler step, None if Newton's method fails; and the iterations."""
    step = _EulerStep(system, p, load_factor, time)
    stepped = iterate(step, _ITERATIONS)
    return step.state if stepped.ended.good else None, stepped.iterations


class _EulerStep(SingleCorrections):
    """An implicit Euler step from a state p (n,).

    It fails if it is so long that several states are possible at its end, some in other potential wells.
    """

    def __init__(self, system: System, p: np.ndarray, load_factor: float, time: float) -> None:
        super().__init__()
        self.system, self.before, self.state, self.load_factor, self.time = system, p, p.copy(), load_factor, time
        self.mass = _mass(system, p, load_factor)

    def take(self) -> tuple[float, int]:
        """Take the next correction, see `SingleCorrections`. Raises LinAlgError."""
        system, p, free, zeros = self.system, self.state, self.system.free_dofs, np.zeros(len(self.state))
        unbalanced, tangent = linearise(system, p, zeros, zeros, self.load_factor, (1.0, 0.0, 1.0 / self.time))
        factors = tangent.factorised(system.rotated)
        change = factors.solve(-unbalanced[free] - self.mass @ (p - self.before)[free] / self.time)
        p[free] += change
        return float(np.max(np.abs(change) / system.scale[free])), factors.negative_pivots

    def check(self, correction: Correction) -> Termination | None:
        """See `loop.Problem`."""
        if correction.diverges:
            return Termination.DIVERGED
        unstable = self.system.symmetric and correction.negative_pivots > 0
        moved = _size(self.system, self.state - self.before)
        small = correction.size <= _CLOSE + (1e-3 * moved if correction.number > 1 else 0.0)
        if unstable and (small or correction.number == 1):
            return Termination.LOST
        return Termination.CONVERGED if small else None


def _mass(system: System, p: np.ndarray, load_factor: float) -> np.ndarray:
    zeros = np.zeros(len(p))
    return linearise(system, p, zeros, zeros, load_factor, INERTIA)[1].sparse(UNROTATED)


def _unbalanced(system: System, p: np.ndarray, load_factor: float) -> np.ndarray:
    zeros = np.zeros(len(p))
    return residual(system, p, zeros, zeros, load_factor)


def _size(system: System, change: np.ndarray) -> float:
    return float(np.max(np.abs(change) / system.scale))
