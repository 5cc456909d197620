"""Limits of the iteration of a time step."""

import numpy as np

from beamfem.kernels.motion_record import CORRECTION, MotionLimits

BAND = MotionLimits()
SPARSE = MotionLimits(most=24, many=16, slow=0.5)  # a factorisation costs as much as ten iterations
BORDERED = MotionLimits(most=12, many=6, slow=0.2)  # with the tangents of connectors, as much as four


def not_converged(statistics: np.ndarray, limits: MotionLimits) -> str:
    """Return why a step has failed; statistics: see `kernels.motion_record`."""
    return (
        f"the last correction was {statistics[CORRECTION]:.2e} of the model after {limits.iterations} iterations at "
        "most. A smaller step may help"
    )
