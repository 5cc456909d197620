"""The equilibrium at load factor 0, under unscaled loads and prescribed values."""

from copy import copy

import numpy as np

from beamfem.assembly.equations import residual
from beamfem.assembly.round_off import row_floors
from beamfem.assembly.system import System, system_of
from beamfem.errors import ConvergenceError, LimitPointError
from beamfem.model.load import Load, factor
from beamfem.model.model import Model
from beamfem.model.support import DIRECTIONS, PointSupport
from beamfem.model.supports import Prescribed, Roller, Spring
from beamfem.solve.newton.iteration import Newton, NewtonResult, Termination
from beamfem.solve.newton.newton import solve_equilibrium
from beamfem.solve.start.mechanisms import free_motion
from beamfem.solve.statics.load_steps import reach
from beamfem.solve.statics.prestressed import stiffened_start
from beamfem.solve.statics.static_record import StaticRecord
from beamfem.validation import function_value

_AT_REST = "nothing acts at load factor 0"


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
    if _AT_REST not in system.proven:
        # a load below the round-off of stiff rows may still bend the beam
        moved = system.moved and system.prescribed_changes(0.0).any()
        acts = not system.proportional and system.loads_at(0.0).any
        if moved or acts or not _free_of_force(system):
            return False
        system.proven.add(_AT_REST)
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
    growing = system_of(_growing(system.model), static=True)
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


def _growing(model: Model) -> Model:
    """Return the model with loads and prescribed values proportional to the load factor, those at 0 reached at 1."""
    loads = [_in_proportion(load) for load in model.loads]
    moved = {id(support): _in_step(support) for support in model.point_supports if _moves(support)}
    supports = [part for support in model.supports for part in moved.get(id(support), (support,))]
    return model.with_(supports=supports, loads=loads)


def _moves(support: PointSupport) -> bool:
    """Return whether a support prescribes nonzero values."""
    return any(callable(value) or value != 0.0 for value in support.prescribed().values())


def _in_step(support: PointSupport) -> tuple[PointSupport, ...]:
    """Return equivalent supports with the values at load factor 0 in proportion to the load factor."""
    values = {
        name: function_value("motion prescribed", value, 0.0) if callable(value) else 0.0
        for name, value in support.prescribed().items()
        if name != "normal"
    }
    supports: tuple[PointSupport, ...] = (Prescribed(support.point, **values),)
    if support.direction is not None:
        supports = (*supports, Roller(support.point, tuple(support.direction)))
    if springs := support.springs():
        kx, ky, rotational = (springs.get(name, 0.0) for name in DIRECTIONS)
        supports = (*supports, Spring(support.point, (kx, ky), rotational))
    return supports


def _in_proportion(load: Load) -> Load:
    """Return a load whose factor is proportional to the load factor, with its value at load factor 0 reached at 1."""
    weight = factor(load, 0.0, True)
    result: Load = copy(load)
    # whether or not it is a field of its class
    object.__setattr__(result, "amplitude", lambda load_factor: weight * load_factor)
    return result
