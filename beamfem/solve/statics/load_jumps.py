"""Jumps of loads and prescribed motions in a static solve, crossed by load steps at the same load factor."""

from beamfem.assembly.system import System, system_of
from beamfem.errors import ConvergenceError, LimitPointError
from beamfem.solve.newton.iteration import Newton, Termination
from beamfem.solve.newton.newton import solve_equilibrium
from beamfem.solve.statics.changing_loads import changing
from beamfem.solve.statics.load_steps import Snap, reach, require_no_jump_of_rotations
from beamfem.solve.statics.static_record import StaticRecord


def cross_jump(system: System, done: StaticRecord, after: float, newton: Newton, snap: Snap) -> None:
    """Add the row at the load factor `after`, the next number after that of the last row, up to which loads jump.

    The loads change linearly from those before the jump to those after it, in as many steps as that takes. Raises
    LimitPointError and ConvergenceError with the solution so far.
    """
    require_no_jump_of_rotations(system, done, after)
    between = system_of(changing(system.model, done.reached, after), static=True)
    steps = StaticRecord(between.model, between.symmetric)
    steps.add(0.0, done.state, done.negative_pivots, Termination.CONVERGED)
    where = f"loads or supports jump at load factor {after:.6g}; as the jump grows from 0 to 1"
    try:
        reach(between, steps, 1.0, newton, snap)
    except LimitPointError as error:
        raise LimitPointError(f"{where}: {error}", after, done.solution()) from error
    except ConvergenceError as error:
        raise ConvergenceError(f"{where}: {error}", done.solution()) from error
    finally:
        done.iterations += steps.iterations
        done.cuts += steps.cuts
    state, pivots, ended, digits = steps.state, steps.negative_pivots, steps.ended, steps.digits
    if system.connectors.items:  # their forces may depend on the load factor itself
        result = solve_equilibrium(system, state, after, newton)
        done.iterations += result.iterations
        if not result.ended.good:
            raise ConvergenceError(f"{where}, connectors have no equilibrium: {result.ended.value}", done.solution())
        state, pivots, ended, digits = result.state, result.negative_pivots, result.ended, result.digits
    done.on_the_way[len(done.rows)] = [passed for _, passed, _ in steps.rows[1:-1]]
    done.add(after, state, pivots, ended, digits)
