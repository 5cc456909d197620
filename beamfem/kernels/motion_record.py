"""The records that time steps share with Python: the method, limits of the iteration, and statistics."""

from typing import Annotated

from beamfem.kernels.model_record import Solver
from beamfem.kernels.records import Reals, Record, Several, Wholes, calls


class Rule(Record):
    """Parameters of the generalized-alpha method, as its `rule` returns them, and the order of the extrapolation."""

    time_step: float
    alpha_m: float
    alpha_f: float
    gamma: float
    beta: float
    order: float


class MotionLimits(Record):
    """Limits of the iteration of a time step.

    tolerance: of a correction, relative to the scale of a coordinate; iterations: the most that Newton's method may
    take; most: the most with a kept tangent, after which Newton's method starts the step anew; tangent: how many
    iterations a new tangent costs.
    """

    tolerance: float = 1e-9
    iterations: int = 25
    most: int = 8
    tangent: float = 3.0


class MotionStatistics(Record):
    """Statistics of a motion, at first those of one that has not begun.

    iterations: of all steps; most_iterations: in one step; correction: size of the last one; pivot_ratio: the smallest
    ratio of a pivot to the row's original diagonal entry; rate: of convergence of the last step, negative if its
    tangent is of no use; tangents: how many were factorised; best_order: of the extrapolation, for the last step;
    known_differences: of p'', from which the next step extrapolates; change: what the last change of p'' changed in p;
    noise: size of corrections that are round-off; spent: iterations since the last tangent, with those that it cost,
    in `lived` steps.
    """

    iterations: int = 0
    most_iterations: int = 0
    correction: float = 0.0
    pivot_ratio: float = 1.0
    rate: float = -1.0
    tangents: int = 0
    best_order: float = 0.0
    known_differences: float = 0.0
    change: float = 0.0
    noise: float = 0.0
    spent: float = 0.0
    lived: int = 0

    def begin_anew(self) -> None:
        """Forget what says nothing about steps of another size, or after a jump of the acceleration."""
        self.rate, self.best_order, self.known_differences, self.change, self.noise = -1.0, 0.0, 0.0, 0.0, 0.0


class PairRun(Record):
    """Vectors that rotate with their section: x and y of the first are the unknowns with the numbers x and y.

    node: of the first, and one more for each of the next; step: from one number to the next.
    """

    x: int
    y: int
    node: int
    step: int
    length: int


class MotionRoutines(Record):
    """The compiled functions that time steps call."""

    predict_resultants = calls("model_passes:predict_resultants")
    smallest_jacobian = calls("model_passes:smallest_jacobian")
    constrain_normals = calls("rollers:constrain_normals")
    rotate_in = calls("rollers:rotate_in")
    rotate_back = calls("rollers:rotate_back")
    factor = calls("bidirectional_lu:ANY.factor")  # from both ends, see `bidirectional_lu`
    solve_both = calls("bidirectional_lu:ANY.solve")
    factor_condensed = calls("condensation:factor_condensed")
    solve_condensed = calls("condensation:solve_condensed")
    keep_directions = calls("motion_steps:keep_directions")
    rotations_since = calls("motion_steps:rotations_since")
    rotate_pairs = calls("motion_steps:rotate_pairs")
    count_rotations = calls("motion_steps:count_rotations")
    # stages of a time step
    predict = calls("predictor:predict")
    assemble = calls("motion_stages:assemble")
    factorise = calls("motion_stages:factorise")
    solve = calls("motion_stages:solve")
    correct = calls("motion_steps:correct")
    complete = calls("predictor:complete")


class MotionSolver(Solver):
    """Workspace of time steps, and what they are asked for."""

    routines: MotionRoutines
    rule: Rule
    limits: MotionLimits
    statistics: MotionStatistics
    state: Annotated[Reals, 4, "size"]  # p, p', p'' and the auxiliary acceleration
    before: Annotated[Reals, 4, "size"]
    differences: Reals  # see `predictor.difference_rows`
    change: Reals  # (padded(n),): corrections, zero for prescribed coordinates
    prescribed: int
    prescribed_dofs: Annotated[Wholes, "prescribed"]
    prescribed_values: Annotated[Reals, "steps", 3, "prescribed"]
    prescribed_now: Reals  # (3, prescribed): in this step
    steps: int
    times: Reals  # (rows,) [s]
    now: int  # number of the step that is taken, of those of this call
    first_step: int
    every: int
    saved: Reals  # (rows, 3, n)
    remembers: int  # whether steps change the history variables of compiled parts
    varies: int  # whether loads vary from step to step
    body_size: int
    bodies: Reals  # (steps or 1, beams, 4)

    conditions: int  # number k of multipliers, which follow the unknowns of the band
    multipliers: Wholes  # (k,): their coordinates

    # vectors that rotate with their section
    pair_run_count: int
    pair_runs: Annotated[Several, PairRun]  # see `rotating_vectors.runs_of`
    node_stride: int
    kept_directions: Annotated[Reals, 2, "node_stride"]
    rotations: Annotated[Reals, 2, "node_stride"]
    rotations_wanted: int  # whether the stage computes how far sections have rotated since the last tangent

    # vectors whose rotation is counted
    rotation_count: int
    rotation_table: Annotated[Wholes, "rotation_count", 2]
    rotated_by: Annotated[Reals, "rotation_count"]
    saved_rotations: Reals  # (rows, counted)
