"""Static equilibrium under loads that grow with a load factor from 0 to 1."""

import warnings

import numpy as np

from beamfem.analysis.equations import MIXED, residual
from beamfem.analysis.free_motion import require_support
from beamfem.analysis.newton import Ended, Newton, NewtonResult, solve_equilibrium
from beamfem.analysis.round_off import FEW_DIGITS, row_floors
from beamfem.compiled import tell_of_compilation
from beamfem.errors import ConvergenceError
from beamfem.model.model import Model
from beamfem.model.system import System, system_of
from beamfem.progress import progress
from beamfem.solution import Solution, Statistics
from beamfem.validation import count

_SMALLEST_STEP = 1e-6
_EASY_ITERATIONS = 8
_STABILITY_STEP = 1.0 / 64.0  # of the load; larger steps must not lose stability
_AT_REST = "nothing acts at load factor 0"
_LARGEST_TURN = 1.0  # [rad] of a prescribed rotation in one load step


def solve_static(model: Model, steps: int = 1, newton: Newton | None = None) -> Solution:
    """Return the equilibria from load factor 0 to 1; steps are cut and grown as the iterations need.

    steps: load steps to start with. Rows of the result: load factor 0 (loads with scale=False), ..., 1.
    Raises FreeMotionError before, ConvergenceError (with the states found) where it cannot go on.
    """
    count("steps", steps)
    system = system_of(model, static=True)
    tell_of_compilation()
    require_support(system)
    newton = newton or Newton()
    done = _Record(model)
    first = first_equilibrium(system, newton)
    done.iterations += first.iterations
    if not first.ended.good:
        done.add(0.0, system.reference)
        raise ConvergenceError(
            f"no equilibrium under the loads that do not scale: {first.ended.value}", done.solution()
        )
    done.add(0.0, first.state)
    done.ended, done.digits = first.ended, first.digits
    done.unstable = first.negative_pivots if system.symmetric else 0
    reached, step = 0.0, 1.0 / steps
    with progress("load factor", 1.0) as report:
        while reached < 1.0:
            target = 1.0 if reached + step > 1.0 - 1e-12 else reached + step
            while system.largest_turn(reached, target) > _LARGEST_TURN:
                step *= 0.5
                target = reached + step
            result = solve_equilibrium(system, done.states[-1], target, newton)
            done.iterations += result.iterations
            # one large step may land on another equilibrium; small steps that lose stability have met a real loss
            jumped = system.symmetric and result.negative_pivots > done.unstable and step > _STABILITY_STEP
            if result.ended.good and not jumped:
                reached = target
                done.add(reached, result.state)
                done.ended, done.digits = result.ended, result.digits
                done.unstable = result.negative_pivots if system.symmetric else 0
                report(reached)
                if result.iterations <= _EASY_ITERATIONS:
                    step *= 2.0
                continue
            done.cuts += 1
            step *= 0.5
            # what round-off takes of a load it takes of a smaller one as well
            if step < _SMALLEST_STEP or result.ended is Ended.LOST:
                raise ConvergenceError(
                    f"no equilibrium found beyond load factor {reached:.6g}: {result.ended.value}, "
                    f"with load steps down to {step:.0e}. {_reason(system, result)}",
                    done.solution(),
                )
    if done.lost_digits:
        warnings.warn(f"solve_static: {done.solution().statistics.ended}", stacklevel=2)
    return done.solution()


def _reason(system: System, result: NewtonResult) -> str:
    """Say what may keep a solve from going on."""
    if result.ended is Ended.LOST:
        return "Stiffnesses closer to each other, or larger loads, would leave some"
    if MIXED in system.proven:
        return "The stiffnesses of this model are so far apart that its tangent loses digits; bring them closer"
    return "A limit point or a bifurcation may lie here"


def first_equilibrium(system: System, newton: Newton) -> NewtonResult:
    """Return the equilibrium at load factor 0, under the loads that do not scale."""
    return _unloaded(system) or solve_equilibrium(system, system.reference, 0.0, newton)


def _unloaded(system: System) -> NewtonResult | None:
    """Return the reference as the equilibrium at load factor 0 where nothing acts yet, else None."""
    p = system.reference
    if _AT_REST not in system.proven:
        rest = np.zeros(p.shape)
        balanced = np.all(np.abs(residual(system, p, rest, rest, 0.0)) <= row_floors(system, p))
        if not balanced or not np.array_equal(system.held_values(0.0), p[system.held_dofs]):
            return None
        system.proven.add(_AT_REST)
    return NewtonResult(p, 0, Ended.CONVERGED)


class _Record:
    """What has been found so far."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.load_factors: list[float] = []
        self.states: list[np.ndarray] = []
        self.iterations = 0
        self.cuts = 0
        self.ended = Ended.CONVERGED
        self.digits = np.nan
        self.unstable = 0

    def add(self, load_factor: float, state: np.ndarray) -> None:
        self.load_factors.append(load_factor)
        self.states.append(state)

    @property
    def lost_digits(self) -> str:
        """What to say where round-off leaves few digits."""
        return f"; round-off leaves {self.digits:.0f} digits of the forces" if self.digits < FEW_DIGITS else ""

    def solution(self) -> Solution:
        states = np.array(self.states)
        ended = self.ended.value
        if self.unstable:
            ended += f"; the equilibrium is unstable, {self.unstable} eigenvalues of its tangent are negative"
        ended += self.lost_digits
        statistics = Statistics(self.iterations, len(self.states) - 1, self.cuts, ended, self.digits)
        return Solution(
            self.model,
            True,
            np.array(self.load_factors),
            states,
            np.zeros(states.shape),  # unlike zeros_like, no memory until somebody writes to it
            np.zeros(states.shape),
            statistics,
        )
