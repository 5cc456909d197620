"""Newton's method for an equilibrium at a fixed load factor."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.arena import Arena
from beamfem.assembly.equations import MIXED, STATICS, linearise, predicted_stresses, residual
from beamfem.assembly.round_off import (
    ENOUGH,
    MOST_DIGITS,
    digits_of,
    load_size,
    loses_digits,
    remainder,
    row_floors,
)
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.newton import iterate
from beamfem.linalg.tangent import SMALLEST_PIVOT
from beamfem.solve.newton.cut_chain import halves_of, worth_cutting
from beamfem.solve.newton.halves import correct, joined, negative_pivots
from beamfem.solve.newton.iteration import Ended, Newton, NewtonResult

_STAGNANT = 1e-6  # corrections below this that no longer shrink are round-off, if the residual says so too
_SURE = 1e-9  # of the movement: a correction this small changes nothing that is asked for
_LARGEST = 1e3  # of the model; larger corrections lead nowhere


def solve_equilibrium(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, keep: int | None = None
) -> NewtonResult:
    """Return the equilibrium at `load_factor` that is found from the state `start` (n,).

    keep: stop where the tangent has another count of negative pivots, from the third iteration on; of the second, which
    takes the stresses of a linear step, the result only tells it.
    """
    mixed = MIXED in system.proven
    result = _judged(system, load_factor, newton, _solve(system, start, load_factor, newton, keep))
    if not result.ended.good:
        loses_digits(system, start, load_factor)
    if MIXED in system.proven and not mixed:
        return _judged(system, load_factor, newton, _solve(system, start, load_factor, newton, keep))
    return result


def _judged(system: System, load_factor: float, newton: Newton, result: NewtonResult) -> NewtonResult:
    """Return a result with the digits that are sure of its forces, and what its state lacked to balance them."""
    if result.ended is Ended.CONVERGED and math.isnan(result.digits):
        return replace(result, digits=-float(np.log10(newton.residual_tolerance)))
    if result.ended is Ended.ROUND_OFF:
        digits = digits_of(system, result.state, load_factor) if math.isnan(result.digits) else result.digits
        if digits >= ENOUGH:
            return replace(result, digits=digits)
        missing = remainder(system, result.state, load_factor)
        ended = Ended.ROUND_OFF if missing.digits >= 1.0 else Ended.NO_DIGITS
        return replace(result, state=result.state + missing.step, ended=ended, digits=missing.digits)
    return result


def _solve(system: System, start: np.ndarray, load_factor: float, newton: Newton, keep: int | None) -> NewtonResult:
    prescribed = np.zeros(len(start))
    prescribed[system.held_dofs] = system.held_values(load_factor) - start[system.held_dofs]
    if system.unknowns.pattern is None and MIXED not in system.proven:
        solve = _solve_halves if worth_cutting(system) else _solve_band
        result = solve(system, start, load_factor, newton, prescribed, keep)
        if result is not None:
            return result
    p, rest = start.copy(), np.zeros(len(start))
    scale = system.scale
    free = system.free_dofs
    stresses = linear = swung = None
    last = first = np.inf
    for iteration in range(1, newton.iterations + 1):
        unbalanced, tangent = linearise(system, p, rest, rest, load_factor, STATICS, stresses)
        step = prescribed.copy() if iteration == 1 else np.zeros(len(p))
        try:
            factors = tangent.factorised(system.turned)
            step[free], after = factors.correction(unbalanced[free])
            if iteration == 1 and np.any(prescribed):
                step[free] -= factors.solve(_held_force(system, p, prescribed, load_factor)[free])
                after = None
        except LinAlgError:
            return NewtonResult(p, iteration, Ended.SINGULAR)
        if iteration > 2 and keep not in (None, factors.negative_pivots):
            return NewtonResult(start, iteration, Ended.LOST, factors.negative_pivots)
        swung = linear if iteration == 2 and keep not in (None, factors.negative_pivots) else swung
        if newton.independent_stresses:
            stresses = after or predicted_stresses(system, p, step)
        p = p + step
        linear = p if iteration == 1 else linear
        size = float(np.max(np.abs(step) / scale, initial=0.0))
        first = size if iteration == 1 else first
        ended = verdict(system, p, load_factor, newton, iteration, (size, last))
        if ended is not None:
            if keep not in (None, factors.negative_pivots):
                ended = Ended.LOST
            state = p if ended.good else start
            return NewtonResult(state, iteration, ended, factors.negative_pivots, first=first, linear=swung)
        last = size
    return NewtonResult(p, newton.iterations, Ended.EXHAUSTED)


def _solve_band(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, prescribed: np.ndarray, keep: int | None
) -> NewtonResult | None:
    """Return the same in one compiled call where the tangent is a band; None where it needs pivots."""
    n, unknown, half = len(start), len(system.free_dofs), system.layouts[0].half_width
    values = system.point_values(load_factor)
    assembler = system.assembler()
    assembler.load(system.body(load_factor), values)
    assembler.weigh(STATICS)
    assembler.require("tangent", "prediction")
    room = Arena(
        {
            "p": (n,),
            "residual": (n,),
            record.STEP: (n,),
            record.HELD_STEP: (n,),
            record.HELD_FORCE: (n,),
            record.RIGHT: (unknown,),
            record.ROWS: (unknown, 2 * half + 1),
            record.LIMITS: (7,),
            record.FOUND: (9,),
            record.LINEAR: (n,),
        }
    )
    p, unbalanced, step, *held, _, rows, limits, found, linear = room.arrays.values()
    place = room.addresses
    states = place.pop("p"), place[record.STEP], place[record.STEP]
    assembler.place_at(states, place.pop("residual"), place[record.ROWS], rows.size)
    solver, routines = system.solver_table.filled(place), system.solver_table.routines(moving=False)
    p[:], step[:], held[0][:] = start, 0.0, prescribed
    held[1][:] = _held_force(system, start, prescribed, load_factor) if prescribed.any() else 0.0
    found[:] = 0.0
    found[1:3] = np.inf
    limits[:4] = newton.tolerance, _STAGNANT, _LARGEST, SMALLEST_PIVOT
    limits[4:] = newton.iterations, newton.independent_stresses, -1 if keep is None else keep
    load = load_size(system, values)
    while found[0] < newton.iterations:
        if not iterate(assembler.address, solver, routines):
            return None
        iterations, size, before = int(found[0]), found[1], found[2]
        negative = int(found[6])
        if keep not in (None, negative):
            return NewtonResult(start, iterations, Ended.LOST, negative)
        if _grown(size):
            return NewtonResult(start, iterations, Ended.DIVERGED, negative)
        if _small(size, before, iterations, newton):
            left = _Left(unbalanced, found[3], max(found[4], load))
            ended = _judge(system, p, newton, (size, before, iterations), left, found[5] <= 0.0)
            if ended is not None:
                swung = linear.copy() if found[8] > 0.0 else None
                return NewtonResult(p.copy(), iterations, ended, negative, left.digits, found[7], swung)
        held[0][:] = held[1][:] = 0.0
    return NewtonResult(p.copy(), newton.iterations, Ended.EXHAUSTED)


def _solve_halves(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, prescribed: np.ndarray, keep: int | None
) -> NewtonResult | None:
    """Return the same of a long chain, on two threads; None where it needs pivots."""
    force = _held_force(system, start, prescribed, load_factor) if prescribed.any() else np.zeros(len(start))
    halves = halves_of(system, start, load_factor)
    load, before, first = load_size(system, system.point_values(load_factor)), np.inf, np.inf
    swung = None
    with ThreadPoolExecutor(1) as pool:
        for iteration in range(1, newton.iterations + 1):
            change = (prescribed, force) if iteration == 1 else None
            try:
                size, pivots = correct(halves, pool, newton.independent_stresses, change)
            except LinAlgError:
                return None
            first = size if iteration == 1 else first
            negative = negative_pivots(halves, pivots) if keep is not None or _grown(size) else 0
            if iteration > 2 and keep not in (None, negative):
                return NewtonResult(start, iteration, Ended.LOST, negative)
            if iteration == 2 and keep not in (None, negative):
                swung = _linear_state(system, start, load_factor, prescribed, force)
            if _grown(size):
                return NewtonResult(start, iteration, Ended.DIVERGED, negative)
            if _small(size, before, iteration, newton):
                p, unbalanced, jacobian = joined(halves, pool)
                left = _left(system, unbalanced, load)
                ended = _judge(system, p, newton, (size, before, iteration), left, jacobian <= 0.0)
                if ended is not None:
                    negative = negative_pivots(halves, pivots)
                    lost = keep not in (None, negative)
                    reached, ended = (start, Ended.LOST) if lost else (p, ended)
                    return NewtonResult(reached, iteration, ended, negative, left.digits, first, swung)
            before = size
        p, *_ = joined(halves, pool)
    return NewtonResult(p, newton.iterations, Ended.EXHAUSTED)


def _linear_state(
    system: System, start: np.ndarray, load_factor: float, prescribed: np.ndarray, force: np.ndarray
) -> np.ndarray:
    """Return the state (n,) after the first correction."""
    rest = np.zeros(len(start))
    unbalanced, tangent = linearise(system, start, rest, rest, load_factor, STATICS)
    step, free = prescribed.copy(), system.free_dofs
    step[free] = tangent.solve(-(unbalanced + force)[free], system.turned)
    return start + step


def verdict(
    system: System, p: np.ndarray, load_factor: float, newton: Newton, iteration: int, sizes: tuple[float, float]
) -> Ended | None:
    """Say how an iteration ended whose last two corrections have these sizes; None where it shall go on."""
    size, before = sizes
    if _grown(size):
        return Ended.DIVERGED
    if not _small(size, before, iteration, newton):
        return None
    rest = np.zeros(len(p))
    left = _left(
        system, residual(system, p, rest, rest, load_factor), load_size(system, system.point_values(load_factor))
    )
    return _judge(system, p, newton, (size, before, iteration), left, inverted(system, p))


def _grown(size: float) -> bool:
    return not np.isfinite(size) or size > _LARGEST


def _small(size: float, before: float, iteration: int, newton: Newton) -> bool:
    return size <= newton.tolerance or _stagnant(size, before, iteration)


def _stagnant(size: float, before: float, iteration: int) -> bool:
    return iteration > 2 and size > 0.25 * before and size < _STAGNANT


@dataclass(frozen=True, eq=False)
class _Left:
    """What is left of the balance: residual (n,), its largest of the unknown, and the largest force.

    Forces are multiplied by what their coordinate is measured by, so that they compare with moments [N m].
    """

    residual: np.ndarray
    largest: float
    force: float

    @property
    def digits(self) -> float:
        """How many digits of the largest force every row leaves."""
        return min(math.log10(self.force / self.largest), MOST_DIGITS) if self.largest > 0.0 else MOST_DIGITS


def _left(system: System, unbalanced: np.ndarray, load: float) -> _Left:
    """Return the same of a residual (n,); load: largest that acts, for where nothing reacts."""
    largest = float(np.max(np.abs(system.along_free(unbalanced)) * system.scale[system.free_dofs], initial=0.0))
    return _Left(unbalanced, largest, max(float(np.max(np.abs(unbalanced) * system.scale, initial=0.0)), load))


def _judge(
    system: System, p: np.ndarray, newton: Newton, sizes: tuple[float, float, int], left: _Left, inside_out: bool
) -> Ended | None:
    """Say how an iteration ended whose corrections are small or no longer shrink; None where it shall go on.

    sizes: of the last correction and the one before, and the number of the iteration. Where the residual is above the
    tolerance, each row must have come to its own floor, and what the next correction would be must be lost in the
    digits of the movement.
    """
    if sizes[0] <= newton.tolerance and left.largest <= newton.residual_tolerance * left.force:
        ended = Ended.CONVERGED
    elif _settled(system, p, sizes) and np.all(
        np.abs(system.along_free(left.residual)) <= row_floors(system, p)[system.free_dofs]
    ):
        ended = Ended.ROUND_OFF
    else:
        return None
    return Ended.INVERTED if inside_out else ended


def _settled(system: System, p: np.ndarray, sizes: tuple[float, float, int]) -> bool:
    """Tell whether a further correction, if they shrink as before, is small against the movement or below a digit."""
    size, before, iteration = sizes
    if _stagnant(size, before, iteration):
        return True
    following = size * min(size / before, 1.0) if iteration > 1 else size
    moved = float(np.max(np.abs(p - system.reference) / system.scale, initial=0.0))
    last_digit = np.finfo(float).eps * float(np.max(np.abs(p) / system.scale, initial=1.0))
    return following <= max(_SURE * moved, last_digit)


def inverted(system: System, p: np.ndarray) -> bool:
    """Tell whether r0' x d is negative at some Gauss point; elastic forces that are polynomials do not prevent it."""
    return system.assembler().smallest_jacobian(p) <= 0.0


def _held_force(system: System, p: np.ndarray, step: np.ndarray, load_factor: float) -> np.ndarray:
    """Return the change of the residual with a step (n,) of the held coordinates, by a central difference."""
    rest = np.zeros(len(p))
    size = 1e-6 / max(float(np.max(np.abs(step))), 1e-300)
    ahead = residual(system, p + size * step, rest, rest, load_factor)
    behind = residual(system, p - size * step, rest, rest, load_factor)
    return np.asarray((ahead - behind) / (2.0 * size))
