"""Estimated discretisation error of a motion: its difference to that of an enriched model."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from beamfem.equations.system import system_of
from beamfem.model.model import Model
from beamfem.results.locking import locking
from beamfem.results.solution import Solution
from beamfem.solve.accuracy.adapted_mesh import Shares, require_unlocked
from beamfem.solve.accuracy.error_estimate import (
    enriched,
    error_shares,
    largest_position_error,
    position_shares,
    shares_of_rows,
)
from beamfem.solve.accuracy.quantity_change import Quantity, change_if_found
from beamfem.solve.motion.events import Event

MOST_MESHES = 8  # each costs two motions; those that are chaotic have an error on any of them
_MOST_ROWS = 50  # that are compared
_SHARING = 6  # of these, with the largest errors, in which elements have shares
LOOSE = 0.1  # of the accuracy: tolerance of the steps that is enough to find a mesh


def rows_of(motion: Solution, duration: float, events: Sequence[Event]) -> dict[str, Any]:
    """Return the arguments of `simulate` for a motion with the rows of another one, which no event ends."""
    return {
        "duration": duration, "save_at": motion.time, "events": [replace(event, stop=False) for event in events]
    }  # fmt: skip


def with_estimate_of(other: Solution, motion: Solution) -> Solution:
    """Return a motion that tells the estimated error of another one on the same mesh."""
    return motion.with_statistics(ended=f"{motion.statistics.ended}; {other.statistics.ended.rpartition('; ')[2]}")


def motion_attempt(
    model: Model, solve: Callable[[Model, Solution | None], Solution], quantity: Quantity = None
) -> tuple[Solution, float, Shares]:
    """Return the motion of a model, its estimated error [-], and the shares of the elements in it.

    The error is the largest change of a position on the enriched space, relative to the size of the model, or that of a
    quantity, relative to its largest value. solve: returns the motion of a model, with the rows of another motion if it
    is given. Raises InputError for elements that lock.
    """
    with warnings.catch_warnings(action="ignore"):  # of motions that are not the result
        solution = solve(model, None)
        finer = solve(enriched(model), solution)
    require_unlocked(solution.computed(locking))
    rows = np.unique(np.linspace(0, len(solution) - 1, _MOST_ROWS).astype(int)).tolist()
    pairs = [(solution[row], finer[row : row + 1]) for row in rows]
    moved = np.array([largest_position_error(*pair) for pair in pairs])
    worst = np.argsort(moved)[-_SHARING:]
    of_one = position_shares if quantity is None else error_shares
    shares = shares_of_rows([pairs[number] for number in worst], moved[worst], of_one)
    error = float(moved.max()) / system_of(model, static=False).extent
    return solution, error if quantity is None else change_if_found(solution, finer, quantity, error), shares
