"""Find where on a path the tangent is singular."""

import numpy as np

from beamfem.analysis.lost_stiffness import Start
from beamfem.analysis.primary_path import PathEndsError, PrimaryPath

_NEAR = 1e-4  # of the way from the start: a sample this near to the critical load is still well conditioned
_LAST = (-2.0, -1.0, 1.0, 2.0)  # where samples are taken in the end, in units of _NEAR
_TRIALS = 60


def critical_load(path: PrimaryPath, start: Start, number: int, guess: float, count: int) -> float:
    """Return the load factor at which the share of stiffness lost, counted from 0 by `number`, is 1.

    No equilibrium is solved for at the critical load itself, where round-off could lead off the path: the load is
    interpolated over the share, at last between samples on both sides. Raises PathEndsError.
    """
    begin = path.found[0].load_factor
    loads, shares = [begin], [0.0]
    trial = guess
    low, high = begin, np.inf
    for _ in range(_TRIALS):
        near = np.abs(np.array(loads) - trial) < 0.5 * _NEAR * (trial - begin)
        if np.any(near) and len(loads) > 1:
            break
        share = _share(path, start, trial, number, count)
        loads.append(trial)
        shares.append(share)
        low, high = (max(low, trial), high) if share < 1.0 else (low, min(high, trial))
        trial = _interpolated(loads, shares)
        if not low < trial < high:
            trial = 0.5 * (low + high) if np.isfinite(high) else begin + 2.0 * (low - begin)
    else:
        raise PathEndsError
    samples = [trial + offset * _NEAR * (trial - begin) for offset in _LAST]
    return _interpolated(samples, [start.lost_by_mode(path.reach(at).p, at, number) for at in samples])


def _share(path: PrimaryPath, start: Start, load_factor: float, number: int, count: int) -> float:
    return float(start.lost(path.reach(load_factor).p, load_factor, count)[number])


def _interpolated(loads: list[float], shares: list[float]) -> float:
    """Return the load at which the share is 1, from the four samples nearest to it."""
    from scipy.interpolate import krogh_interpolate  # slow to import

    near = np.argsort(np.abs(np.array(shares) - 1.0))[:4]
    return float(krogh_interpolate(np.array(shares)[near], np.array(loads)[near], 1.0))


def load_of_limit_point(path: PrimaryPath, start: Start) -> float | None:
    """Return the load factor at which the path turns back, None where stiffness is left at its end.

    There (1 - share)^2 goes to zero in proportion to the distance of the load.
    """
    last = path.found[-1]
    if len(path.found) < 2:
        return None
    earlier = path.found[-2]
    left = [1.0 - start.lost(at.p, at.load_factor, 1)[0] for at in (earlier, last)]
    if not 0.0 < left[1] < min(left[0], 0.1):
        return None
    ratio = (left[0] / left[1]) ** 2
    return last.load_factor + (last.load_factor - earlier.load_factor) / (ratio - 1.0)
