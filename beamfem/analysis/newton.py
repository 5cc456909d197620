"""Newton's method for an equilibrium at a fixed load factor."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.analysis.cut_chain import halves_of, worth_cutting
from beamfem.analysis.equations import STATICS, linearise, point_rows, predicted_stresses, residual
from beamfem.analysis.halves import correct, joined, negative_pivots
from beamfem.analysis.tangent import SMALLEST_PIVOT
from beamfem.errors import InputError
from beamfem.kernels.balance import smallest_jacobian
from beamfem.kernels.equilibrate import equilibrate
from beamfem.kernels.reduce import place_nodes
from beamfem.model.system import System
from beamfem.validation import count, positive

_STAGNANT = 1e-6  # corrections below this that no longer shrink are round-off, if the residual says so too
_LARGEST = 1e3  # of the model; larger corrections lead nowhere


class Ended(Enum):
    """Why an iteration ended; the values are the sentences that users read."""

    CONVERGED = "the correction and the residual are within the tolerance"
    ROUND_OFF = "the residual has reached the round-off floor of the model"
    DIVERGED = "the corrections grew beyond the size of the model"
    EXHAUSTED = "the iterations ran out before the corrections became small"
    SINGULAR = "the tangent is singular"
    LOST = "the count of negative pivots changed on the way, so the equilibrium may be one of another path"
    INVERTED = "the beam was turned inside out: r_x and r_y no longer form a right-handed pair"

    @property
    def good(self) -> bool:
        return self in (Ended.CONVERGED, Ended.ROUND_OFF)


@dataclass(frozen=True)
class NewtonResult:
    """The last state (n,) of an iteration, how many iterations it took and why it ended.

    negative_pivots: how many of the last tangent; of a symmetric one, in how many ways the equilibrium is unstable.
    """

    state: np.ndarray
    iterations: int
    ended: Ended
    negative_pivots: int = 0


@dataclass(frozen=True)
class Newton:
    """How to iterate.

    tolerance: largest correction relative to the model's length or one radian [-]; residual_tolerance: largest residual
    relative to the reactions and loads [-]; iterations: how many at most; independent_stresses: take the stress
    resultants predicted by the last correction for the geometric tangent (Magisano, Leonetti and Garcea 2017).
    Raises InputError.
    """

    tolerance: float = 1e-10
    residual_tolerance: float = 1e-9
    iterations: int = 15
    independent_stresses: bool = True

    def __post_init__(self) -> None:
        positive("tolerance", self.tolerance)
        positive("residual_tolerance", self.residual_tolerance)
        count("iterations", self.iterations)
        if not isinstance(self.independent_stresses, bool):
            raise InputError(f"independent_stresses must be True or False, got {self.independent_stresses!r}")


def solve_equilibrium(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, guarded: bool = False
) -> NewtonResult:
    """Return the equilibrium at `load_factor` that is found from the state `start` (n,).

    guarded: stop where the tangent has another count of negative pivots than at the start, from the third iteration on:
    the second tangent takes the stresses of a linear step, which may be far too large.
    """
    held_step = np.zeros(len(start))
    held_step[system.held_dofs] = system.held_values(load_factor) - start[system.held_dofs]
    if system.unknowns.pattern is None:
        solve = _solve_halves if worth_cutting(system) else _solve_band
        result = solve(system, start, load_factor, newton, held_step, guarded)
        if result is not None:
            return result
    p, rest = start.copy(), np.zeros(len(start))
    scale = system.scale
    free = system.free_dofs
    stresses = None
    last, begun_with = np.inf, -1
    for iteration in range(1, newton.iterations + 1):
        unbalanced, tangent = linearise(system, p, rest, rest, load_factor, STATICS, stresses)
        step = held_step if iteration == 1 else np.zeros(len(p))
        right = -unbalanced[free]
        if iteration == 1 and np.any(held_step):
            right -= _held_force(system, p, held_step, load_factor)[free]
        try:
            factors = tangent.factorised(system.turned)
            step[free] = factors.solve(right)
        except (LinAlgError, ValueError):
            return NewtonResult(p, iteration, Ended.SINGULAR)
        if guarded:
            if iteration == 1:
                begun_with = factors.negative_pivots
            elif iteration > 2 and factors.negative_pivots != begun_with:
                return NewtonResult(start, iteration, Ended.LOST, factors.negative_pivots)
        if newton.independent_stresses:
            stresses = predicted_stresses(system, p, step)
        p = p + step
        size = float(np.max(np.abs(step) / scale, initial=0.0))
        ended = verdict(system, p, load_factor, newton, iteration, (size, last))
        if ended is not None:
            if guarded and factors.negative_pivots != begun_with:
                ended = Ended.LOST
            state = p if ended.good else start
            return NewtonResult(state, iteration, ended, factors.negative_pivots)
        last = size
    return NewtonResult(p, newton.iterations, Ended.EXHAUSTED)


def _solve_band(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, held_step: np.ndarray, guarded: bool
) -> NewtonResult | None:
    """Return the same in one compiled call where the tangent is a band; None where it needs pivots."""
    p, held_force = start.copy(), np.zeros(len(start))
    if held_step.any():
        held_force = _held_force(system, start, held_step, load_factor)
    rows = np.empty((len(system.free_dofs), 2 * system.layouts[0].half_width + 1))
    values = point_rows(system, load_factor)
    model = (
        system.forms,
        system.blocks,
        system.workspaces(system.stress_tables()),
        system.point_loads,
        system.springs,
        system.layouts,
        system.free_dofs,
        system.turned,
    )
    body = system.body(load_factor)
    found = np.array([0.0, np.inf, np.inf, 0.0, 0.0, 0.0, -1.0, 0.0])
    bounds = newton.tolerance, _STAGNANT, _LARGEST, SMALLEST_PIVOT
    limits = np.array((*bounds, newton.iterations, newton.independent_stresses, guarded), dtype=float)
    change = held_step, held_force
    load = max((float(np.abs(forces).max(initial=0.0)) for forces in values), default=0.0)
    while found[0] < newton.iterations:
        if not equilibrate(*model, p, body, values, change, system.scale, limits, rows, found):
            return None
        iterations, size, before = int(found[0]), found[1], found[2]
        negative = int(found[7])
        if guarded and negative != found[6]:
            return NewtonResult(start, iterations, Ended.LOST, negative)
        if _grown(size):
            return NewtonResult(start, iterations, Ended.DIVERGED, negative)
        if _small(size, before, iterations, newton):
            ended = _judge(system, p, newton, size, found[3], max(found[4], load), found[5] <= 0.0)
            if ended is not None:
                return NewtonResult(p, iterations, ended, negative)
        change = np.zeros(len(p)), np.zeros(len(p))
    return NewtonResult(p, newton.iterations, Ended.EXHAUSTED)


def _solve_halves(
    system: System, start: np.ndarray, load_factor: float, newton: Newton, held_step: np.ndarray, guarded: bool
) -> NewtonResult | None:
    """Return the same of a long chain, on two threads; None where it needs pivots."""
    held_force = _held_force(system, start, held_step, load_factor) if held_step.any() else np.zeros(len(start))
    halves = halves_of(system, start, load_factor)
    load, before, begun_with = _load_size(system, load_factor), np.inf, -1
    with ThreadPoolExecutor(1) as pool:
        for iteration in range(1, newton.iterations + 1):
            change = (held_step, held_force) if iteration == 1 else None
            try:
                size, pivots = correct(halves, pool, newton.independent_stresses, change)
            except LinAlgError:
                return None
            negative = negative_pivots(halves, pivots) if guarded or _grown(size) else 0
            begun_with = negative if iteration == 1 else begun_with
            if guarded and iteration > 2 and negative != begun_with:
                return NewtonResult(start, iteration, Ended.LOST, negative)
            if _grown(size):
                return NewtonResult(start, iteration, Ended.DIVERGED, negative)
            if _small(size, before, iteration, newton):
                p, unbalanced, jacobian = joined(halves, pool)
                largest = float(np.max(np.abs(unbalanced[system.free_dofs]), initial=0.0))
                force = max(float(np.max(np.abs(unbalanced), initial=0.0)), load)
                ended = _judge(system, p, newton, size, largest, force, jacobian <= 0.0)
                if ended is not None:
                    negative = negative_pivots(halves, pivots)
                    lost = guarded and negative != begun_with
                    return NewtonResult(start if lost else p, iteration, Ended.LOST if lost else ended, negative)
            before = size
        p, *_ = joined(halves, pool)
    return NewtonResult(p, newton.iterations, Ended.EXHAUSTED)


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
    unbalanced = residual(system, p, rest, rest, load_factor)
    largest = float(np.max(np.abs(system.along_free(unbalanced)), initial=0.0))
    force = max(float(np.max(np.abs(unbalanced), initial=0.0)), _load_size(system, load_factor))
    return _judge(system, p, newton, size, largest, force, inverted(system, p))


def _grown(size: float) -> bool:
    return not np.isfinite(size) or size > _LARGEST


def _small(size: float, before: float, iteration: int, newton: Newton) -> bool:
    return size <= newton.tolerance or (iteration > 2 and size > 0.25 * before and size < _STAGNANT)


def _judge(
    system: System, p: np.ndarray, newton: Newton, size: float, largest: float, force: float, inside_out: bool
) -> Ended | None:
    """Say how an iteration ended whose corrections are small or no longer shrink; None where it shall go on.

    largest: residual of the unknown directions [N, N m]; force: largest force that acts or reacts.
    """
    if size <= newton.tolerance and largest <= newton.residual_tolerance * force:
        ended = Ended.CONVERGED
    elif largest <= round_off_floor(system, p):
        ended = Ended.ROUND_OFF
    else:
        return None
    return Ended.INVERTED if inside_out else ended


def inverted(system: System, p: np.ndarray) -> bool:
    """Tell whether r0' x d is negative at some Gauss point; elastic forces that are polynomials do not prevent it."""
    work, rest = system.workspaces(), np.zeros(len(p))
    for block, own in zip(system.blocks, work, strict=True):
        place_nodes(block, p, rest, rest, own.nodes[0], own.nodes[1])
    return bool(smallest_jacobian(system.forms, system.blocks, work) <= 0.0)


def round_off_floor(system: System, p: np.ndarray) -> float:
    """Return the residual [N] that is left by cancellation when strains are formed from positions.

    A position of size |r| carries an error eps |r|, a strain over an element of length l therefore eps |r| / l times
    the slopes of the shape functions; the section answers with its largest axial stiffness, again times slopes.
    """
    reach = max(float(np.max(np.abs(p))), system.extent)
    return 4.0 * np.finfo(float).eps * system.strain_error * reach


def _load_size(system: System, load_factor: float) -> float:
    """Largest force or moment that acts; keeps the residual's scale above zero where nothing reacts."""
    values = [np.abs(forces).max(initial=0.0) for forces in system.point_values(load_factor)]
    return float(max(values, default=0.0))


def _held_force(system: System, p: np.ndarray, step: np.ndarray, load_factor: float) -> np.ndarray:
    """Change of the residual with a step (n,) of the held coordinates, by a central difference."""
    rest = np.zeros(len(p))
    size = 1e-6 / max(float(np.max(np.abs(step))), 1e-300)
    ahead = residual(system, p + size * step, rest, rest, load_factor)
    behind = residual(system, p - size * step, rest, rest, load_factor)
    return np.asarray((ahead - behind) / (2.0 * size))
