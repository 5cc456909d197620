"""The tangent condensed onto a few directions: a small matrix, smooth along a path, singular where the tangent is."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.solve.continuation.continuation import Continuation, PathPoint
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes


@dataclass(frozen=True, eq=False)
class Condensed:
    """Stiffness (k, k) against unit displacements along k directions, and the shapes (k, n + 1) they deform into."""

    stiffness: np.ndarray
    shapes: np.ndarray


def condensed(line: Continuation, point: PathPoint, directions: np.ndarray) -> Condensed:
    """Return the tangent K of a point condensed onto orthonormal directions D (k, n + 1), S = (D W K^-1 W D^T)^-1.

    W: the weights of the line. The shapes F = S D W K^-1 have D W F^T = 1 and are free of force elsewhere, so that
    S = F K F^T, which errors of F change in second order only; K is singular where S is. Raises LinAlgError.
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
