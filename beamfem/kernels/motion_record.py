"""The tables of numbers that time steps share with Python: the method, limits of the iteration, and statistics."""

from typing import NamedTuple

# ------------------------------------------------------------------ `RULE`
# parameters of the generalized-alpha method, as its `rule` returns them, and the order of this step's extrapolation
TIME_STEP, ALPHA_M, ALPHA_F, GAMMA, BETA, ORDER = range(6)
RULE_FIELDS = 6


# ------------------------------------------------------------------ `LIMITS`
class MotionLimits(NamedTuple):
    """Limits of the iteration of a time step.

    tolerance: of a correction, relative to the scale of a coordinate; iterations: the most that Newton's method may
    take; most: the most with a kept tangent, after which Newton's method starts the step anew; many, slow: number of
    them, or rate of convergence, above which the next step gets a new tangent.
    """

    tolerance: float = 1e-9
    iterations: int = 25
    most: int = 8
    many: int = 3
    slow: float = 0.05


LIMIT_FIELDS = len(MotionLimits._fields)
TOLERANCE, NEWTON_ITERATIONS, KEPT_TANGENT_ITERATIONS, MANY_ITERATIONS, SLOW_RATE = range(LIMIT_FIELDS)


# ------------------------------------------------------------------ `STATISTICS`
class MotionStatistics(NamedTuple):
    """Statistics of a motion, at first those of one that has not begun.

    iterations: of all steps; most_iterations: in one step; correction: size of the last one; pivot_ratio: the smallest
    ratio of a pivot to the row's original diagonal entry; rate: of convergence of the last step, negative if its
    tangent is of no use; tangents: how many were factorised; best_order: of the extrapolation, for the last step;
    known_differences: of p'', from which the next step extrapolates; change: what the last change of p'' changed in p;
    noise: size of corrections that are round-off.
    """

    iterations: float = 0.0
    most_iterations: float = 0.0
    correction: float = 0.0
    pivot_ratio: float = 1.0
    rate: float = -1.0
    tangents: float = 0.0
    best_order: float = 0.0
    known_differences: float = 0.0
    change: float = 0.0
    noise: float = 0.0


(
    ITERATIONS,
    MOST_ITERATIONS,
    CORRECTION,
    PIVOT_RATIO,
    RATE,
    TANGENTS,
    BEST_ORDER,
    KNOWN_DIFFERENCES,
    CHANGE,
    NOISE,
) = range(len(MotionStatistics._fields))
# those that say nothing about steps of another size, or after a jump of the acceleration
OF_EQUAL_STEPS = [RATE, BEST_ORDER, KNOWN_DIFFERENCES, CHANGE, NOISE]
