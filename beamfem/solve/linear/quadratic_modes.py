"""Eigenvalues s of (s^2 M + s C + K) x = 0, the slowest ones of damped or gyroscopic systems."""

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import csc_array, csr_array, eye_array

from beamfem.linalg.eigenpairs import Pairs, dominant_pairs, orthonormal
from beamfem.linalg.lapack import superlu, svd

_SPARE = 4  # eigenvalues found beyond those asked for
_REAL = 1e-8  # of a rate: imaginary parts below this fraction are round-off, as of double roots
_UNDAMPED = 1e-10  # of a rate: real parts below this fraction are round-off
_SOLVES = 4  # for rigid motions and blurred vectors, each of which reduces other parts by the ratio of their rates
_BLURRED = 1e-9  # of a force: residual above which a vector has parts of others


def slowest_rates(
    mass: csr_array,
    damping: csr_array,
    stiffness: csr_array,
    scale: np.ndarray,
    round_off: tuple[float, float],
    rigid: int | None,
    count: int,
) -> Pairs:
    """Return the `count` slowest rates s (m,) [1/s] with Im s >= 0, by their size, and vectors x (n, m).

    A rigid motion, s = 0 twice, is one of them. scale (n,): sizes of the coordinates, relative to which vectors are
    compared; round_off: of x^T K x [1/s^2] and x^T C x [1/s] for a rigid motion x with x^T M x = 1; rigid: number of
    rigid motions, None for those within the round-off. m < count if there are no more. Raises ConvergenceError,
    LinAlgError.
    """
    n = mass.shape[0]
    resting, undamped = round_off
    rigid = _between(mass, stiffness, resting) if rigid is None else rigid
    slow = _slowest(mass, stiffness, rigid, resting)
    motions = _rigid_motions(mass, stiffness, rigid, np.sqrt(resting**0.5 * slow))
    resisted = svd(motions.T @ damping @ motions, compute_uv=False) if rigid else np.zeros(0)
    resisted = resisted[resisted > undamped]
    slow = min([slow, *resisted.tolist()])
    shift = slow if rigid else 0.0
    dynamic = superlu(csc_array(stiffness + shift * damping + shift**2 * mass))
    momentum = csr_array(damping + shift * mass)
    units = np.concatenate([scale, slow * scale])

    def times(y: np.ndarray) -> np.ndarray:
        """Return y / (s - shift) for eigenvectors y = (x, s x) / units."""
        y = units * y
        x = -dynamic.solve(mass @ y[n:] + momentum @ y[:n])
        return np.asarray(np.concatenate([x, y[:n] + shift * x]) / units)

    product = csr_array(eye_array(2 * n))
    values, y = dominant_pairs(times, product, min(2 * count + _SPARE, 2 * n), "LM")
    finite = np.abs(values) > np.finfo(float).eps * np.abs(values).max()
    rates, x = _rounded(shift + 1.0 / values[finite]), scale[:, None] * y[:n, finite]
    still = 2 * rigid - len(resisted)
    moving = np.argsort(np.abs(rates), kind="stable")[still:]
    moving = moving[rates[moving].imag >= 0.0]
    moving = moving[: max(count - rigid, 0)]
    pairs = [_sharpened(mass, damping, stiffness, rates[number], x[:, number]) for number in moving.tolist()]
    rates = np.append(np.zeros(rigid), [rate for rate, _ in pairs])
    return _rounded(rates)[:count], np.column_stack([motions, *(vector for _, vector in pairs)])[:, :count]


def _rounded(rates: np.ndarray) -> np.ndarray:
    """Return rates (m,) whose real or imaginary parts are 0 where they are round-off."""
    rates = np.where(np.abs(rates.imag) <= _REAL * np.abs(rates), rates.real, rates)
    return np.where(np.abs(rates.real) <= _UNDAMPED * np.abs(rates), 1j * rates.imag, rates)


def _sharpened(
    mass: csr_array, damping: csr_array, stiffness: csr_array, rate: complex, x: np.ndarray
) -> tuple[complex, np.ndarray]:
    """Return a rate and its vector (n,) after inverse iterations, if rates of other sizes have blurred them."""
    matrix = rate**2 * mass + rate * damping + stiffness
    size = max(abs(rate**2 * np.vdot(x, mass @ x)), abs(rate * np.vdot(x, damping @ x)))
    if abs(np.vdot(x, matrix @ x)) <= _BLURRED * size:
        return rate, x
    try:
        factors = superlu(csc_array(matrix, dtype=complex))
    except LinAlgError:  # of a rate that is exact, up to the round-off of large stiffnesses
        return rate, x
    slope = 2.0 * rate * mass + damping
    for _ in range(_SOLVES):
        before = x / np.linalg.norm(x)
        x = factors.solve(slope @ before)
    return rate - 1.0 / np.vdot(before, x), x


def _rigid_motions(mass: csr_array, stiffness: csr_array, count: int, shift: float) -> np.ndarray:
    """Return M-orthonormal vectors (n, count) with K x = 0; shift [1/s]: between the rates of these and of others."""
    factors = superlu(csc_array(stiffness + shift**2 * mass))
    x = np.random.default_rng(0).standard_normal((mass.shape[0], count))
    for _ in range(_SOLVES):
        x = orthonormal(factors.solve(mass @ x), mass)
    return x


def _slowest(mass: csr_array, stiffness: csr_array, rigid: int, resting: float) -> float:
    """Return the magnitude [1/s] of the slowest rate beside the rigid ones, whose squares are below `resting`."""
    heavy = mass.diagonal() > 0.0
    low, high = np.log(resting), np.log(4.0 * np.max(np.abs(stiffness.diagonal()[heavy]) / mass.diagonal()[heavy]))
    while high - low > np.log(4.0):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _between(mass, stiffness, np.exp(middle)) > rigid else (middle, high)
    return float(np.exp(0.5 * high))


def _between(mass: csr_array, stiffness: csr_array, size: float) -> int:
    """Return how many eigenvalues of K x = lambda M x are between -size and size, for a symmetric K."""
    above, below = (
        superlu(
            csc_array(stiffness + side * size * mass),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=1e-10,
            options={"SymmetricMode": True},
        ).U.diagonal()
        for side in (-1.0, 1.0)
    )
    return int((above < 0.0).sum()) - int((below < 0.0).sum())
