"""Stages of a time step."""

from beamfem.kernels import model_passes
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import System
from beamfem.kernels.motion_record import MotionSolver
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows


@routine()
def assemble(system: System, solver: MotionSolver) -> None:
    """Fill the residual and, if needed, the matrix.

    With `rotations_wanted`, also fill the rotations of sections since the last tangent; a new tangent stores their
    directions first.
    """
    small_code()
    call = solver.routines
    kept, rotations, node = solver.kept_directions, solver.rotations, 0
    model_passes.clear(system)
    for number in range(system.group_count):
        group = system.groups[number]
        model_passes.add_group(group, system)
        if solver.rotations_wanted != 0:
            if system.tangent != 0:
                call.keep_directions(group, node, solver.node_stride, kept)
            call.rotations_since(group, node, solver.node_stride, kept, rotations)
        node += group.nodes
    model_passes.add_parts_at_points(system)


@routine()
def factorise(system: System, solver: MotionSolver) -> float:
    """Factor the tangent; return the smallest ratio of a pivot to the row's original diagonal entry."""
    if solver.bordered != 0:
        return solver.routines.factor_condensed(solver.border)
    return solver.routines.factor(solver.unknown, solver.half, solver.reach, solver.rows, solver.step)


@inlined
def _rotate_vectors(solver, sense):
    runs, count, stride = solver.pair_runs, solver.pair_run_count, solver.node_stride
    solver.routines.rotate_pairs(count, sense, runs, stride, solver.rotations, solver.right)


@inlined
def _fill_right(system, solver):
    """Fill the right-hand side with the residual of unknown coordinates, negative."""
    residual, right, unknown = system.residual, solver.right, solver.unknown
    if solver.first_free >= 0:
        lanes, source = as_rows(right), as_rows(at(residual, solver.first_free))
        whole = unknown // WIDTH * WIDTH
        for i in range(0, whole, WIDTH):
            lanes[i] = -source[i]
        for i in range(whole, unknown):
            right[i] = -residual[solver.first_free + i]
    else:
        free = solver.free_dofs
        for i in range(unknown):
            right[i] = -residual[free[i]]


@routine()
def solve(system: System, solver: MotionSolver) -> None:
    """Solve for the correction with the kept tangent, rotated with the sections; it replaces the right-hand side."""
    small_code()
    call = solver.routines
    unknown, rollers, right = solver.unknown, solver.rollers, solver.right
    first_of, normal = solver.roller_first, solver.roller_normal
    _fill_right(system, solver)
    if rollers > 0:
        call.rotate_in(rollers, first_of, normal, right)
    _rotate_vectors(solver, -1.0)
    if solver.bordered != 0:
        call.solve_condensed(solver.border, right)
    else:
        call.solve_both(unknown, solver.half, solver.rows, right)
    _rotate_vectors(solver, 1.0)
    if rollers > 0:
        call.rotate_back(rollers, first_of, normal, right)
