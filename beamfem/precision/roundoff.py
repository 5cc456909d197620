"""Effect of rounded coordinates on the balance of forces, and corrections of a state beyond its last digit."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations import equations
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import Proven, System

_CORRECTIONS = 12
LAST_DIGITS = 1e-7  # of the model size: a state with a larger correction is wrong in more than its last digits
ENOUGH = 6.0  # digits of the forces; with fewer, the accuracy of the tangent is checked
_PLENTY = 12.0  # digits that no further correction improves
LOSES = 1e-3  # relative error of a solution with the plain tangent that costs iterations, and digits
MOST_DIGITS = 15.0
_NOTHING = 1e-10  # of the round-off of a state: smaller forces count as zero
FEW_DIGITS = 4.0  # of the forces; with fewer, users are warned


def row_floors(system: System, p: np.ndarray) -> np.ndarray:
    """Return the residual (n,) [N, N m] that rounded coordinates cause in each row, see `row_errors`."""
    reach, turn = equations.sizes(system, p)
    positions, directions = system.residual_errors
    return np.asarray(equations.ROUND_OFF * reach * positions + equations.ROUND_OFF * turn * directions)


@dataclass(frozen=True)
class Remainder:
    """Correction that brings a state into equilibrium beyond its last digit.

    step (n,): correction of p; digits: reliable digits of the forces after it, 0 if not even the first is reliable.
    """

    step: np.ndarray
    digits: float


def digits_of(system: System, p: np.ndarray, load_factor: float, largest: float = 0.0) -> float:
    """Return the number of reliable digits of the forces in a state p (n,); all if nothing acts.

    largest [N m]: a force of other states of the same path, see `largest_force`; if it is larger, its digits count.
    """
    unbalanced = equations.residual_at_rest(system, p, load_factor)
    return _digits(system, p, unbalanced, load_factor, largest)


def largest_force(system: System, p: np.ndarray, load_factor: float) -> float:
    """Return the largest force times the size of the model, or moment [N m], that acts in a state p (n,)."""
    return _acting(system, p, equations.residual_at_rest(system, p, load_factor), load_factor)


def remainder(system: System, p: np.ndarray, load_factor: float) -> Remainder:
    """Return the correction of a state p (n,) that is in equilibrium except for its last digits.

    Newton's method continues with p in two parts: steps below its last digit are summed separately, and their effect on
    the residual is computed by wider differences. The forces of an element are in equilibrium at any strain, so that
    the balance regains all digits as long as the tangent has some.
    """
    best = _refined(system, p, load_factor)
    if best.digits < ENOUGH and loses_digits(system, p, load_factor):
        again = _refined(system, p, load_factor)
        return again if again.digits > best.digits else best
    return best


def _refined(system: System, p: np.ndarray, load_factor: float) -> Remainder:
    """Return the best result of corrections with the current kind of tangent, plain or mixed."""
    free = system.free_dofs
    initial = equations.residual_at_rest(system, p, load_factor)
    best = Remainder(np.zeros(len(p)), _digits(system, p, initial, load_factor))
    step, unbalanced = np.zeros(len(p)), initial
    try:
        factors = equations.linearise_at_rest(system, p, load_factor)[1].factorised(system.rotated)
        _, stresses = factors.correction(initial[free])
        if stresses is not None:
            # the stresses of the state itself are as inaccurate as its last digits
            factors = equations.linearise_at_rest(system, p, load_factor, stresses)[1].factorised(system.rotated)
        for _ in range(_CORRECTIONS):
            step[free] += factors.solve(-unbalanced[free])
            if not np.max(np.abs(step) / system.scale, initial=0.0) <= LAST_DIGITS:
                break
            unbalanced = initial + equations.residual_change(system, p, step, load_factor)
            digits = _digits(system, p, unbalanced, load_factor)
            if digits <= best.digits:
                break
            best = Remainder(step.copy(), digits)
            if digits > _PLENTY:
                break
    except LinAlgError:
        pass
    return best


def loses_digits(system: System, p: np.ndarray, load_factor: float) -> bool:
    """Return whether the plain tangent of this model loses digits; it is checked once, and False afterwards.

    If so, all further tangents have stress resultants as unknowns.
    """
    lost = _found_to_lose(system, p, load_factor)
    if lost is not None:
        system.proven.add(Proven.LOSES_DIGITS if lost else Proven.KEEPS_DIGITS)
    return bool(lost)


def loses_digits_by_now(system: System, p: np.ndarray, load_factor: float) -> bool:
    """Return whether a state p (n,) further on loses digits with the plain tangent, which was kept so far.

    The softest stiffness vanishes at a critical point, so that round-off of the others grows beside it.
    """
    system.proven.discard(Proven.KEEPS_DIGITS)
    return loses_digits(system, p, load_factor)


def counts_with_stresses(system: System, p: np.ndarray, load_factor: float) -> bool:
    """Return whether negative eigenvalues in the state p (n,) are to be counted with stress resultants as unknowns.

    Round-off of a plain tangent that loses its digits may be larger than the softest stiffness. Further solves are the
    same whether this was asked or not.
    """
    return Proven.LOSES_DIGITS in system.proven or bool(_found_to_lose(system, p, load_factor))


def _found_to_lose(system: System, p: np.ndarray, load_factor: float) -> bool | None:
    """Return whether the plain tangent loses digits, None if it is known before or cannot be checked."""
    if Proven.LOSES_DIGITS in system.proven or Proven.KEEPS_DIGITS in system.proven or system.connectors.items:
        return None
    try:
        return lost_digits(system, p, load_factor, equations.STATICS) > LOSES
    except LinAlgError:
        return None


def lost_digits(system: System, p: np.ndarray, load_factor: float, coefficients: tuple[float, float, float]) -> float:
    """Return the relative error of a solution with the plain tangent, for weights of p, p', p''. Raises LinAlgError."""
    state, zeros = (p, np.zeros(len(p)), np.zeros(len(p))), np.zeros(len(p))
    plain = equations.linearise(system, p, zeros, zeros, load_factor, coefficients)[1]
    return equations.with_stresses(system, state, load_factor, coefficients, None, plain).lost(system.rotated)


def load_size(system: System, load_factor: float) -> float:
    """Return the largest load at a point: a force times the size of the model, or a moment [N m].

    If only imposed strains act, which may cause no forces, the forces that would suppress them count instead.
    """
    loads = system.loads.at(load_factor)
    force, moment = loads.largest
    largest = max(system.extent * force, moment)
    if largest == 0.0 and loads.imposing.any() and not loads.body.any():
        largest = max(largest, float(np.max(np.abs(equations.imposed_forces(system, load_factor)) * system.scale)))
    return largest


def _acting(system: System, p: np.ndarray, unbalanced: np.ndarray, load_factor: float) -> float:
    """Return the largest force times the size of the model, or moment [N m], of loads, supports and connections."""
    prescribed = system.prescribed_dofs
    reactions = float(np.max(np.abs(unbalanced[prescribed] * system.scale[prescribed]), initial=0.0))
    for dof, normal in system.inclined:
        reactions = max(reactions, system.extent * abs(float(normal @ unbalanced[dof : dof + 2])))
    connected, zeros = np.zeros(len(p)), np.zeros(len(p))
    system.connectors.add_forces(connected, (p, zeros, zeros), load_factor)
    connected[system.connectors.multipliers] = 0.0
    reactions = max(reactions, float(np.max(np.abs(connected * system.scale), initial=0.0)))
    sprung = np.abs(system.springs.forces(p)) * system.scale[system.springs.numbers]
    return max(load_size(system, load_factor), reactions, float(sprung.max(initial=0.0)))


def _distributed(system: System, p: np.ndarray, unbalanced: np.ndarray, load_factor: float) -> float:
    """Return the size of weights and forces along beams [N m] as `_acting`, by what is unbalanced (n,) without them.

    Where foundations alone bear them, there is no larger force.
    """
    if not system.loads.at(load_factor).body.any():
        return 0.0
    factors = system.loads.factors(load_factor) * [not load.even for load in system.model.acting]
    without = equations.residual_under(system, p, load_factor, factors)
    forces = without - unbalanced
    totals = [abs(float(rigid_rates(system, RigidVelocity(way), p) @ forces)) for way in ((1.0, 0.0), (0.0, 1.0))]
    return max(float(np.max(np.abs(forces) * system.scale, initial=0.0)), system.extent * max(totals))


def _digits(system: System, p: np.ndarray, unbalanced: np.ndarray, load_factor: float, largest: float = 0.0) -> float:
    """Return the number of reliable digits of the largest acting force, by the balance of each row and of the whole.

    All digits if nothing acts. largest: see `digits_of`.
    """
    free, acting = system.free_dofs, max(_acting(system, p, unbalanced, load_factor), largest)
    left = np.zeros(len(p))
    left[free] = system.along_free(unbalanced)
    worst = float(np.max(np.abs(left) * system.scale, initial=0.0))
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    centre = tuple(p[nodes].mean(axis=0).tolist())
    for motion in (RigidVelocity((1.0, 0.0)), RigidVelocity((0.0, 1.0)), RigidVelocity((0.0, 0.0), 1.0, centre)):
        size = 1.0 if motion.angular else system.extent
        worst = max(worst, size * abs(float(rigid_rates(system, motion, p) @ left)))
    if worst == 0.0:
        return MOST_DIGITS
    if acting < 10.0**ENOUGH * worst:
        acting = max(acting, _distributed(system, p, unbalanced, load_factor))
    if not system.loads.at(load_factor).any and acting <= _NOTHING * float(
        np.max(row_floors(system, p) * system.scale)
    ):
        return MOST_DIGITS
    return min(max(float(np.log10(acting / worst)), 0.0), MOST_DIGITS) if acting > 0.0 else 0.0
