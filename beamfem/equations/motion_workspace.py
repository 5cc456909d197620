"""Workspace of compiled time steps, reused by the next motion of the same model."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

import numpy as np

from beamfem.equations.rotating_vectors import rotating_vectors, runs_of
from beamfem.equations.system import System
from beamfem.kernels.bidirectional_lu import SHORT, bidirectional_lu
from beamfem.kernels.model_record import Border
from beamfem.kernels.motion_record import MotionRoutines, MotionSolver
from beamfem.kernels.predictor import difference_rows, padded
from beamfem.kernels.records import aligned
from beamfem.kernels.stage_record import Stages
from beamfem.linalg import bordered

_KEPT = 40_000_000  # entries of the largest tangent whose workspace is kept for the next motion of the model


def motion_solver(system: System) -> MotionSolver:
    """Return the solver of a model without workspace."""
    fields, prescribed = system.solver_fields, system.prescribed_dofs
    routines = _routines(fields["half"], fields["unknown"] < SHORT)
    return MotionSolver(routines=routines, prescribed=len(prescribed), prescribed_dofs=prescribed, **fields)


@cache
def _routines(half_width: int, short: bool) -> MotionRoutines:
    own = bidirectional_lu(half_width, short)
    return MotionRoutines.usual(factor=own.factor, solve_both=own.solve)


def border_record(system: System, rows: np.ndarray) -> Border:
    """Return the workspace to factor the tangent of a model, a band with a border whose entries are all in `rows`."""
    unknowns, half = system.unknowns, system.layouts[0].half_width
    entries = rows[unknowns.entries - unknowns.border_size**2 :]
    border = bordered.Border(unknowns.border, len(system.connectors.multipliers), entries)
    return bordered.condensed_record(unknowns.banded, half, unknowns.reach, rows, border)


class MotionWorkspace:
    """Workspace for one motion; residual (n,): of the state reached; stages: of collocation, by method."""

    def __init__(self, system: System) -> None:
        unknowns, pairs = system.unknowns, runs_of(system.table(rotating_vectors))
        self.assembler, free, self.solver = system.assembler(), system.free_dofs, system.table(motion_solver).copy()
        own = self.solver
        own.node_stride = sum(work.record.nodes for work in self.assembler.works)
        first, size, unknown = own.first_free, own.size, own.unknown
        room = aligned(
            {
                "residual": (size,),
                "right": (unknown,) if first < 0 else (0,),
                "rows": (unknowns.entries,),
                "step": (max(size, unknown) + 2,),
                "change": (padded(size),),
                "differences": (difference_rows(size),),
                "inverse_scale": (padded(size),),
                **own.shapes("before", "kept_directions", "rotations"),
            }
        )
        room["inverse_scale"][free] = 1.0 / system.scale[free]
        room["inverse_scale"][system.connectors.multipliers] = 0.0  # round-off of accelerations grows in short steps
        self.residual, self.stages = room.pop("residual"), dict[object, Stages]()
        if first >= 0:  # unknowns in a row are solved for where the residual is
            room["right"] = self.residual[first : first + unknown]
        own.fill(pair_run_count=len(pairs), pair_runs=pairs, **room)
        own.multipliers = np.ascontiguousarray(system.connectors.multipliers)
        if unknowns.border_size:
            own.border = border_record(system, own.rows)
            own.border.fill(factor=own.routines.factor, solve=own.routines.solve_both)

    def unload(self) -> None:
        """Let go of the loads and the rows of a motion."""
        self.assembler.unload()
        self.assembler.record.forget("p", "v", "a")
        self.solver.forget("state", "bodies", "prescribed_values", "times")
        self.solver.forget("saved", "saved_rotations", "rotated_by", "rotation_table")
        self.stages = {rule: own for rule, own in self.stages.items() if own.matrices.size <= _KEPT}


@contextmanager
def motion_workspace(system: System) -> Iterator[MotionWorkspace]:
    """Lend a workspace that no other motion uses; what motions write into it is arbitrary at first."""
    try:
        space = system.spare(MotionWorkspace).pop()
    except IndexError:
        space = MotionWorkspace(system)
    yield space
    if space.solver.rows.size <= _KEPT:
        space.unload()
        system.spare(MotionWorkspace).append(space)
