"""Mechanisms that their prestress or weight at load factor 0 makes stiff, such as strings and hanging chains."""

import numpy as np
from scipy.sparse import block_array, csc_array
from scipy.sparse.linalg import splu

from beamfem.assembly.equations import STATICS, linearise, residual
from beamfem.assembly.system import System
from beamfem.linalg.tangent import UNROTATED
from beamfem.precision.roundoff import largest_force
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes
from beamfem.solve.start.mechanisms import FreeMotion

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
