"""Static equilibrium under loads that grow with a load factor from 0 to 1, and the one at load factor 0."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import block_array, csc_array
from scipy.sparse.linalg import splu

from beamfem.equations.compilation_notice import announce_compilation
from beamfem.equations.connector_traits import lets_go
from beamfem.equations.equations import linearise_at_rest, residual_at_rest
from beamfem.equations.system import Proven, System, system_of
from beamfem.errors import ConvergenceError, InputError, LimitPointError
from beamfem.linalg.tangent import UNROTATED
from beamfem.model.model import Model
from beamfem.precision.roundoff import largest_force, row_floors
from beamfem.progress import kept
from beamfem.results.full_turns import start_rotations
from beamfem.results.solution import Solution
from beamfem.results.solution_checks import warned
from beamfem.solve.accuracy.adapted_mesh import prepared, refined_statically
from beamfem.solve.accuracy.coarse_mesh import warned_of_coarse_mesh
from beamfem.solve.accuracy.quantity_change import Quantity
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes
from beamfem.solve.newton.newton import (
    Newton,
    NewtonResult,
    Termination,
    largest_change,
    require_newton,
    solve_equilibrium,
)
from beamfem.solve.start.functions_of_time import SAME as NEAR
from beamfem.solve.start.functions_of_time import (
    functions_of_time,
    jumps_between,
    kinks_and_turning_points,
    warn_between_rows,
)
from beamfem.solve.start.mechanisms import (
    Conditions,
    FreeMotion,
    free_motion,
    mechanisms,
    no_equilibrium_at_start,
    require_independent,
    require_support,
)
from beamfem.solve.start.start_checks import refuse_memory
from beamfem.solve.statics.load_jumps import changing, cross_jump
from beamfem.solve.statics.load_steps import SAME, Snap, Unstable, reach
from beamfem.solve.statics.static_record import StaticRecord, is_unstable
from beamfem.validation import count, finite, items, one_of, shown

_NEWTON = Newton()
_SIDE = 1e-9  # of the load factor: distance from a row at which a function with declared kinks is evaluated


def solve_static(
    model: Model,
    steps: int = 1,
    newton: Newton | None = None,
    *,
    at: Sequence[float] | np.ndarray | None = None,
    snap: Snap = "error",
    unstable: Unstable = "keep",
    accuracy: float | None = None,
    quantity: Quantity = None,
) -> Solution:
    """Find the static equilibria from load factor 0 to 1, along the path that starts at 0.

    A load step is accepted if the number of negative pivots of the tangent stays the same over its iterations;
    otherwise the path is followed by arc length. At a bifurcation the primary path is continued, and a warning reports
    unstable rows, unless jumps are allowed or unstable paths are left.

    Parameters
    ----------
    model : Model
        Beams, supports and loads.
    steps : int, default 1
        Number of equal load steps, each of which ends in a row. They are cut as needed, which gives more rows.
    newton : Newton, optional
        Tolerances of the iteration.
    at : sequence of float, optional
        Ascending load factors from 0 to 1 for the rows of the result, reached exactly, except those skipped by a jump;
        the last of them ends the solve. By default the rows are the accepted load steps, from load factor 0 (only the
        loads with scale=False) to 1, with rows where amplitudes and prescribed motions have kinks or turn, and on both
        sides of their jumps.
    snap : {"error", "jump"}, default "error"
        What to do at a limit point: raise an error, or jump to the state in which a slow, damped structure comes to
        rest under the same load, and continue from there. Jumps start at bifurcations, too.
    unstable : {"keep", "leave"}, default "keep"
        What to do where the path loses its stability: keep to it, or leave it for the stable branch as a slow, damped
        structure does, at limit points by a jump. There is a row at the critical point. At a symmetric bifurcation
        either side is taken; `statistics.ended` names it, and a small imperfection chooses it.
    accuracy : float, [-], optional
        Refine the mesh until the estimated error of all rows, see `Solution.error`, is at most this number times the
        size of the model, or that of the last row this number times the quantity: by higher orders, and by shorter
        elements where most of it arises. Of cubic elements 24 rows count, with history the last and that of the largest
        strain energy. The result belongs to a model with finer beams; points and beams of this model can be used with
        it.
    quantity : callable or Point, optional
        Result that `accuracy` refers to, as for `Solution.error`; by default all displacements. A list may hold several
        ones, and forces and moments of arrays (..., 3) are two. A quantity that is zero up to round-off, such as the
        moment at a free end, counts as exact.

    Raises
    ------
    InputError
        Before the solve, for invalid arguments, and for unstable="leave" and laws or connectors with history; for an
        accuracy and elements that lock.
    FreeMotionError
        If the model can move without resistance, and loads with scale=False do not stiffen it.
    LimitPointError
        At a limit point; it has the load factor and the states found.
    ConvergenceError
        If no step converges, or no mesh reaches the accuracy; its `solution` has the states found. Any other exception
        during the solve, such as KeyboardInterrupt, carries them as its `solution` too.

    Warns
    -----
    UnstableWarning
        If some rows are unstable equilibria.
    RoundOffWarning
        If round-off leaves few digits of the forces.
    LockingWarning
        If locking changes displacements by 1 % or more.
    CoarseMeshWarning
        If displacements of the last row are likely off by 2 % or more.
    LargeStrainWarning
        If strains of a linear law exceed 0.2, or the utilisation of a strength exceeds 1.

    Examples
    --------
    >>> halves = bf.solve_static(model, at=[0.0, 0.5, 1.0])
    >>> halves.displacement(beam.end)[:, 1].round(4)
    array([ 0.    , -0.0153, -0.0305])
    """
    load_factors = None if at is None else _ascending(at)

    def solve(model: Model) -> Solution:
        if load_factors is None:
            equal = [k / steps for k in range(1, count("steps", steps))]
            return solve_through(model, equal, steps, newton, snap=snap, unstable=unstable, resolved=True)
        through = solve_through(model, load_factors, steps, newton, snap=snap, unstable=unstable, end=load_factors[-1])
        return _rows_at(through, load_factors)

    by_default = accuracy is None
    model, accuracy = prepared(model, accuracy, quantity=quantity)
    if accuracy is None:
        return warned_of_coarse_mesh(warned(solve(model)))
    refined = refined_statically(model, accuracy, solve, quantity, by_default and quantity is None)
    return warned_of_coarse_mesh(warned(refined))


def _ascending(at: Sequence[float] | np.ndarray) -> list[float]:
    """Return the load factors requested by a user. Raises InputError."""
    load_factors = [finite(f"at[{i}]", value) for i, value in enumerate(items("at", at))]
    rising = all(after - before > SAME for before, after in pairwise(load_factors))
    if not load_factors or not rising or load_factors[0] < 0.0 or load_factors[-1] > 1.0:
        raise InputError(
            "at of solve_static must be ascending load factors between 0 and 1, such as [0.25, 0.5, 1.0], got "
            f"{shown(at)}"
        )
    return load_factors


def _rows_at(solution: Solution, wanted: Sequence[float]) -> Solution:
    """Return the rows at some load factors, with the rotations counted over all rows."""
    distance = np.abs(solution.at - np.array(wanted)[:, None])
    # after a jump, the last of several states at a load factor; loads may jump from one number to the next
    close = np.where(np.any(distance == 0.0, axis=1)[:, None], distance == 0.0, distance <= SAME)
    rows = np.array([np.flatnonzero(mask)[-1] for mask in close if mask.any()], dtype=int)
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
    unstable: Unstable = "keep",
    end: float = 1.0,
    resolved: bool = False,
) -> Solution:
    """Return the static solution up to the load factor `end`, with rows at the load factors `stops`.

    There are rows at kinks and turning points of functions of the load factor, too. resolved: whether to warn of
    functions that vary more between rows than at the rows.
    """
    steps = count("steps", steps)
    one_of("snap", snap, ("error", "jump"))
    one_of("unstable", unstable, ("keep", "leave"))
    system = system_of(model, static=True)
    system.forget_digits()
    if unstable == "leave":
        refuse_memory(system, 'unstable="leave"')
        snap = "jump"
    announce_compilation()
    if nothing_acts(system):
        require_support(system)
    require_independent(system, system.reference)
    newton = require_newton(newton, _NEWTON)
    record = StaticRecord(model, system.symmetric)
    first = first_equilibrium(system, newton)
    record.iterations += first.iterations
    if not first.ended.good:
        record.add(0.0, system.reference, 0, first.ended)
        raise ConvergenceError(no_equilibrium_at_start(system, first.ended.value), record.solution())
    state = system.history.in_equilibrium(first.state, 0.0)
    record.add(0.0, state, first.negative_pivots, first.ended, first.digits)
    if unstable == "leave" and is_unstable(system.symmetric, first.negative_pivots):
        raise ConvergenceError(
            'unstable="leave" starts from a stable state, but that under the loads that do not scale is unstable; '
            "let them scale",
            record.solution(),
        )
    functions = [] if system.steady else functions_of_time(system)
    with kept(record.solution):
        try:
            jumps = jumps_between(functions, 0.0, end) if functions and end > 0.0 else []
            if functions:
                kinks = kinks_and_turning_points(functions, 0.0, end)
                stops = [*stops, *(at for at in kinks if all(abs(at - jump.after) > NEAR for jump in jumps))]
            for jump in jumps:
                if jump.before > record.reached:
                    reach(system, record, 1.0 / steps, newton, snap, stops, jump.before)
                cross_jump(system, record, jump.after, newton, snap)
            reach(system, record, 1.0 / steps, newton, snap, stops, end)
        except LinAlgError as error:
            raise ConvergenceError(f"beyond load factor {record.reached:.6g}: {error}", record.solution()) from error
    solution = record.solution(complete=True)
    if resolved and functions:
        found = warn_between_rows(functions, np.unique([at for at, *_ in record.rows]), _SIDE)
        return solution.with_statistics(warnings=(*solution.statistics.warnings, *found))
    return solution


Motions = Callable[[np.ndarray], np.ndarray]

_ITERATIONS = 30
_SMALL = 1e-9  # of the size of the model: last correction of the state in which the motions are prevented
_FIRST_WIDTH = 1e-9  # of the size of the model, or rad: first step towards parts that hold one way only
_TOO_LATE = 0.9  # of the force along a step: force against it at its end
_FARTHEST = 1.0  # of the size of the model, or rad: motion that the loads cause
_NEGLIGIBLE = 1e-8  # of the largest force times the size of the model: stiffness of a motion


def stiffened_start(system: System, free: FreeMotion) -> np.ndarray:
    """Return a state p (n,) in which the loads at load factor 0 make all free motions stiff.

    It is the equilibrium with these motions prevented; phi^T K phi of the tangent K in it must be positive definite for
    the motions phi, and move them little. Raises the FreeMotionError of the motions otherwise.
    """
    holding = [item for item in system.connectors.items if not lets_go(item)]
    lasting = system
    if len(holding) < len(system.connectors.items):
        given = [item.given for item in holding]
        lasting = system_of(system.model.with_(connectors=given), static=True)

    def motions(p: np.ndarray) -> np.ndarray:
        """Return the motions (m, n) from a state p (n,) that are free where parts that hold one way only are open."""
        rows = Conditions(lasting, free.conditions.body, p)
        return np.array([rows.rates(p, motion) for motion in mechanisms(rows)])

    p = None if system.inclined else _prevented(system, system.reference, motions)
    if p is None:
        raise free.error
    p = p if lasting is system else _closed(system, p, motions)
    moved = motions(p)
    moved[:, system.prescribed_dofs] = 0.0
    moved /= np.abs(moved / system.scale).max(axis=1)[:, None]
    stiffness = stiffness_of_modes(system, p, 0.0, moved)
    if not np.linalg.eigvalsh(stiffness)[0] > _NEGLIGIBLE * largest_force(system, p, 0.0):
        raise free.error
    # a bar on a pin that has to turn by more than 1 rad to hang is not held by its weight where it is drawn
    if np.max(np.abs(np.linalg.solve(stiffness, moved @ residual_at_rest(system, p, 0.0)))) > _FARTHEST:
        raise free.error
    return p


def _closed(system: System, p: np.ndarray, motions: Motions) -> np.ndarray:
    """Return a state (n,) into which the loads at load factor 0 move free motions until something stops them.

    Parts that hold one way only are closed by them. Steps double while the loads move the motions, and halve where a
    part stops them too late.
    """
    width, start = _FIRST_WIDTH, p
    force = float(np.linalg.norm(motions(p) @ residual_at_rest(system, p, 0.0)))
    for _ in range(4 * _ITERATIONS):
        moved = _step(system, p, motions(p), width / force)
        after = None if moved is None else _prevented(system, p + moved, motions)  # straight steps lengthen what turns
        if moved is None or after is None:
            break
        size = float(np.max(np.abs(moved) / system.scale))
        if size <= _FIRST_WIDTH < width:
            return after
        slopes = [float(moved @ residual_at_rest(system, state, 0.0)) for state in (p, after)]
        if slopes[1] > -_TOO_LATE * slopes[0]:
            width *= 0.5
            continue
        p, width = after, width * (2.0 if size >= 0.5 * width else 1.0)
        if not width <= _FARTHEST:
            break
    return start


def _step(system: System, p: np.ndarray, rates: np.ndarray, yielding: float) -> np.ndarray | None:
    """Return a step (n,) of Newton's method in which motions (m, n) yield to forces; None if it is singular."""
    unknown, moved = system.free_dofs, np.zeros_like(p)
    along = csc_array(rates[:, unknown] / system.scale[unknown] ** 2)
    unbalanced, tangent = linearise_at_rest(system, p, 0.0)
    own = (along @ csc_array(rates[:, unknown]).T).toarray()
    corner = csc_array(-yielding * own @ own) if yielding else None
    matrix = block_array([[tangent.sparse(UNROTATED), along.T], [along, corner]], format="csc")
    try:
        moved[unknown] = splu(matrix).solve(np.append(-unbalanced[unknown], np.zeros(len(rates))))[: len(unknown)]
    except RuntimeError:  # singular
        return None
    return moved


def _prevented(system: System, p: np.ndarray, motions: Motions) -> np.ndarray | None:
    """Return the equilibrium (n,) near p at load factor 0 with its motions prevented; None if it is not found."""
    p, rates = p.copy(), motions(p)
    p[system.prescribed_dofs] = system.prescribed_values(0.0)
    for _ in range(_ITERATIONS):
        step = _step(system, p, rates, 0.0)
        if step is None:
            return None
        p += step
        size = float(np.max(np.abs(step) / system.scale, initial=0.0))
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
    moved = largest_change(system, result.state - system.reference)
    if result.ended is Termination.NO_DIGITS and moved <= np.finfo(float).eps:  # as by the tail of a pulse
        return NewtonResult(system.reference, result.iterations, Termination.CONVERGED)
    return result if result.ended.good else _grown(system, newton, result)


def nothing_acts(system: System) -> bool:
    """Return whether nothing acts at load factor 0."""
    if Proven.NOTHING_ACTS_AT_ZERO not in system.proven:
        # a load below the round-off of stiff rows may still bend the beam
        moved = system.moved and system.prescribed_changes(0.0).any()
        acts = not system.loads.proportional and system.loads.at(0.0).any
        if moved or acts:
            return False
        if system.connectors.items or any(block.law is not None for block in system.blocks):  # may have forces there
            p = system.reference
            if np.any(np.abs(residual_at_rest(system, p, 0.0)) > row_floors(system, p)):
                return False
        system.proven.add(Proven.NOTHING_ACTS_AT_ZERO)
    return True


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
