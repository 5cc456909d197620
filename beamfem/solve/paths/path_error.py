"""Estimated discretisation error of an equilibrium path: its distance from the path on an enriched space."""

import numpy as np

from beamfem.equations.system import system_of
from beamfem.results.locking import locking
from beamfem.results.path import Path
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics
from beamfem.solve.accuracy.adapted_mesh import Shares, require_unlocked
from beamfem.solve.accuracy.error_estimate import (
    carried_coordinates,
    carried_stresses,
    enriched,
    error_shares,
    largest_displacement_error,
)
from beamfem.solve.continuation.continuation import Continuation
from beamfem.solve.newton.newton import Newton

_MOST_ROWS = 24  # of a path whose errors are estimated


def path_attempt(path: Path) -> tuple[Path, float, Shares]:
    """Return a path, its largest estimated error [-], and the shares of the elements in it.

    The error is that of displacements relative to the size of the model, or that of load factors relative to the
    largest one. Each of some rows is corrected in the plane across the path, so that limit points do not amplify it.
    Raises InputError for elements that lock.
    """
    require_unlocked(path.computed(locking))
    model = enriched(path.model)
    system, newton = system_of(model, static=True), Newton()
    largest = float(np.abs(path.load_factor).max()) or 1.0
    line = Continuation(system, newton, largest, largest)
    rows = np.unique(np.linspace(0, len(path) - 1, _MOST_ROWS).round().astype(int)).tolist()
    points = [np.append(carried_coordinates(path[row], model), path[row].at) for row in rows]
    worst, shares = 0.0, None
    for number in range(1, len(rows)):
        chord = points[min(number + 1, len(rows) - 1)] - points[number - 1]
        state = path[rows[number]]
        stresses = carried_stresses(state, model)
        corrected = line.correct(points[number], stresses, chord / line.length(chord))
        if not corrected.ended.good:
            return path, np.inf, None
        p, at = corrected.y[:-1], float(corrected.y[-1])
        rest = np.zeros((1, model.size))
        summary = Statistics(corrected.iterations, 1, 0, "an equilibrium on the enriched space")
        finer = Solution(model, True, np.array([at]), p[None], rest, rest.copy(), summary)
        moved = largest_displacement_error(state, finer, between_nodes=True) / system.extent
        error = max(moved, abs(at - state.at) / largest)
        if error > worst:
            worst, shares = error, error_shares(state, finer)
    return path, worst, shares
