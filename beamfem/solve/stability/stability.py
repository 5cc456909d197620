"""Whether the rows of a static solution are stable."""

import numpy as np

from beamfem.assembly.equations import STATICS, linearise, with_stresses
from beamfem.assembly.system import System, system_of
from beamfem.precision.mixed_tangent import MixedTangent
from beamfem.precision.roundoff import counts_with_stresses
from beamfem.results.solution import Solution
from beamfem.solve.modes.modes import solve_modes

_MODES = 12  # lowest modes that are checked for flutter under follower loads


def stable_rows(solution: Solution) -> np.ndarray:
    """Return whether each row of a static solution is stable (steps,); see `Solution.stable`."""
    system = system_of(solution.model, static=True)
    if system.symmetric:
        mixed = len(solution) > 0 and counts_with_stresses(system, solution.p[-1], float(solution.at[-1]))
        counts = (unstable_directions(system, p, at, mixed) for p, at in zip(solution.p, solution.at, strict=True))
        return np.array([count == 0 for count in counts])
    count = min(_MODES, len(system.free_dofs))
    return np.array([_none_grows(solution, row, count) for row in range(len(solution))])


def unstable_directions(system: System, p: np.ndarray, load_factor: float, mixed: bool) -> int:
    """Return how many eigenvalues of the tangent are negative in the state p (n,); mixed: with stress resultants."""
    zeros = np.zeros(len(p))
    tangent = linearise(system, p, zeros, zeros, load_factor, STATICS)[1]
    if mixed and not isinstance(tangent, MixedTangent):
        tangent = with_stresses(system, (p, zeros, zeros), load_factor, STATICS, None, tangent)
    return tangent.factorised(system.rotated).negative_pivots


def _none_grows(solution: Solution, row: int, count: int) -> bool:
    return not np.any(solve_modes(solution.model, count, about=solution[row]).growth > 0.0)
