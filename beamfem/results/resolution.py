"""Whether the steps of a motion resolve what carries its energy, without an evaluation of energies."""

from collections.abc import Sequence
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from beamfem.assembly.equations import INERTIA, linearise
from beamfem.assembly.system import System, system_of
from beamfem.kernels.motion_record import ALPHA_F, ALPHA_M, BETA, GAMMA, TIME_STEP
from beamfem.linalg.tangent import UNROTATED

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_FAST = 0.2  # (w h)^4; a vibration that alternates from step to step has 16 times its share of the kinetic energy
_REMOVED = 0.2  # of the energy
_COMPARED = 100  # most steps, at equal distances, whose velocities are compared


def resolved(solution: "Solution") -> bool:
    """Return whether the steps of a scheme can neither add much energy to a motion nor remove much.

    It gains energy only where steps h do not resolve a vibration w that carries energy, of which three successive
    velocities v have a second difference of (w h)^2 v; for what it loses see `removal`. Where not all steps are rows,
    (w h)^2 is that of accelerations and velocities. Laws with history are not judged: their steps dissipate too.
    """
    system, rule, steps = system_of(solution.model, static=False), solution.statistics.rule, solution.statistics.steps
    if not rule or system.history.laws:
        return False
    if len(solution) == steps + 1:
        before, now, after = (solution.v[first : steps - 1 + first : 1 + steps // _COMPARED] for first in range(3))
        squares = np.array((now, before - 2.0 * now + after)) ** 2 @ system.table(_masses)
        speed, change = squares.max(axis=1, initial=0.0).tolist()
        if change > _FAST * speed:
            return False
        speed, change = squares.sum(axis=1).tolist()
    else:
        squares = np.array((solution.v, rule[TIME_STEP] * solution.a)) ** 2 @ system.table(_masses)
        speed, acceleration = squares.sum(axis=1).tolist()
        change = acceleration**2 / (speed or 1.0)
    mean = change / (speed or 1.0)
    second, fourth = removal(rule)
    return bool(mean <= _FAST and steps * (second * sqrt(mean) + fourth * mean) <= _REMOVED)


def removal(rule: Sequence[float]) -> tuple[float, float]:
    """Return b and c: a step removes the share b (w h)^2 + c (w h)^4 of the energy of a slow vibration w.

    From the odd powers of s in ln((w h)^2 / s^2), where exp(s) is a principal root of the method for x'' + w^2 x = 0.
    Of methods of second order b = 0, and of `GeneralizedAlpha` c = ((1 - rho_inf) / (1 + rho_inf))^3.
    """
    alpha_m, alpha_f, gamma, beta = (rule[number] for number in (ALPHA_M, ALPHA_F, GAMMA, BETA))
    excess = gamma - 0.5
    means = _third_cumulant(alpha_f) - _third_cumulant(alpha_m)
    return excess + alpha_m - alpha_f, means - excess * (1.0 / 6.0 - beta + excess / 2.0 + excess**2 / 3.0)


def _third_cumulant(alpha: float) -> float:
    """Return the coefficient of s^3 in ln(1 - alpha + alpha exp(s))."""
    return alpha * (1.0 - alpha) * (1.0 - 2.0 * alpha) / 6.0


def _masses(system: System) -> np.ndarray:
    """Return the diagonal (n,) of the mass matrix in the reference."""
    p, result = system.reference, np.zeros(system.model.size)
    mass = linearise(system, p, result, result, 0.0, INERTIA)[1]
    result[system.free_dofs] = mass.sparse(UNROTATED).diagonal()
    return result
