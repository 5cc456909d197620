"""Impact of a motion on its supports: velocities that they change at once, and what follows from momentum."""

import numpy as np

from beamfem.assembly.equations import INERTIA, linearise, residual
from beamfem.assembly.system import System
from beamfem.solve.motion.constraints import constrained_acceleration


def impact(system: System, p: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Return how the velocities p' (n,) of unknowns change if supports change others at once.

    Only supports, and multipliers that connect, exert impulses: M_ff x = -M_fc c, for the change c (n,) along what is
    supported. p (n,): the state in which it happens.
    """
    zeros = np.zeros(len(p))
    mass = linearise(system, p, zeros, zeros, 0.0, INERTIA)[1]
    impulse, free, result = _momentum(system, p, change), system.free_dofs, zeros.copy()
    if len(system.connectors.multipliers):
        result[free] = constrained_acceleration(system, (p, zeros, change), impulse, mass, 0.0)
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
