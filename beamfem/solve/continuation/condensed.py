"""The tangent condensed onto a few directions: a small matrix, smooth along a path, singular if the tangent is."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.solve.continuation.continuation import Continuation, PathPoint
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes


@dataclass(frozen=True, eq=False)
class Condensed:
    """Stiffness (k, k) against unit displacements along k directions, and the deformed shapes (k, n + 1) they cause."""

    stiffness: np.ndarray
    shapes: np.ndarray


def condensed(line: Continuation, point: PathPoint, directions: np.ndarray) -> Condensed:
    """Return the tangent K of a point condensed onto orthonormal directions D (k, n + 1), S = (D W K^-1 W D^T)^-1.

    W: the weights of the continuation. The shapes F = S D W K^-1 satisfy D W F^T = 1 and need no other forces, so that
    S = F K F^T, in which errors of F are of second order; K is singular exactly where S is. Raises LinAlgError.
    """
    free = line.system.free_dofs
    forces = (line.weights * directions)[:, free]
    moved = np.array([point.factors.solve(force) for force in forces])
    if not np.isfinite(moved).all():
        raise LinAlgError("the tangent is singular")
    # transposed, because K need not be symmetric
    stiffness = np.linalg.inv((forces @ moved.T).T)
    shapes = np.zeros(directions.shape)
    shapes[:, free] = stiffness @ moved
    if line.system.symmetric:
        stiffness = stiffness_of_modes(line.system, point.y[:-1], point.load_factor, shapes[:, :-1])
    return Condensed(stiffness, shapes)
