"""Static equilibrium under loads that grow with a load factor from 0 to 1."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.compiled import tell_of_compilation
from beamfem.assembly.system import system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.keywords import keywords_checked
from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.results.turns import start_rotations
from beamfem.solve.newton.iteration import Newton, require_newton
from beamfem.solve.start.interrupted import kept
from beamfem.solve.start.mechanisms import require_support
from beamfem.solve.start.multipliers import require_independent
from beamfem.solve.statics.load_steps import SAME, Snap, reach
from beamfem.solve.statics.preload import first_equilibrium
from beamfem.solve.statics.static_record import StaticRecord
from beamfem.validation import count, finite, items, one_of, shown

_NEWTON = Newton()


@keywords_checked
def solve_static(
    model: Model,
    steps: int = 1,
    newton: Newton | None = None,
    *,
    at: Sequence[float] | None = None,
    snap: Snap = "error",
) -> Solution:
    """Return the equilibria from load factor 0 to 1 along the path that starts at 0.

    A load step is accepted if the iterates keep the number of negative pivots; otherwise the path is followed by arc
    length. At a bifurcation the primary path is continued, and a warning reports unstable rows.
    steps: initial number of load steps, which are grown and cut as needed. Rows of the result: load factor 0 (loads
    with scale=False), ..., 1. at: ascending load factors from 0 to 1 for the rows instead, reached exactly, except
    those skipped by a jump; the last of them ends the solve. snap: at a limit point raise an "error", or "jump" to the
    state in which a slow, damped structure comes to rest under the same load, and continue from there.
    Raises InputError and FreeMotionError before the solve; LimitPointError with the load factor, and ConvergenceError
    if no step converges, both with the states found. Any other exception during the solve, such as KeyboardInterrupt,
    carries them as its `solution` too.
    """
    if at is None:
        return solve_through(model, (), steps, newton, snap=snap)
    wanted = _ascending(at)
    return _rows_at(solve_through(model, wanted, steps, newton, snap=snap, end=wanted[-1]), wanted)


def _ascending(at: Sequence[float]) -> list[float]:
    """Check the load factors requested by a user."""
    wanted = [finite(f"at[{i}]", value) for i, value in enumerate(items("at", at))]
    rising = all(after - before > SAME for before, after in pairwise(wanted))
    if not wanted or not rising or wanted[0] < 0.0 or wanted[-1] > 1.0:
        raise InputError(
            "at of solve_static must be load factors that rise within 0 and 1, such as [0.25, 0.5, 1.0], got "
            f"{shown(at)}"
        )
    return wanted


def _rows_at(solution: Solution, wanted: Sequence[float]) -> Solution:
    """Return the rows at some load factors, with the rotations counted over all rows."""
    near = np.abs(solution.at - np.array(wanted)[:, None]) <= SAME
    # behind a jump the last of several states at a load factor
    rows = np.array([np.flatnonzero(own)[-1] for own in near if own.any()], dtype=int)
    stability = None if solution.stability is None else solution.stability[rows]
    states = {name: getattr(solution, name)[rows] for name in ("at", "p", "v", "a")}
    return replace(solution, **states, stability=stability, turned=start_rotations(solution)[rows])


def solve_through(
    model: Model,
    stops: Sequence[float],
    steps: int = 1,
    newton: Newton | None = None,
    *,
    snap: Snap = "error",
    end: float = 1.0,
) -> Solution:
    """Return the same with rows at load factors `stops` in between, up to the load factor `end`."""
    steps = count("steps", steps)
    one_of("snap", snap, ("error", "jump"))
    system = system_of(model, static=True)
    tell_of_compilation()
    require_support(system)
    require_independent(system, system.reference)
    newton = require_newton(newton, _NEWTON)
    done = StaticRecord(model, system.symmetric)
    first = first_equilibrium(system, newton)
    done.iterations += first.iterations
    if not first.ended.good:
        done.add(0.0, system.reference, 0, first.ended)
        raise ConvergenceError(
            f"no equilibrium under the loads that do not scale: {first.ended.value}", done.solution()
        )
    state = system.connectors.after_load_step(first.state, 0.0)
    done.add(0.0, state, first.negative_pivots, first.ended, first.digits)
    with kept(done.solution):
        try:
            reach(system, done, 1.0 / steps, newton, snap, stops, end)
        except LinAlgError as error:
            raise ConvergenceError(f"beyond load factor {done.reached:.6g}: {error}", done.solution()) from error
    return done.solution(complete=True)
