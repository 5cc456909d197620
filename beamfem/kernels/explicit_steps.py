"""Time steps of explicit methods, many in one compiled call: each stage follows from those before it."""

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.model_record import System
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows, zeros
from beamfem.kernels.stage_record import Stages
from beamfem.kernels.stage_steps import end_step, place, start_step
from beamfem.kernels.time_loop import load_row

_FARTHEST = 1.0  # of the model: a step that moves it by more is unstable


@inlined
def _combine(stages, of_p, of_v, share, count, i):
    """Fill p and p' of a stage, at a share of the step, from the accelerations of the first ones."""
    stride, h = stages.stride, stages.time_step
    now, a, p, v = as_rows(stages.begin), as_rows(stages.a), as_rows(stages.p), as_rows(stages.v)
    for k in range(0, stride, WIDTH):
        at_p, at_v = now[k] + share * h * now[stride + k], zeros() + now[stride + k]
        for j in range(count):
            at_p += of_p[j] * a[j * stride + k]
            at_v += of_v[j] * a[j * stride + k]
        p[i * stride + k], v[i * stride + k] = at_p, at_v


@routine(fastmath=FAST)
def accelerate_stage(system: System, solver: MotionSolver, stages: Stages, step: int, i: int) -> None:
    """Fill p, p' and p'' of a stage."""
    small_code()
    n, s, stride, state = solver.size, stages.stages, stages.stride, solver.state
    _combine(stages, at(stages.of_p, i * s), at(stages.of_v, i * s), stages.nodes[i], i, i)
    p, v, a = at(stages.p, i * stride), at(stages.v, i * stride), at(stages.a, i * stride)
    for k in range(n):
        a[k] = 0.0
    load_row(system, solver, step * stages.samples + i)
    place(solver, stages, i)
    for k in range(n):
        state[k], state[n + k], state[2 * n + k] = p[k], v[k], a[k]
    stages.elapsed = stages.nodes[i] * stages.time_step
    stages.routines.accelerate(system, solver, stages)
    stages.elapsed = 0.0
    for k in range(n):
        a[k] = state[2 * n + k]


@routine(fastmath=FAST)
def march_explicit(system: System, solver: MotionSolver, stages: Stages) -> int:
    """March through steps from `state`, advanced in place; return how many were completed.

    The first stage is the beginning of the step, whose accelerations are known from the last one.
    """
    small_code()
    s, n, state, before = stages.stages, solver.size, solver.state, solver.before
    statistics, free = solver.statistics, solver.free_dofs
    for step in range(stages.first, stages.steps):
        start_step(solver, stages)
        for k in range(n):
            stages.a[k] = state[2 * n + k]
        for i in range(s):
            if i > 0 or (stages.known == 0 and solver.prescribed > 0):
                stages.routines.accelerate_stage(system, solver, stages, step, i)
                statistics.iterations += 1
        if stages.samples == s:  # accelerations at the end are those of the last stage
            last = s - 1
            _combine(stages, stages.at_end, at(stages.at_end, s), 1.0, s, last)
            place(solver, stages, last)
        stages.routines.complete(system, solver, stages, step)
        for k in range(solver.unknown):
            x = free[k]
            if not abs(state[x] - before[x]) * solver.inverse_scale[x] < _FARTHEST:
                for j in range(4 * n):
                    state[j] = before[j]
                return step
        end_step(system, solver, stages, step)
    return stages.steps
