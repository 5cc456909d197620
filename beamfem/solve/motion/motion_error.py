"""Estimated discretisation error of a motion: its difference to that of an enriched model."""

import warnings
from collections.abc import Callable

import numpy as np

from beamfem.equations.system import system_of
from beamfem.model.model import Model
from beamfem.results.locking import locking
from beamfem.results.solution import Solution
from beamfem.solve.accuracy.adapted_mesh import Shares, require_unlocked
from beamfem.solve.accuracy.error_estimate import enriched, largest_displacement_error

MOST_MESHES = 8  # each costs two motions; those that are chaotic have an error on any of them
_MOST_ROWS = 50  # that are compared


def motion_attempt(model: Model, solve: Callable[[Model], Solution]) -> tuple[Solution, float, Shares]:
    """Return the motion of a model, and the largest change of a position relative to its size on the enriched space.

    If steps follow a tolerance, so that the rows of the two motions are at different times, the last ones are compared.
    Raises InputError for elements that lock.
    """
    with warnings.catch_warnings(action="ignore"):  # of motions that are not the result
        solution, finer = solve(model), solve(enriched(model))
    require_unlocked(solution.computed(locking))
    last = len(solution) - 1
    same = np.array_equal(solution.time, finer.time)
    rows = np.unique(np.linspace(0, last, _MOST_ROWS).astype(int)).tolist() if same else [last]
    pairs = [(row, row if same else len(finer) - 1) for row in rows]
    changes = [largest_displacement_error(solution[a], finer[b : b + 1], between_nodes=True) for a, b in pairs]
    return solution, max(changes) / system_of(model, static=False).extent, None
