"""Motions with constraint conditions: consistent start, initial accelerations and multipliers, impact on supports."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import block_array, csc_array, dia_array

from beamfem.equations.bound_connector import Motion
from beamfem.equations.connectors import SHORT_TIME
from beamfem.equations.equations import INERTIA, STATICS, linearise, residual
from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.linalg.bordered import BorderedTangent, CondensedFactors
from beamfem.linalg.tangent import UNROTATED, SaddleTangent, SparseTangent, Tangent
from beamfem.model.contribution import is_one_sided
from beamfem.solve.start.mechanisms import dependent, require_independent

_MET = 1e-8  # of the model, or of the largest velocity
_SHORT = 1e-3  # of the model: step of a difference along the motion
CENTRAL = (3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0)  # of sixth order


def require_met(system: System, p: np.ndarray, time: float) -> None:
    """Raise InputError if the start p (n,) of a motion at a time does not satisfy the conditions of connectors."""
    for item in system.connectors.items:
        if is_one_sided(item.item):
            raise InputError(
                f"conditions of {item.name} are one-sided, which statics supports and simulate does not; a Stop has a "
                "contact stiffness instead"
            )
    require_independent(system, p)
    gaps = system.connectors.conditions(p, np.zeros(len(p)), time)[0]
    for item in system.connectors.items:
        rows = item.multipliers - system.model.coordinates
        if np.any(np.abs(gaps[rows]) > _MET * system.extent):
            raise InputError(
                f"the start of the motion does not satisfy the conditions of {item.name}, which are off by {gaps[rows]}"
            )


def change_of_velocity(system: System, p: np.ndarray, given: np.ndarray, v: np.ndarray) -> str:
    """Return a sentence on how conditions change a given velocity p' (n,), nothing if by round-off only."""
    change = v - given
    size, fastest = (np.max(np.abs(each) * np.where(system.positions, 1.0, system.extent)) for each in (change, given))
    if fastest == 0.0 or size <= _MET * fastest:
        return ""
    lost, before = (_momentum(system, p, each) @ each for each in (change, given))
    items, second = system.connectors.items, system.model.unit("s")
    names = sorted({item.name for item in items if len(item.multipliers)})
    return (
        f"the initial velocity does not satisfy the conditions of {', '.join(names)}: impulses there change it by "
        f"up to {size:.3g} {system.model.unit('m')}/{second} and take {lost / before:.2%} of the kinetic energy. A "
        "RigidVelocity moves all that is connected alike"
    )


def constrained_acceleration(
    system: System, motion: Motion, unbalanced: np.ndarray, mass: Tangent, time: float | None
) -> np.ndarray:
    """Return p'' and multipliers (unknown,), with [M, G'; G, 0] [p'', l] = [-r, -d/dt (G p' + dg/dt)], G p'' apart.

    motion: p, p' and p'' of prescribed coordinates; unbalanced (n,): residual r without multipliers; mass: M, between
    coordinates; time: None for an impact, in which it stands still.
    """
    (p, v, a), k = motion, len(system.connectors.multipliers)
    right = -unbalanced[system.free_dofs]
    right[-k:] = -_change_of_rates(system, p, v, a, time)
    return _with_conditions(system, p, mass, right, time or 0.0)


def stopped_by_conditions(system: System, p: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
    """Return the change of p' (n,) by the impulses of conditions that a start p, p' (n,) does not satisfy at once.

    Momentum changes along the gradients of the conditions only, M x + G' l = 0 with G (p' + x) + dg/dt = 0.
    """
    zeros, multipliers = np.zeros(len(p)), system.connectors.multipliers
    mass = linearise(system, p, zeros, zeros, 0.0, INERTIA)[1]
    right, result = np.zeros(len(system.free_dofs)), zeros.copy()
    right[-len(multipliers) :] = -_rates(system, p, v, time)
    result[system.free_dofs] = _with_conditions(system, p, mass, right, time)
    result[multipliers] = 0.0
    return result


_GAP = 1e-13  # of the model: gap of a condition that is round-off
_CORRECTIONS = 5  # of positions, at most


def onto_conditions(system: System, state: np.ndarray, time: float) -> None:
    """Put p and p' of a state p, p', p'' (4, n) onto the conditions, along M^-1 G', which changes no momentum.

    Without it, collocation whose last stage is not the end of the step has no accuracy in what conditions hold (Ascher
    and Petzold 1991).
    """
    zeros, multipliers = np.zeros(state.shape[1]), system.connectors.multipliers
    numbers, right = _conditions(system), np.zeros(len(system.free_dofs))
    for _ in range(_CORRECTIONS):
        gaps = system.connectors.conditions(state[0], zeros, time)[0][numbers]
        if np.abs(gaps).max() <= _GAP * system.extent:
            break
        right[-len(multipliers) :] = -gaps
        mass = linearise(system, state[0], zeros, zeros, 0.0, INERTIA)[1]
        moved = zeros.copy()
        moved[system.free_dofs] = _with_conditions(system, state[0], mass, right, time)
        moved[multipliers] = 0.0
        state[0] += moved
    state[1] += stopped_by_conditions(system, state[0], state[1], time)


def _with_conditions(system: System, p: np.ndarray, mass: Tangent, right: np.ndarray, time: float) -> np.ndarray:
    """Return x and multipliers (unknown,), with [M, G'; G, 0] [x, l] = right."""
    k, zeros = len(system.connectors.multipliers), np.zeros(len(p))
    tangent = linearise(system, p, zeros, zeros, time, STATICS)[1]
    if isinstance(mass, BorderedTangent) and isinstance(tangent, BorderedTangent):
        entries = tangent.border.entries.copy()
        entries[:-k, :-k], entries[-k:, -k:] = mass.border.entries[:-k, :-k], 0.0
        with suppress(LinAlgError):
            factors = replace(mass, border=mass.border._replace(entries=entries)).factorised(system.rotated)
            if isinstance(factors, CondensedFactors):
                return factors.solve(right)
    scale = np.append(system.scale[system.free_dofs][:-k], np.ones(k))  # rotations weigh as much as lengths
    units = dia_array((scale[None, :-k], [0]), shape=(len(scale) - k,) * 2)
    inertia = units @ mass.sparse(UNROTATED)[:-k, :-k] @ units
    conditions = tangent.sparse(UNROTATED)[-k:, :-k] @ units
    whole = SaddleTangent(SparseTangent(csc_array(block_array([[inertia, conditions.T], [conditions, None]]))), k)
    try:
        return scale * whole.solve(scale * right, system.rotated)
    except LinAlgError as error:
        raise InputError(dependent(system, p)) from error


def _change_of_rates(system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float | None) -> np.ndarray:
    """Return d/dt (G p' + dg/dt) (k,) along p + p' t + p'' t^2 / 2, by differences; time: None for G p' alone."""
    speed, push = (float(np.max(np.abs(values) / system.scale)) for values in (v, a))
    changing = time is not None and system.connectors.conditions_follow_time
    if speed == 0.0 == push and not changing:
        return np.zeros(len(system.connectors.multipliers))
    size = min(_SHORT / speed if speed else np.inf, np.sqrt(_SHORT / push) if push else np.inf)
    if changing and time is not None:
        size = min(size, SHORT_TIME)
        at = [_rates(system, p + t * v + 0.5 * t**2 * a, v + t * a, time + t) for t in (0.0, size, 2.0 * size)]
        return np.asarray((4.0 * at[1] - 3.0 * at[0] - at[2]) / (2.0 * size))
    result = np.zeros(len(system.connectors.multipliers))
    for number, weight in enumerate(CENTRAL, 1):
        ends = [_rates(system, p + t * v + 0.5 * t**2 * a, v + t * a, 0.0) for t in (number * size, -number * size)]
        result += weight * (ends[0] - ends[1]) / size
    return result


def _rates(system: System, p: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
    """Return the rates G p' + dg/dt (k,) of the conditions whose multipliers are unknowns, in the equations' order."""
    return system.connectors.conditions(p, v, time)[1][_conditions(system)]


def _conditions(system: System) -> np.ndarray:
    """Return the numbers (k,) of the conditions whose multipliers are unknowns, in the order of the last equations."""
    return system.free_dofs[-len(system.connectors.multipliers) :] - system.model.coordinates


def impact(system: System, p: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Return how the velocities p' (n,) of unknowns change if supports change others at once.

    Only supports, and multipliers that connect, exert impulses: M_ff x = -M_fc c, for the change c (n,) along what is
    supported. p (n,): the state in which it happens.
    """
    zeros = np.zeros(len(p))
    mass = linearise(system, p, zeros, zeros, 0.0, INERTIA)[1]
    impulse, free, result = _momentum(system, p, change), system.free_dofs, zeros.copy()
    if len(system.connectors.multipliers):
        result[free] = constrained_acceleration(system, (p, zeros, change), impulse, mass, None)
        result[system.connectors.multipliers] = 0.0
    else:
        result[free] = mass.solve(-impulse[free], system.rotated)
    return result


def _momentum(system: System, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return M p' (n,), by the inertia of an acceleration large enough to stand out beside forces."""
    zeros = np.zeros(len(p))
    forces = residual(system, p, zeros, zeros, 0.0)
    large, own = (np.abs(values).max() for values in (forces, residual(system, p, zeros, v, 0.0) - forces))
    factor = max(1.0, large / own) if own > 0.0 else 1.0
    return np.asarray((residual(system, p, zeros, factor * v, 0.0) - forces) / factor)
