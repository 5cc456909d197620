"""Newton's steps of a chain cut in two, on two threads, by substructuring.

Each half eliminates its own unknowns; the few remaining equations of the shared node are added up and solved.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from typing import TypeVar

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.kernels.band import band
from beamfem.kernels.newton import take_step
from beamfem.linalg.tangent import SMALLEST_PIVOT
from beamfem.solve.newton.cut_chain import Substructure

_NOTHING = np.empty(0)
T = TypeVar("T")

# a step (n,) of the prescribed coordinates and the change of the residual (n,) that it causes, in the first step only
Change = tuple[np.ndarray, np.ndarray] | None


def correct(
    substructures: tuple[Substructure, Substructure], pool: Executor, predicts: bool, change: Change
) -> tuple[float, np.ndarray]:
    """Take one step of Newton's method; return its relative size and the pivots of the shared unknowns (s,).

    predicts: use the stresses predicted by the previous step in the geometric tangent. Raises LinAlgError if pivoting
    is needed.
    """
    predicted = predicts and change is None
    condensed = _both(pool, lambda half: _eliminate(half, predicted, change), substructures)
    # in the second half the shared unknowns are in reverse order
    schur, right, diagonal = (a + np.flip(b) for a, b in zip(*condensed, strict=True))
    if change is not None:
        right -= change[1][substructures[0].free[substructures[0].inner :]]
    if not (diagonal > 0.0).all():
        raise LinAlgError("the tangent is singular")
    pivots = np.linalg.eigvals(schur / diagonal[:, None]).real
    if not np.abs(pivots).min(initial=1.0) > SMALLEST_PIVOT:
        raise LinAlgError("the tangent is singular")
    shared = np.linalg.solve(schur, right)
    for half, values in zip(substructures, (shared, shared[::-1]), strict=True):
        half.right[half.inner :] = values
    return float(np.max(_both(pool, lambda half: _advance(half, predicts, change), substructures))), pivots


def negative_pivots(substructures: tuple[Substructure, Substructure], shared: np.ndarray) -> int:
    """Return the number of negative pivots of the last step; shared: pivots of the shared unknowns."""
    # the factorisation stores the inverse of each pivot on the diagonal
    of_all = (shared, *(half.rows[: half.inner, half.rows.shape[1] // 2] for half in substructures))
    return sum(int((values < 0.0).sum()) for values in of_all)


def _both(
    pool: Executor, call: Callable[[Substructure], T], substructures: tuple[Substructure, Substructure]
) -> tuple[T, T]:
    """Return the results of a call for both halves; this thread computes one of them."""
    other = pool.submit(call, substructures[1])
    return call(substructures[0]), other.result()


def _eliminate(half: Substructure, predicted: bool, change: Change) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the condensed equations of the shared unknowns (s,): matrix (s, s), right-hand side, original diagonal."""
    rows, right, inner, middle = half.rows, half.right, half.inner, half.rows.shape[1] // 2
    half.balance(predicted, rows.reshape(-1))
    np.negative(np.take(half.residual, half.free, out=right, mode="clip"), out=right)
    if change is not None:
        right[:inner] -= change[1][half.place][half.free[:inner]]
    diagonal = np.abs(rows[inner:, middle])
    solver = band(middle)
    if not solver.factor(len(rows), inner, middle, 1, half.reach, rows, right, half.step) > SMALLEST_PIVOT:
        raise LinAlgError("a pivot is tiny")
    i, j = np.ogrid[: len(diagonal), : len(diagonal)]
    return rows[inner + i, middle + j - i], right[inner:].copy(), diagonal


def _advance(half: Substructure, predicts: bool, change: Change) -> float:
    """Take the step by back substitution from the shared unknowns; return its relative size."""
    middle = half.rows.shape[1] // 2
    band(middle).solve_upper(half.inner, len(half.right), middle, half.rows, half.right)
    half.step[:] = 0.0 if change is None else change[0][half.place]
    half.step[half.free] = half.right
    if predicts:
        half.equations.predict(half.p, half.step)
    return float(take_step(len(half.p), half.step, half.p, half.inverse_scale))


def joined(substructures: tuple[Substructure, Substructure], pool: Executor) -> tuple[np.ndarray, np.ndarray, float]:
    """Return state (n,), residual (n,) and the smallest r0' x d of the chain."""
    smallest = min(_both(pool, _balanced, substructures))
    state, residual = np.zeros((2, substructures[1].place.stop))
    for half in substructures:
        state[half.place] = half.p
        residual[half.place] += half.residual
    return state, residual, smallest


def _balanced(half: Substructure) -> float:
    half.balance(False, _NOTHING)
    return half.equations.smallest_jacobian(half.p)
