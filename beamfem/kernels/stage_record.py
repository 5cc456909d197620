"""The records that time steps of a method with stages share with Python."""

from typing import Annotated

from beamfem.kernels.conserving_step import Conserving
from beamfem.kernels.records import Reals, Record, calls


class StageRoutines(Record):
    """The compiled functions that such a step calls."""

    predict = calls("stage_steps:predict")
    residual = calls("stage_steps:residual")
    factorise = calls("stage_steps:factorise")
    solve = calls("stage_steps:solve")
    correct = calls("stage_steps:correct")
    complete = calls("stage_steps:complete")
    accelerate = calls("stage_steps:accelerate")
    iterate = calls("stage_steps:iterate")
    accelerate_stage = calls("explicit_steps:accelerate_stage")
    factor_planes = calls("stage_steps:factor_planes")
    solve_planes = calls("stage_steps:solve_planes")
    factor_complex = calls("complex_band:ANY.factor")
    solve_complex = calls("complex_band:ANY.solve")


class Stages(Record):
    """A method of s stages, and its steps: accelerations a_j of the stages, p_i = p + c_i h v + h^2 A^2 a.

    If the beginning is a stage besides, as of `Bathe`, its share is `of_begin` times p'' there.

    Planes are the real numbers that the transformed stages consist of: one for a real eigenvalue of A, which comes
    first, two for each complex pair, real and imaginary part.
    """

    routines: StageRoutines
    conserving: Conserving  # of steps that conserve energy and momenta
    stages: int  # s
    real: int  # number of real eigenvalues
    samples: int  # rows of loads and prescribed coordinates of a step: the stages, and its end unless it is the last
    first: int  # of the steps to take
    steps: int
    stride: int  # padded(n)
    height: int  # padded(unknown)
    time_step: float
    elapsed: float  # since the beginning of the step, where `accelerate` is asked for accelerations
    nodes: Annotated[Reals, "stages"]  # c
    of_p: Annotated[Reals, "stages", "stages"]  # h^2 A^2
    of_v: Annotated[Reals, "stages", "stages"]  # h A
    of_begin: Annotated[Reals, "stages", 2]  # of p'' at the beginning, in p and p' of the stages
    at_end: Annotated[Reals, 3, "stages"]  # h^2 b A, h b, and the polynomial of accelerations at the end
    ahead: Reals  # (s, s + 1): that through the stages and the end, at the stages of the next step, equal to this one
    into: Annotated[Reals, "stages", "stages"]  # planes of stages
    back: Annotated[Reals, "stages", "stages"]  # stages of planes, times A^2
    to_accelerations: Annotated[Reals, "stages", "stages"]  # inverse of A^2
    weights: Annotated[Reals, "stages", 3]  # of p, p' and p'' in the tangent of each plane

    # limits and estimates of iterations
    error_factor: float  # error of a step by the size of its first correction: factor size^power
    error_power: float
    accuracy: float  # error of an iteration, of the model, where it is given
    per_work: float  # 1 / (mass of the model times the square of its size), where it is given
    work: float  # of the forces before a correction on it
    kept_rate: float  # of convergence, above which the next step gets new tangents
    rate: float  # of the last step
    iteration: int
    known: int  # whether `a` has the accelerations of the last step
    factored: int
    solved: int  # whether `p`, `v` and `a` have those of the next step already

    begin: Annotated[Reals, 3, "stride"]
    p: Annotated[Reals, "stages", "stride"]
    v: Annotated[Reals, "stages", "stride"]
    a: Annotated[Reals, "stages", "stride"]
    last: Annotated[Reals, "stages", "stride"]
    change: Annotated[Reals, "stages", "stride"]
    forces: Annotated[Reals, "stages", "height"]  # out of balance
    right: Annotated[Reals, "stages", "height"]
    planes: Annotated[Reals, "stages", "height"]
    entries: int
    turned: int  # 2 node_stride
    matrices: Annotated[Reals, "stages", "entries"]
    rotations: Annotated[Reals, "stages", "turned"]  # of sections since the last tangent, see `MotionSolver`


class DoubledRoutines(Record):
    """The compiled functions that such pairs of steps call."""

    sample = calls("doubled_steps:sample_nothing")
    resize = calls("doubled_steps:resize")
    look_ahead = calls("doubled_steps:look_ahead")
    take_pair = calls("doubled_steps:take_pair")
    compare = calls("doubled_steps:compare")
    difference = calls("doubled_steps:difference")


class Doubled(Record):
    """Pairs of steps whose size follows their error, and a step of double size beside each pair, which estimates it.

    Both are of one method; what it needs for a step of 1 is kept for steps of any size.
    """

    routines: DoubledRoutines
    fine: Stages
    coarse: Stages
    fine_directions: Reals  # see `MotionSolver.kept_directions`
    coarse_directions: Reals
    varies: int  # whether loads, or prescribed coordinates, have to be sampled for each pair

    of_p: Reals  # A^2
    of_v: Reals  # A
    of_begin: Reals  # (s, 2)
    at_end: Reals  # (3, s)
    weights: Reals  # (s, 3)
    shares: Reals  # (samples,): times within a step
    gathered: Reals  # (2, s, s): polynomial through the stages of both steps, at those of the double one

    time: float
    end: float
    step: float  # of the next steps
    before: float  # that of the last ones, 0 if there are none
    ratio: float  # of both, for which accelerations are extrapolated
    shortest: float
    longest: float
    duration: float  # of the motion
    rate: float  # error of positions per time, of the model, that is allowed
    saved: float  # error of earlier steps that was allowed and not made, which one step may make at once
    most_saved: float
    divisor: float  # of the difference, for the error of the pair
    power: float  # of the step that the error per time is proportional to
    refused: int
    failed: int  # whether the shortest step does not converge
    filled: int  # rows
    room: int
    ends: Reals  # (room + 1,): times of rows
    scale: Reals  # (padded(n),): 1 / size of the model for positions, else 0
    at_begin: Reals  # (4, n): at the beginning of a pair
    turned: Reals  # (rotation_count,)
