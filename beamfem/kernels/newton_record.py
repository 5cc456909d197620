"""The record that Newton's iteration for an equilibrium shares with Python: limits, and what it found."""

from typing import Annotated

from beamfem.kernels.record import Border, Solver
from beamfem.kernels.records import Reals, Record, calls

STALLED = 0.25  # of the correction before: a larger one no longer decreases, and if it is small it is round-off


class NewtonRoutines(Record):
    """The compiled functions that the iteration calls."""

    balance = calls("model_passes:balance")
    predict_resultants = calls("model_passes:predict_resultants")
    smallest_jacobian = calls("model_passes:smallest_jacobian")
    constrain_normals = calls("rollers:constrain_normals")
    rotate_in = calls("rollers:rotate_in")
    rotate_back = calls("rollers:rotate_back")
    factor = calls("band:ANY.factor")
    solve_upper = calls("band:ANY.solve_upper")
    take_step = calls("newton_loop:take_step")
    factor_condensed = calls("condensation:factor_condensed")
    solve_condensed = calls("condensation:solve_condensed")


class NewtonSolver(Solver):
    """Workspace of an iteration, its limits and what it found."""

    routines: NewtonRoutines
    prescribed_step: Annotated[Reals, "size"]
    prescribed_force: Annotated[Reals, "size"]
    linear: Annotated[Reals, "size"]
    bordered: int  # whether the band has a border
    border: Border

    # limits
    tolerance: float  # of a correction
    stagnant: float  # correction below which it may be stagnant
    divergent: float  # correction above which the iteration diverges
    pivot_ratio: float  # the smallest of a pivot to the row's original diagonal entry
    most_iterations: int
    predicted_resultants: int  # whether to take them for the geometric tangent
    # where the third tangent or a later one has another number, the iteration stops; -1: any number will do
    required_negative_pivots: int

    # what was found
    iterations: int  # so far
    correction: float  # size of the last one
    correction_before: float  # and of the one before
    # in the state reached: largest residual of the unknown and of all coordinates, times their scales, smallest r0' x d
    unbalanced: float
    force: float
    jacobian: float
    gap: float  # largest movement that a condition is away from being met
    negative_pivots: int  # of the last tangent
    first_correction: float  # its size
    negative_pivots_after_first: int  # those of the second tangent, which has the resultants of a linear step
