"""Jumps of loads and prescribed motions in a static solve, crossed by load steps at the same load factor."""

from collections.abc import Callable
from copy import copy

from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, LimitPointError
from beamfem.model.load_base import CompositeLoad, Load, MovingLoad, factor
from beamfem.model.model import Model
from beamfem.model.supports import DIRECTIONS, PointSupport, Value
from beamfem.parts.prescribed import Prescribed
from beamfem.parts.roller import Roller
from beamfem.parts.spring import Spring
from beamfem.solve.newton.newton import Newton, Termination, solve_equilibrium
from beamfem.solve.statics.load_steps import Snap, reach, require_no_jump_of_rotations
from beamfem.solve.statics.static_record import StaticRecord
from beamfem.validation import function_value


def _between(first: float, last: float) -> Callable[[float], float]:
    """Return a function that is linear in the load factor, with its values at 0 and 1."""
    return lambda load_factor: (1.0 - load_factor) * first + load_factor * last


def changing(model: Model, before: float | None, after: float) -> Model:
    """Return the model with loads and prescribed values linear in the load factor, those at `after` reached at 1.

    At 0 they are those at the load factor `before`, or zero for None.
    """
    loads = [_changing_load(load, before, after) for load in model.loads]
    moved = {
        id(support): _moved(support, before, after)
        for support in model.point_supports
        if any(callable(value) or value != 0.0 for value in support.prescribed().values())
    }
    supports = [part for support in model.supports for part in moved.get(id(support), (support,))]
    return model.with_(supports=supports, loads=loads)


def _moved(support: PointSupport, before: float | None, after: float) -> tuple[PointSupport, ...]:
    """Return equivalent supports with prescribed values linear in the load factor."""
    values = {name: _line(value, before, after) for name, value in support.prescribed().items() if name != "normal"}
    supports: tuple[PointSupport, ...] = (Prescribed(support.point, **values),)
    if support.direction is not None:
        supports = (*supports, Roller(support.point, tuple(support.direction)))
    if springs := support.springs():
        kx, ky, rotational = (springs.get(name, 0.0) for name in DIRECTIONS)
        supports = (*supports, Spring(support.point, (kx, ky), rotational))
    return supports


def _line(value: Value, before: float | None, after: float) -> Callable[[float], float]:
    def at(load_factor: float) -> float:
        return function_value("motion prescribed", value, load_factor) if callable(value) else value * load_factor

    return _between(0.0 if before is None else at(before), at(after))


def _changing_load(load: Load, before: float | None, after: float) -> Load:
    """Return a load whose factor, or whose values, are linear in the load factor."""
    if isinstance(load, CompositeLoad):
        return load.changed(lambda value: _line(value, before, after))
    result: Load = copy(load)
    if isinstance(load, MovingLoad):
        result = load.moved(_line(load.place_at, before, after))
    line = _between(0.0 if before is None else factor(load, before, True), factor(load, after, True))
    # whether or not it is a field of its class
    object.__setattr__(result, "amplitude", line)
    return result


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
