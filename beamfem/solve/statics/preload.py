"""The equilibrium at load factor 0, and mechanisms that it makes stiff, such as strings and hanging chains."""

import numpy as np
from scipy.sparse import block_array, csc_array
from scipy.sparse.linalg import splu

from beamfem.assembly.equations import STATICS, linearise, residual
from beamfem.assembly.system import Proven, System, system_of
from beamfem.errors import ConvergenceError, LimitPointError
from beamfem.linalg.tangent import UNROTATED
from beamfem.precision.roundoff import largest_force, row_floors
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes
from beamfem.solve.newton.newton import Newton, NewtonResult, Termination, solve_equilibrium
from beamfem.solve.start.mechanisms import FreeMotion, free_motion
from beamfem.solve.statics.load_jumps import changing
from beamfem.solve.statics.load_steps import reach
from beamfem.solve.statics.static_record import StaticRecord

_ITERATIONS = 30
_SMALL = 1e-9  # of the size of the model: last correction of the state in which the motions are prevented
_FARTHEST = 1.0  # of the size of the model, or rad: motion that the loads cause
_NEGLIGIBLE = 1e-8  # of the largest force times the size of the model: stiffness of a motion


def stiffened_start(system: System, free: FreeMotion) -> np.ndarray:
    """Return a state p (n,) in which the loads at load factor 0 make all free motions stiff.

    It is the equilibrium with these motions prevented; phi^T K phi of the tangent K in it must be positive definite for
    the motions phi, and move them little. Raises the FreeMotionError of the motions otherwise.
    """
    rates = np.array([free.conditions.rates(system.reference, motion) for motion in free.motions])
    p = None if system.inclined else _prevented(system, rates)
    if p is None:
        raise free.error
    moved = np.array([free.conditions.rates(p, motion) for motion in free.motions])
    moved[:, system.prescribed_dofs] = 0.0
    moved /= np.abs(moved / system.scale).max(axis=1)[:, None]
    stiffness, zeros = stiffness_of_modes(system, p, 0.0, moved), np.zeros(len(p))
    if not np.linalg.eigvalsh(stiffness)[0] > _NEGLIGIBLE * largest_force(system, p, 0.0):
        raise free.error
    # a bar on a pin that has to turn by more than 1 rad to hang is not held by its weight where it is drawn
    if np.max(np.abs(np.linalg.solve(stiffness, moved @ residual(system, p, zeros, zeros, 0.0)))) > _FARTHEST:
        raise free.error
    return p


def _prevented(system: System, rates: np.ndarray) -> np.ndarray | None:
    """Return the equilibrium (n,) at load factor 0 with motions (m, n) prevented; None if it is not found."""
    p, zeros, unknown = system.reference.copy(), np.zeros(system.model.size), system.free_dofs
    p[system.prescribed_dofs] = system.prescribed_values(0.0)
    along = csc_array(rates[:, unknown] / system.scale[unknown] ** 2)
    for _ in range(_ITERATIONS):
        unbalanced, tangent = linearise(system, p, zeros, zeros, 0.0, STATICS)
        matrix = block_array([[tangent.sparse(UNROTATED), along.T], [along, None]], format="csc")
        right = np.append(-unbalanced[unknown], np.zeros(len(rates)))
        try:
            step = splu(matrix).solve(right)[: len(unknown)]
        except RuntimeError:  # singular
            return None
        p[unknown] += step
        size = float(np.max(np.abs(step) / system.scale[unknown], initial=0.0))
        if size <= _SMALL:
            return p
        if not size <= 1.0:
            return None
    return None


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
    moved = float(np.max(np.abs(result.state - system.reference) / system.scale, initial=0.0))
    if result.ended is Termination.NO_DIGITS and moved <= np.finfo(float).eps:  # as by the tail of a pulse
        return NewtonResult(system.reference, result.iterations, Termination.CONVERGED)
    return result if result.ended.good else _grown(system, newton, result)


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
