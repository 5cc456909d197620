"""The stages of a step that conserves energy and momenta, for `stage_steps.march_stages`: Newton's method."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.model_record import System
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at
from beamfem.kernels.stage_record import Stages
from beamfem.kernels.time_loop import load_row

ITERATIONS = 30
_TOLERANCE = 1e-13  # of the model: a correction that ends an iteration
_NOISE = 1e-10  # of the model: smaller corrections that no longer decrease are round-off
_LARGEST = 1e100  # of the model
_HALF_TURN = 3.14  # [rad]: sections turn by less, as their mean directors vanish at half turns, and their balance does


@routine()
def predict(system: System, solver: MotionSolver, stages: Stages, step: int, attempt: int) -> None:
    """Begin with p at the end by p', or with p at the start, as vibrations that the step does not resolve mislead."""
    own, n, begin = stages.conserving, solver.size, stages.begin
    load_row(system, solver, step * stages.samples)
    own.load = at(own.loads, own.size * step if solver.varies != 0 else 0)
    for k in range(n):
        own.p[k], own.v[k] = begin[k], begin[stages.stride + k]
    own.place_vectors(own, 0)
    for k in range(n):
        if attempt == 0:
            own.p[k] += own.time_step * own.v[k]
        else:
            own.v[k] = -own.v[k]


@routine()
def iterate(system: System, solver: MotionSolver, stages: Stages, step: int, fresh: int) -> int:
    """Find p and p' at the end of a step; return whether that succeeds."""
    own, unknown, free, size = stages.conserving, solver.unknown, solver.free_dofs, 0.0
    if unknown == 0:
        return 1
    for iteration in range(ITERATIONS):
        own.place_vectors(own, 1)
        own.balance(own)
        if not own.correct(own) > 0.0:
            return 0
        before, size = size, 0.0
        for k in range(unknown):
            change = own.left[k]
            own.p[free[k]] += change
            own.v[free[k]] += own.left[unknown + k]
            change = abs(change) * solver.inverse_scale[free[k]]
            if not change < _LARGEST:
                return 0
            size = max(size, change)
        solver.statistics.iterations += 1
        solver.statistics.correction = size
        if size <= _TOLERANCE or (iteration > 0 and size <= _NOISE and size > 0.5 * before):
            for k in range(own.angle_count):
                angle = own.angles[k]
                if abs(own.p[angle] - stages.begin[angle]) > _HALF_TURN:
                    return 0
            return 1
    return 0


@routine()
def complete(system: System, solver: MotionSolver, stages: Stages, step: int) -> None:
    """Set the state to that at the end of the step."""
    own, n, state = stages.conserving, solver.size, solver.state
    for k in range(n):
        state[k], state[n + k], state[2 * n + k] = own.p[k], own.v[k], 0.0
    load_row(system, solver, step * stages.samples + 1)
    stages.routines.accelerate(system, solver, stages)
    for k in range(n):
        state[3 * n + k] = state[2 * n + k]
