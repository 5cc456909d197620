"""Modes of damped vibration about a state."""

import numpy as np
from scipy.sparse import csr_array

from beamfem.equations.system import system_of
from beamfem.errors import InputError
from beamfem.linalg.eigenpairs import digits_for, orthonormal
from beamfem.results.solution import State
from beamfem.solve.linear.quadratic_modes import slowest_rates
from beamfem.solve.modes.mode_stiffness import upright
from beamfem.solve.modes.modes import Modes
from beamfem.solve.modes.pencil import Pencil
from beamfem.solve.modes.rigid_modes import sort_rigid
from beamfem.validation import count as whole_number

_REAL = 1e-9  # of shapes: imaginary parts below this fraction are round-off


def damped_modes(
    state: State,
    matrices: tuple[csr_array, csr_array, csr_array],
    transformation: csr_array,
    scale: np.ndarray,
    round_off: tuple[float, float],
    count: int,
) -> Modes:
    """Return the slowest modes of M z'' + C z' + K z = 0, with phi^H M phi = 1.

    matrices: M, C and K (m, m); transformation (n, m): change of all coordinates of the model; scale (m,) and
    round_off: see `slowest_rates`. Raises InputError, ConvergenceError.
    """
    model, mass = state.model, matrices[0]
    if whole_number("count", count) > mass.shape[0]:
        raise InputError(f"count is {count}, but this model has only {mass.shape[0]} modes")
    system = system_of(model, static=True)
    with digits_for("modes"):
        rates, vectors = slowest_rates(*matrices, scale, round_off, count)
        rigid = np.count_nonzero(rates == 0.0)
        shapes, words = np.empty((0, model.size)), tuple[str, ...]()
        if rigid:
            still = orthonormal(vectors[:, :rigid].real, mass)
            shapes, words = sort_rigid(Pencil(system, state.p, state.at), still.T @ transformation.T)
    rates, vectors = rates[rigid:], vectors[:, rigid:]
    order = np.lexsort((-rates.real, rates.imag))
    rates, vectors = rates[order], vectors[:, order]
    vectors = vectors / np.sqrt(np.real((np.conj(vectors) * (mass @ vectors)).sum(axis=0)))
    elastic = upright(vectors.T @ transformation.T)
    if np.abs(elastic.imag).max(initial=0.0) <= _REAL * np.abs(elastic).max(initial=0.0):
        elastic = elastic.real
    shapes, rates = np.concatenate([upright(shapes), elastic]), np.append(np.zeros(rigid), rates)
    return Modes(model, state, rates.imag / (2.0 * np.pi), rates.real, shapes, words)
