"""Continuation of a static solve whose path loses stability: rest beyond a limit point, or a stable branch."""

import numpy as np

from beamfem.equations.equations import INERTIA, linearise, residual_at_rest
from beamfem.equations.system import System
from beamfem.errors import LimitPointError
from beamfem.linalg.tangent import UNROTATED
from beamfem.solve.newton.newton import (
    Correction,
    Newton,
    NewtonResult,
    SingleCorrections,
    Termination,
    iterate,
    largest_change,
    solve_equilibrium,
)
from beamfem.solve.statics.load_path import LOCATED, BifurcatesError
from beamfem.solve.statics.static_record import StaticRecord

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
    aside *= min(1.0, min(_LARGEST_MOVE, 0.5 * farthest) / largest_change(system, aside))
    p = limit[:-1] + aside
    p[system.prescribed_dofs] = system.prescribed_values(load_factor)
    mass = _mass(system, p, load_factor)
    pull = abs(float(aside[free] @ residual_at_rest(system, p, load_factor)[free]))
    time = float(aside[free] @ (mass @ aside[free])) / max(pull, np.finfo(float).tiny)
    iterations = waits = wait = 0
    shortest = _SHORTEST * time
    for _ in range(_STEPS):
        if time < shortest:
            break
        moved, used = _step(system, p, load_factor, time)
        iterations += used
        size = np.inf if moved is None else largest_change(system, moved - p)
        if moved is None or size > _LARGEST_MOVE:
            time *= 0.5
            continue
        p = moved
        if largest_change(system, p - limit[:-1]) > farthest:
            break
        time *= 2.0
        waits += 1
        if size < _NEAR and waits > wait:
            waits, wait = 0, 2 * wait + 1  # Newton's method costs several steps: if it fails, the next attempt waits
            result = solve_equilibrium(system, p, load_factor, newton, keep=0)
            iterations += result.iterations
            near = largest_change(system, result.state - p) < _LARGEST_MOVE
            near &= largest_change(system, result.state - limit[:-1]) <= farthest
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
        self.system, self.before, self.state, self.load_factor, self.time = system, p, p.copy(), load_factor, time
        self.mass = _mass(system, p, load_factor)

    def take(self) -> tuple[float, int]:
        system, p, free, zeros = self.system, self.state, self.system.free_dofs, np.zeros(len(self.state))
        unbalanced, tangent = linearise(system, p, zeros, zeros, self.load_factor, (1.0, 0.0, 1.0 / self.time))
        factors = tangent.factorised(system.rotated)
        change = factors.solve(-unbalanced[free] - self.mass @ (p - self.before)[free] / self.time)
        p[free] += change
        return float(np.max(np.abs(change) / system.scale[free])), factors.negative_pivots

    def check(self, correction: Correction) -> Termination | None:
        if correction.diverges:
            return Termination.DIVERGED
        unstable = self.system.symmetric and correction.negative_pivots > 0
        moved = largest_change(self.system, self.state - self.before)
        small = correction.size <= _CLOSE + (1e-3 * moved if correction.number > 1 else 0.0)
        if unstable and (small or correction.number == 1):
            return Termination.LOST
        return Termination.CONVERGED if small else None


def _mass(system: System, p: np.ndarray, load_factor: float) -> np.ndarray:
    zeros = np.zeros(len(p))
    return linearise(system, p, zeros, zeros, load_factor, INERTIA)[1].sparse(UNROTATED)


BESIDE = 1e-4  # of the load factor of a critical point, which is located to about 1e-8
_ASIDE = 1e-3  # lengths of the model, radians: push along the modes
_RATIO = 0.6  # of the pushes along modes that become soft at once, so that none of their symmetries remains


def leave(system: System, done: StaticRecord, at: BifurcatesError, end: float, newton: Newton) -> None:
    """Add a row at a bifurcation, and the stable equilibrium just beyond it to which its modes lead.

    The record describes that state by the node that moves farthest.

    end: the largest load factor allowed. Raises LimitPointError.
    """
    load_factor = float(at.y[-1])
    end = min([end, *(row[0] for row in done.rows if row[0] > (1.0 + LOCATED) * load_factor)])  # computed again
    done.rows[:] = [row for row in done.rows if row[0] <= (1.0 + LOCATED) * load_factor]
    if done.reached < (1.0 - LOCATED) * load_factor:
        done.add(load_factor, at.y[:-1], 0, Termination.CONVERGED)
    else:  # the last row is the bifurcation, whose pivots have any sign
        load_factor = done.reached
        done.rows[-1] = load_factor, done.state, 0
    start = np.append(at.y[:-1], min((1.0 + BESIDE) * load_factor, end))
    way = _RATIO ** np.arange(len(at.modes)) @ at.modes
    way *= _ASIDE / largest_change(system, way[:-1])
    result = rest_state(system, start, start + way, newton)
    done.iterations += result.iterations
    if not result.ended.good:
        raise LimitPointError(f"{at}, and no state of rest was found beyond it", load_factor, done.solution())
    done.add(float(start[-1]), result.state, 0, result.ended, result.digits)
    change = result.state - start[:-1]
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    x, y = nodes[np.argmax(np.hypot(*change[nodes].T))]
    place, moved = (f"({a[x]:.4g}, {a[y]:.4g})" for a in (system.reference, change))
    unit = system.model.unit("m")
    done.left.append(
        f"{at}, which it leaves for the stable state in which the node at {place} {unit} is displaced by a further "
        f"{moved} {unit}"
    )
