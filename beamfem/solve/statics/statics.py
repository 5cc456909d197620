"""Static equilibrium under loads that grow with a load factor from 0 to 1."""

from collections.abc import Sequence

from scipy.linalg import LinAlgError

from beamfem.assembly.compiled import tell_of_compilation
from beamfem.assembly.system import system_of
from beamfem.errors import ConvergenceError
from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.solve.newton.iteration import Newton, require_newton
from beamfem.solve.start.interrupted import kept
from beamfem.solve.start.mechanisms import require_support
from beamfem.solve.start.multipliers import require_independent
from beamfem.solve.statics.load_steps import Snap, reach
from beamfem.solve.statics.preload import first_equilibrium
from beamfem.solve.statics.static_record import StaticRecord
from beamfem.validation import count, one_of

_NEWTON = Newton()


def solve_static(model: Model, steps: int = 1, newton: Newton | None = None, *, snap: Snap = "error") -> Solution:
    """Return the equilibria from load factor 0 to 1 along the path that starts at 0.

    A load step is accepted where the iterates keep the count of negative pivots; else the path is followed by its
    length. At a bifurcation it goes on along the primary path, and a warning tells of unstable rows.
    steps: load steps to start with, grown and cut as needed. Rows of the result: load factor 0 (loads with
    scale=False), ..., 1. snap: what to do at a limit point, "error", or "jump" to the state in which a slow, damped
    structure comes to rest under the same load, and go on from there.
    Raises InputError and FreeMotionError before; LimitPointError with its load factor, and ConvergenceError where it
    cannot go on, both with the states found. Any other exception on the way, such as KeyboardInterrupt, gets them as
    its `solution` as well.
    """
    return solve_through(model, (), steps, newton, snap=snap)


def solve_through(
    model: Model, stops: Sequence[float], steps: int = 1, newton: Newton | None = None, *, snap: Snap = "error"
) -> Solution:
    """Return the same with rows at load factors `stops` in between."""
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
            reach(system, done, 1.0 / steps, newton, snap, stops)
        except LinAlgError as error:
            raise ConvergenceError(f"beyond load factor {done.reached:.6g}: {error}", done.solution()) from error
    return done.solution(complete=True)
