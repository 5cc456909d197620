"""The equilibrium at load factor 0, under unscaled loads and prescribed values."""

import numpy as np

from beamfem.assembly.equations import residual
from beamfem.assembly.system import Proven, System, system_of
from beamfem.errors import ConvergenceError, LimitPointError
from beamfem.precision.roundoff import row_floors
from beamfem.solve.newton.iteration import Newton, NewtonResult, Termination
from beamfem.solve.newton.newton import solve_equilibrium
from beamfem.solve.start.mechanisms import free_motion
from beamfem.solve.statics.changing_loads import changing
from beamfem.solve.statics.load_steps import reach
from beamfem.solve.statics.prestressed import stiffened_start
from beamfem.solve.statics.static_record import StaticRecord


def first_equilibrium(system: System, newton: Newton) -> NewtonResult:
    """Return the equilibrium at load factor 0; if it is far from the start, all loads are increased along a path.

    Raises FreeMotionError if the model is a mechanism, unless prestress or weight at load factor 0 make it stiff.
    """
    at_rest, free = nothing_acts(system), free_motion(system)
    if free is not None:
        if at_rest:
            raise free.error
        return solve_equilibrium(system, stiffened_start(system, free), 0.0, newton, keep=0)
    if at_rest:
        return NewtonResult(system.reference, 0, Termination.CONVERGED)
    result = solve_equilibrium(system, system.reference, 0.0, newton, keep=0)
    if result.ended is Termination.NO_DIGITS and _still(system, result.state):
        return NewtonResult(system.reference, result.iterations, Termination.CONVERGED)
    return result if result.ended.good else _grown(system, newton, result)


def _still(system: System, p: np.ndarray) -> bool:
    """Return whether loads move the reference by less than its last digit, as the tail of a pulse does."""
    return bool(np.max(np.abs(p - system.reference) / system.scale, initial=0.0) <= np.finfo(float).eps)


def nothing_acts(system: System) -> bool:
    """Return whether nothing acts at load factor 0."""
    if Proven.NOTHING_ACTS_AT_ZERO not in system.proven:
        # a load below the round-off of stiff rows may still bend the beam
        moved = system.moved and system.prescribed_changes(0.0).any()
        acts = not system.proportional and system.loads_at(0.0).any
        if moved or acts or not _free_of_force(system):
            return False
        system.proven.add(Proven.NOTHING_ACTS_AT_ZERO)
    return True


def _free_of_force(system: System) -> bool:
    """Return whether user-defined section laws and connectors have no stiffness in the reference."""
    if not system.connectors.items and all(block.law is None for block in system.blocks):
        return True
    p = system.reference
    zeros = np.zeros(p.shape)
    return bool(np.all(np.abs(residual(system, p, zeros, zeros, 0.0)) <= row_floors(system, p)))


def _grown(system: System, newton: Newton, failed: NewtonResult) -> NewtonResult:
    """Return the end of the path along which the loads at load factor 0 increase from zero."""
    growing = system_of(changing(system.model, None, 0.0), static=True)
    record = StaticRecord(growing.model, growing.symmetric)
    record.iterations = failed.iterations
    record.add(0.0, growing.reference, 0, Termination.CONVERGED)
    try:
        reach(growing, record, 1.0, newton, "error")
    except LimitPointError:
        return failed._replace(iterations=record.iterations, ended=Termination.LIMIT)
    except ConvergenceError:
        return failed._replace(iterations=record.iterations)
    return NewtonResult(record.state, record.iterations, record.ended, record.negative_pivots, record.digits)
