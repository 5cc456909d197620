"""Accelerations at the start of a motion, and of steps after a jump of loads or of the size of steps."""

import numpy as np
from scipy.sparse import csc_array

from beamfem.equations.bound_connector import Motion
from beamfem.equations.equations import INERTIA, linearise, residual, residuals
from beamfem.equations.system import System
from beamfem.equations.viscosity import viscous_tangent
from beamfem.linalg.tangent import UNROTATED, SparseTangent, Tangent
from beamfem.solve.motion.constraints import constrained_acceleration

_MOST_PASSES = 50  # each leaves a coefficient of friction, or less, of the change by the one before
_SETTLED = 1e-12  # of the largest multiplier: change by a pass
_NEGLIGIBLE = 0.1  # of the inertia forces at the start: those that depend on the velocity after a step


def initial_acceleration(
    system: System, state: np.ndarray, time: float, step: float = 0.0, elapsed: float = 0.0
) -> np.ndarray:
    """Return p'' (n,) that satisfies the equations of motion at the start; state: p, p', p'' of prescribed coordinates.

    Multipliers among p are set as well. With a step [s] it solves (M + step D) p'' = unbalanced forces, the mean over
    a step, see `_damped_mass`. In a beam with strong damping D, p'' itself decays within an instant, and from it the
    generalized-alpha method would move by step^2 (1 / 2 - beta / gamma) p''. To first order in the step both are the
    same. elapsed [s]: since history was committed.
    """
    motion = state[:3].copy()
    p, v, a = motion
    free = system.free_dofs
    multipliers = system.connectors.multipliers
    a[free] = p[multipliers] = v[multipliers] = 0.0
    if step > 0.0:
        unbalanced, mass = residual(system, p, v, a, time, elapsed), _damped_mass(system, (p, v, a), time, step)
    else:
        unbalanced, mass = linearise(system, p, v, a, time, INERTIA, dt=elapsed)
    if len(multipliers):
        given = a.copy()
        a[free] = constrained_acceleration(system, (p, v, given), unbalanced, mass, time)
        p[multipliers] = a[multipliers]
        for _ in range(_MOST_PASSES if len(system.history.numbers) else 0):  # friction depends on multipliers
            unbalanced = residual(system, p, v, given, time, elapsed)
            a[free] = constrained_acceleration(system, (p, v, given), unbalanced, mass, time)
            p[multipliers] += a[multipliers]
            if np.abs(a[multipliers]).max() <= _SETTLED * np.abs(p[multipliers]).max():
                break
        state[0, multipliers], state[1, multipliers], a[multipliers] = p[multipliers], 0.0, 0.0
        return a
    a[free] = mass.solve(-unbalanced[free], system.rotated)
    return a


def mean_acceleration(system: System, state: np.ndarray, time: float, step: float) -> np.ndarray:
    """Return p'' (n,) at the start, or its mean over the first step [s] where p'' itself is not representative.

    A sudden load accelerates vibrations that the steps do not resolve as if nothing held them back. That does no harm
    in a linear system. But where inertia forces depend on velocities, those of the velocity gained in one step, which
    is step p'', may be as large as M p'' itself (both in the norm of M^-1). Unless they are negligible, the result a
    satisfies (M + step^2 / 4 K) a = M p'', as the mean of the trapezoidal rule does.
    """
    p, v, start = state[:3]
    free, zeros = system.free_dofs, np.zeros(len(start))
    if len(system.connectors.multipliers):
        return start
    moved = (p, v - step * start, zeros), (p, v, zeros), (p, v + step * start, zeros), (p, v, start)
    slower, resting, faster, accelerated = residuals(system, moved, [time] * len(moved))[:, free]
    quadratic, inertia = 0.5 * (slower + faster) - resting, accelerated - resting
    mass = linearise(system, p, v, zeros, time, INERTIA)[1]
    if quadratic @ mass.solve(quadratic, system.rotated) <= _NEGLIGIBLE**2 * (inertia @ start[free]):
        return start
    stiff = linearise(system, p, v, zeros, time, (0.25 * step**2, 0.0, 1.0))[1]
    mean = start.copy()
    mean[free] = stiff.solve(inertia, system.rotated)
    return mean


def _damped_mass(system: System, motion: Motion, time: float, step: float) -> Tangent:
    """Return M + step D + step^2 / 4 K in p, p', p'' at a time, with the damping D of all that resists rates.

    Without K, a damper of a connector that outweighs the inertia of its node, which a stiff beam holds, would take the
    load of the whole beam. K counts there only.
    """
    p, v, zeros = *motion[:2], np.zeros(len(motion[0]))
    viscous = viscous_tangent(system, p, v, time, step)
    held = False
    if system.connectors.damp and not system.damped:
        resistance, inertia = (
            linearise(system, p, zeros, zeros, time, weights)[1].sparse(UNROTATED).diagonal()
            for weights in ((0.0, step, 0.0), INERTIA)
        )
        held = bool(np.any(resistance > inertia))
    mass = linearise(system, p, zeros, zeros, time, (0.25 * step**2 if held else 0.0, step, 1.0))[1]
    return mass if viscous is None else SparseTangent(csc_array(mass.sparse(UNROTATED) + viscous))
