"""A basis of the motions that satisfy the conditions of connectors and inclined rollers."""

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.linalg.lapack import qr, solve_triangular
from beamfem.solve.start.mechanisms import dependent

_DEPENDENT = 1e-10  # of a condition of unit size: its part that is independent of all others
_ROUND_OFF = 1e-14  # of the largest entry of a basis


def independent_motions(system: System, p: np.ndarray, tangent: csr_array) -> tuple[np.ndarray, csr_array]:
    """Return the independent coordinates (m,) of the unknowns in a state p (n,), and a basis T (unknown, m).

    They are x = T x[independent].

    The conditions G x = 0 are those of multipliers, the last rows of the tangent [K, G^T; G, 0], and of inclined
    rollers. They are solved for as many coordinates, which pivoting selects. Multipliers have zero rows. Raises
    InputError if conditions are redundant.
    """
    unknown = len(system.free_dofs)
    multipliers = len(system.connectors.multipliers)
    size = unknown - multipliers
    first, normals = system.rotated
    active = size + np.flatnonzero(tangent.diagonal()[size:] == 0.0)  # of conditions that come and go, too
    rows = tangent[active, :size].toarray() if len(active) else np.empty((0, size))
    rollers = np.zeros((len(first), size))
    rollers[np.arange(len(first)), first] = normals[:, 0]
    rollers[np.arange(len(first)), first + 1] = normals[:, 1]
    conditions = np.vstack([rows, rollers])
    constrained = np.flatnonzero(conditions.any(axis=0))
    scale = system.scale[system.free_dofs[constrained]]
    solved, free, solution = _solved_for(conditions[:, constrained] * scale, system, p)
    solution *= scale[solved][:, None] / scale[free]
    dependents, drivers = constrained[solved], constrained[free]
    independent = np.setdiff1d(np.arange(size), dependents)
    number = np.zeros(size, dtype=np.int64)
    number[independent] = np.arange(len(independent))
    row, column = np.nonzero(solution)
    entries = np.concatenate([np.ones(len(independent)), solution[row, column]])
    places = np.append(independent, dependents[row]), np.append(number[independent], number[drivers[column]])
    return independent, csr_array(coo_array((entries, places), shape=(unknown, len(independent))))


def _solved_for(conditions: np.ndarray, system: System, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the columns that conditions (k, n) are solved for, the others, and the solution (k, n - k) X with x = X y.

    Raises InputError if conditions are redundant.
    """
    count = len(conditions)
    sizes = np.linalg.norm(conditions, axis=1, keepdims=True)
    triangle, order = qr(conditions / np.where(sizes > 0.0, sizes, 1.0), mode="r", pivoting=True)
    diagonal = np.abs(np.diagonal(triangle))
    if len(diagonal) < count or np.any(diagonal <= _DEPENDENT):
        raise InputError(dependent(system, p))
    solution = -solve_triangular(triangle[:, :count], triangle[:, count:])
    solution[np.abs(solution) <= _ROUND_OFF * np.abs(solution).max(initial=0.0)] = 0.0
    return order[:count], order[count:], solution
