"""Limits of the iteration of a time step."""

import numpy as np

ITERATIONS = 25
TOLERANCE = 1e-9  # of a correction, relative to the scale of a coordinate


def not_converged(statistics: np.ndarray) -> str:
    """Return why a step has failed; statistics (10,): see `kernels.march.march`."""
    return (
        f"the last correction was {statistics[2]:.2e} of the model after {ITERATIONS} iterations at most. "
        "A smaller step may help"
    )
