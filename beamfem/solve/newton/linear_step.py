"""Prediction of linearised stability for a load step."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.equations import linearise_after
from beamfem.assembly.system import System


def count_after(system: System, start: np.ndarray, step: np.ndarray, load_factor: float) -> int:
    """Return the negative pivots of the tangent in `start` (n,) with the stress resultants of a linear step (n,).

    The shape after the step may be far off, so that the count of its tangent says nothing. -1 if it is singular.
    """
    try:
        return linearise_after(system, start, step, load_factor).factorised(system.rotated).negative_pivots
    except LinAlgError:
        return -1
