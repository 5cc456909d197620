"""Check whether a state is an equilibrium."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, linearise, residual
from beamfem.assembly.system import System
from beamfem.precision.roundoff import digits_of, load_size, remainder, row_floors

_TOLERANCE = 1e-6  # of the largest force: largest residual of an equilibrium
_SAME = 1e-9  # of the movement of a state: a smaller correction does not change the results
_LAST_DIGIT = 8.0 * np.finfo(float).eps  # of the size of the model
_CANCELLED = 1e4 * np.finfo(float).eps  # round-off of strains due to positions, up to this for fields of high order


def left_over(system: System, p: np.ndarray, load_factor: float) -> float:
    """Return the largest unbalanced force [N, N m] in the state p (n,); 0 if it is small enough."""
    zeros = np.zeros_like(p)
    unbalanced, tangent = linearise(system, p, zeros, zeros, load_factor, STATICS)
    remaining = np.abs(system.along_free(unbalanced))
    acting = [float(np.abs(values).max(initial=0.0)) for values in system.point_values(load_factor)]
    if system.imposing(load_factor).any():
        acting.append(load_size(system, system.loads_at(load_factor)) / system.extent)
    force = max([float(np.abs(unbalanced).max()), *acting])
    reach = max([float(np.abs(p).max()), *(beam.curve.length for beam in system.model.beams)])
    round_off = _CANCELLED * reach * np.asarray(abs(tangent.sparse(system.rotated)).sum(axis=1))
    if np.all(remaining <= _TOLERANCE * force):
        return 0.0
    # small loads may be below the round-off of stiff rows, but still bend a slender beam
    if np.all(remaining <= np.maximum(_TOLERANCE * force, round_off)) and _sure(system, p, load_factor):
        return 0.0
    return float(remaining.max())


def _sure(system: System, p: np.ndarray, load_factor: float) -> bool:
    """Return whether a state (n,) balances the loads except for its last digits; without loads, all rows count."""
    if not system.loads_at(load_factor).any:
        zeros = np.zeros_like(p)
        unbalanced = np.abs(system.along_free(residual(system, p, zeros, zeros, load_factor)))
        if np.all(unbalanced <= row_floors(system, p)[system.free_dofs]):
            return True
    if digits_of(system, p, load_factor) >= 1.0:
        return True
    if remainder(system, p, load_factor).digits >= 1.0:
        return True
    # where a structure was unloaded, no force is left to compare with, but the movement that is missing may be nothing
    moved = float(np.max(np.abs(p - system.reference) / system.scale, initial=0.0))
    return _missing(system, p, load_factor) <= max(_SAME * moved, _LAST_DIGIT)


def _missing(system: System, p: np.ndarray, load_factor: float) -> float:
    """Return the size of the correction, relative to the model, that balances a state (n,); inf if none does."""
    zeros, free = np.zeros_like(p), system.free_dofs
    unbalanced, tangent = linearise(system, p, zeros, zeros, load_factor, STATICS)
    try:
        step = tangent.factorised(system.rotated).solve(-unbalanced[free])
    except LinAlgError:
        return np.inf
    return float(np.max(np.abs(step) / system.scale[free], initial=0.0))
