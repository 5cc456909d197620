"""Switching from a path to the branch that crosses at a bifurcation."""

from collections.abc import Callable

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.results.path import Bifurcation
from beamfem.solve.continuation.continuation import Continuation, PathPoint

_FIRST_MODE = 0.02  # distance along the mode of the first search: lengths of the model, radians
_TRIES = 20
_ALIKE = 0.1  # [rad]: directions within this angle are the same, since branches bend
_ALONG = 1e-3  # of a mode: a smaller component normal to the path means that the path is tangential to it


def leave(
    line: Continuation, bifurcation: Bifurcation, direction: int, passed: Callable[[PathPoint], bool]
) -> PathPoint | str:
    """Return a point of the branch close to a bifurcation, or why there is none.

    passed: whether a point lies beyond the end of the path; then one closer to the bifurcation is looked for.
    It is the equilibrium in the plane normal to the mode at a small distance along it. The component of the mode along
    the path that was followed is removed, so that this path does not meet the plane. If several modes become soft at
    once, branches leave along some of their combinations only; an equilibrium found in the same direction at two
    distances is on a branch that starts here, however far it is from the mode.
    """
    start = np.append(bifurcation.p, bifurcation.at)
    try:
        way = direction * _other_way(line, start, bifurcation)
    except LinAlgError:
        return "the tangent is singular"
    distance, reason = _FIRST_MODE, ""
    others: list[np.ndarray] = []  # equilibria found away from the mode
    for _ in range(_TRIES):
        step = distance * way
        corrected = line.correct(start + step, line.stresses(start, step), way)
        reason = corrected.ended.value
        if corrected.ended.good:
            moved = corrected.y - start
            if line.length(moved) < 2.0 * distance:
                equilibria = [corrected.y]
            else:
                reason = "the equilibrium beside it is far away"
                equilibria = [y for y in others if _same_way(line, y - start, moved)]
                others.append(corrected.y)
            try:
                if equilibria:
                    found = line.linearised(equilibria[0], equilibria[0] - start)
                    if not passed(found):
                        return found
                    reason, others = "the path ends next to the bifurcation", []
            except LinAlgError:
                reason = "the tangent is singular"
        distance *= 0.5
    return reason


def _same_way(line: Continuation, one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two changes of y (n + 1,) have the same direction."""
    difference = one / line.length(one) - other / line.length(other)
    return line.length(difference) < _ALIKE


def _other_way(line: Continuation, start: np.ndarray, bifurcation: Bifurcation) -> np.ndarray:
    """Return the unit change of y (n + 1,) that is normal to the path and keeps the balance to first order.

    It is along the mode or, if the path itself is, towards larger load factors. Raises LinAlgError.
    """
    along = bifurcation.tangent / line.length(bifurcation.tangent)
    mode = np.append(bifurcation.mode, 0.0)
    mode /= line.length(mode)
    across = mode - line.dot(mode, along) * along
    if line.length(across) < _ALONG:
        growing = np.zeros(len(start))
        growing[-1] = 1.0
        across = line.linearised(start, growing).tangent
        across = across - line.dot(across, mode) * mode
    return np.asarray(across / line.length(across))
