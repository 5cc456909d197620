"""The longest stable step of explicit methods, from the highest frequency of a model."""

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array
from scipy.sparse.linalg import eigsh

from beamfem.equations.equations import INERTIA, STATICS, linearise
from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.linalg.tangent import UNROTATED
from beamfem.solve.motion.stage_coefficients import Coefficients, Explicit, coefficients

_SAFETY = 0.8
_DENSE = 50  # unknowns up to which all frequencies are found
_ACCURACY = 1e-2  # of the square of the highest frequency
_GRID = 400  # points of step times frequency at which growth is looked for
_GROWTH = 1e-6


def stable_step(system: System, method: Explicit) -> float:
    """Return the longest step [s] of an explicit method in the reference at rest.

    With the highest w^2 of M w^2 = K, and the largest c of M c = D, no vibration x'' + c x' + w^2 x = 0 may grow.
    Raises InputError for conditions, which steps of explicit methods do not satisfy.
    """
    name, p, zeros = type(method).__name__, system.reference, np.zeros(system.model.size)
    if len(system.connectors.multipliers):
        raise InputError(
            f"{name} is explicit, and does not satisfy conditions of connectors such as links; use Radau()"
        )
    inertia, stiffness, damping = (
        csc_array(linearise(system, p, zeros, zeros, 0.0, weights)[1].sparse(UNROTATED))
        for weights in (INERTIA, STATICS, (0.0, 1.0, 0.0))
    )
    squares = _largest(stiffness, inertia)
    rate = _largest(damping, inertia) if damping.nnz and np.any(damping.data) else 0.0
    omega = np.sqrt(squares)
    return _SAFETY * _limit(coefficients(method), rate / omega) / omega


def _largest(matrix: csc_array, inertia: csc_array) -> float:
    """Return the largest eigenvalue of a symmetric matrix relative to the masses."""
    if matrix.shape[0] <= _DENSE:
        return float(eigh(matrix.toarray(), inertia.toarray(), eigvals_only=True)[-1])
    begin = np.random.default_rng(0).standard_normal(matrix.shape[0])
    found = eigsh(matrix, 1, inertia, which="LA", v0=begin, tol=_ACCURACY, return_eigenvectors=False)
    return float(found[0]) * (1.0 + _ACCURACY)


def _limit(rule: Coefficients, damping: float) -> float:
    """Return the largest step at which no vibration x'' + d x' + x = 0 grows, with a damping d.

    Where the last stage is the end of the step, the next one begins with its x'', which is by the x' of that stage.
    """
    steps = np.linspace(0.0, 10.0, _GRID + 1)[1:]
    s, continued = len(rule.nodes), len(rule.samples) == len(rule.nodes)
    for number, h in enumerate(steps.tolist()):
        # h^2 a = -h^2 x - h d (h x') of the stages, from x, h x' and h^2 x'' at the beginning
        right = np.array([np.full(s, -h * h), -h * h * rule.nodes - h * damping, np.zeros(s)]).T
        left = np.eye(s) + h * h * rule.of_p + h * damping * rule.of_v
        if continued:
            right[0], left[0] = (0.0, 0.0, 1.0), np.eye(s)[0]
        after = np.array([[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0] * 3]) + rule.at_end @ np.linalg.solve(left, right)
        if np.max(np.abs(np.linalg.eigvals(after))) > 1.0 + _GROWTH:
            return float(steps[max(number - 1, 0)])
    return float(steps[-1])
