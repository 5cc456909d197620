"""From a bifurcation onto the branch that crosses there."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.analysis.continuation import Continuation, PathPoint
from beamfem.path import Bifurcation

_FIRST_MODE = 0.02  # how far along the mode the branch is looked for first: lengths of the model, radians
_TRIES = 12


def leave(line: Continuation, bifurcation: Bifurcation, direction: int) -> PathPoint | str:
    """Return a point of the branch close to a bifurcation, or why there is none.

    It is the equilibrium in the plane across the mode at a small distance along it, which the path that was followed
    to the bifurcation does not meet: the part of the mode along that path is taken out.
    """
    start = np.append(bifurcation.p, bifurcation.at)
    along = bifurcation.tangent / line.length(bifurcation.tangent)
    mode = np.append(bifurcation.mode, 0.0)
    mode -= line.dot(mode, along) * along
    mode *= direction / line.length(mode)
    distance, reason = _FIRST_MODE, ""
    for _ in range(_TRIES):
        step = distance * mode
        corrected = line.correct(start + step, line.stresses(start, step), mode)
        reason = corrected.ended.value
        if corrected.ended.good:
            moved = corrected.y - start
            if line.length(moved) < 2.0 * distance:
                try:
                    return line.linearised(corrected.y, moved)
                except (LinAlgError, ValueError):
                    reason = "the tangent is singular"
            else:
                reason = "the equilibrium beside it is far away"
        distance *= 0.5
    return reason
