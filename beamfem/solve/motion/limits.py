"""Limits of the iteration of a time step."""

from typing import NamedTuple

import numpy as np


class Limits(NamedTuple):
    """Limits of the iteration of a time step, in the order in which `kernels.march` reads them.

    tolerance: of a correction, relative to the scale of a coordinate; iterations: the most that Newton's method may
    take; most: the most with a kept tangent, after which Newton's method starts the step anew; many, slow: number of
    them, or rate of convergence, above which the next step gets a new tangent.
    """

    tolerance: float = 1e-9
    iterations: int = 25
    most: int = 8
    many: int = 3
    slow: float = 0.05


BAND = Limits()
SPARSE = Limits(most=24, many=16, slow=0.5)  # a factorisation costs as much as ten iterations
BORDERED = Limits(most=12, many=6, slow=0.2)  # with the tangents of connectors, as much as four


def not_converged(statistics: np.ndarray, limits: Limits) -> str:
    """Return why a step has failed; statistics (10,): see `kernels.march.march`."""
    return (
        f"the last correction was {statistics[2]:.2e} of the model after {limits.iterations} iterations at most. "
        "A smaller step may help"
    )
