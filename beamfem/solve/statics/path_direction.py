"""Whether a load step lies along the tangents of the path at both its ends."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import STATICS, linearise, load_slope
from beamfem.assembly.system import System
from beamfem.solve.continuation.steps import leaves_arc

# of the lesser rise of the load per movement at the ends of a step: with less in between it may fall there
_FRACTION = 0.3
_SLOPE_WIDTH = 1e-3  # of the load step; loads are evaluated within it only, since functions may end with it


def leaves_path(system: System, start: tuple[np.ndarray, float], end: tuple[np.ndarray, float]) -> bool:
    """Return whether no smooth path leads from one equilibrium, p (n,) and its load factor, to another.

    Along an arc the chord deviates from the tangents at its ends by half the angle between them; between states on two
    pieces of a path, on either side of limit points, it deviates from one of them by more. Where a short snap leads on
    in the same direction, the load rises less over the step than at both its ends, see `_dips`.
    """
    (p, before), (q, after) = start, end
    width = _SLOPE_WIDTH * (after - before)
    try:
        first = _tangent(system, p, before, before + width, width)
        last = _tangent(system, q, after, after - width, width)
    except LinAlgError:
        return True
    chord = (q - p) / system.scale
    turn = _angle(first, last)
    if any(leaves_arc(_angle(chord, tangent), turn) for tangent in (first, last)):
        return True
    along = [(after - before) * float(chord @ tangent) for tangent in (first, last)]
    return min(along) > 0.0 and _dips(*(float(chord @ chord) / each for each in along))


def _dips(first: float, last: float) -> bool:
    """Return whether the load falls, or nearly does, on a cubic with these slopes at its ends and a mean slope of 1.

    Only a structure that is softer in between than at both ends is meant: where it softens or stiffens all the way,
    one slope is below the mean.
    """
    if min(first, last) <= 1.0:
        return False
    return first - (2.0 * first + last - 3.0) ** 2 / (3.0 * (first + last - 2.0)) < _FRACTION * min(first, last)


def _tangent(system: System, p: np.ndarray, load_factor: float, middle: float, width: float) -> np.ndarray:
    """Return the scaled derivative of p (n,) by the load factor, by a difference centred at `middle`."""
    zeros, prescribed = np.zeros(len(p)), system.prescribed_dofs
    _, stiffness = linearise(system, p, zeros, zeros, load_factor, STATICS)
    result = np.zeros(len(p))
    slope = load_slope(system, p, middle, width)[system.free_dofs]
    result[system.free_dofs] = stiffness.factorised(system.rotated).solve(-slope)
    change = system.prescribed_values(middle + width) - system.prescribed_values(middle - width)
    result[prescribed] = change / (2.0 * width)
    if not np.isfinite(result).all():
        raise LinAlgError("the tangent is singular")
    return result / system.scale


def _angle(a: np.ndarray, b: np.ndarray) -> float:
    """Return the angle [rad] between two changes (n,), zero if one of them vanishes."""
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(np.arccos(np.clip(float(a @ b) / size, -1.0, 1.0))) if size > 0.0 else 0.0
