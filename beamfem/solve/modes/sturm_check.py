"""Whether the lowest eigenvalues found are complete, by counts of pivots."""

from dataclasses import dataclass

import numpy as np

from beamfem.precision.roundoff import LOSES
from beamfem.solve.modes.pencil import Pencil

_CLUSTER = 1e-9  # eigenvalues with a smaller relative distance cannot be counted separately


@dataclass(frozen=True)
class Complete:
    """The first `found` eigenvalues are the lowest if none is `missing` below the value of a cut."""

    found: int
    missing: int
    cut: float


def complete(pencil: Pencil, squares: np.ndarray, count: int, rigid: int) -> Complete:
    """Return whether at least the first `count` of ascending eigenvalues (m,), m > count, are the lowest ones.

    rigid: number of zero eigenvalues besides. The eigenvalues below the largest gap after the last one are counted. If
    there is no gap, or some are missing, the last one may belong to a cluster with more members than were asked for:
    it then does not matter which of them are found, so those below the cluster are counted.
    """
    joined = np.diff(squares) <= _CLUSTER * np.abs(squares[1:])
    above = count + int(np.argmax(np.diff(squares[count - 1 :])))
    if not joined[above - 1]:
        cut = 0.5 * (squares[above - 1] + squares[above])
        if _below(pencil, squares, cut, rigid) == above:
            return Complete(above, 0, cut)
    gaps = np.flatnonzero(~joined) + 1
    first, end = gaps[gaps < count].max(initial=0), gaps[gaps >= count].min(initial=len(squares))
    cut = squares[first] - _CLUSTER * abs(squares[first])
    if first > 0:
        cut = max(cut, 0.5 * (squares[first - 1] + squares[first]))
    return Complete(int(end), _below(pencil, squares, cut, rigid) - int(first), cut)


def _below(pencil: Pencil, squares: np.ndarray, cut: float, rigid: int) -> int:
    """Return how many eigenvalues there are below a cut, without the zero ones.

    The round-off of the plain tangent moves its eigenvalues, so that those near the cut would be counted at random.
    """
    near = np.abs(squares - cut).min() <= LOSES * abs(cut)
    return (pencil.below_exactly(cut) if near else pencil.below(cut)) - (rigid if cut > 0.0 else 0)
