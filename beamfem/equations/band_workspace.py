"""Workspace of the compiled Newton iteration with a band matrix, reused by the next solve of the same model."""

from collections.abc import Callable
from functools import cache
from typing import Any

from beamfem.equations.assembler import Scratch, lend_scratch, take_back_scratch
from beamfem.equations.equations import STATICS
from beamfem.equations.motion_workspace import border_record
from beamfem.equations.system import System
from beamfem.kernels.band import band
from beamfem.kernels.newton_loop import NewtonRoutines, NewtonSolver
from beamfem.kernels.records import aligned

_KEPT = 100_000  # entries of the largest tangent for which allocation is a noticeable part of a solve


def newton_solver(system: System) -> NewtonSolver:
    """Return the solver of a model without workspace."""
    fields, scale = system.solver_fields, system.scale.copy()
    scale[system.connectors.every_multiplier] = 0.0  # their rows are no forces
    return NewtonSolver(routines=_routines(fields["half"]), **fields | {"scale": scale})


@cache
def _routines(half_width: int) -> NewtonRoutines:
    own = band(half_width)
    return NewtonRoutines.usual(factor=own.factor, solve_upper=own.solve_upper)


class BandWorkspace:
    """Workspace for one static solve with a band matrix; p, residual (n,): those of the state reached."""

    def __init__(self, system: System) -> None:
        self.assembler = system.assembler(shared=True)
        self.assembler.weigh(STATICS)
        self.assembler.require("tangent", "prediction")
        self.solver, unknowns = system.table(newton_solver).copy(), system.unknowns
        own = self.solver
        n, declared = (own.size,), own.shapes("right", "prescribed_step", "prescribed_force", "linear")
        room = aligned({"p": n, "residual": n, "step": n, "rows": (unknowns.entries,), **declared})
        self.p, self.residual = room.pop("p"), room.pop("residual")
        own.fill(**room)
        self.assembler.place(self.p, own.step, own.step, self.residual, own.rows)
        if unknowns.border_size:
            own.bordered, own.border = 1, border_record(system, own.rows)

    def call(self, driver: Callable[..., Any]) -> Any:
        """Call a compiled driver and return its result. Raises the first error in what it has called in Python."""
        return self.assembler.call(driver, self.assembler.record.address, self.solver.address)

    def return_scratch(self, system: System) -> None:
        """Return the scratch memory, and keep the workspace for the next solve if it is small."""
        take_back_scratch(self._scratch)
        if self.solver.rows.size <= _KEPT:
            system.spare(BandWorkspace).append(self)

    def take(self, shared: Scratch) -> None:
        """Use shared scratch memory until `return_scratch`."""
        self._scratch = shared
        self.assembler.work_in(shared)


def band_workspace(system: System) -> BandWorkspace:
    """Return a workspace that no other solve uses."""
    try:
        workspace: BandWorkspace = system.spare(BandWorkspace).pop()
    except IndexError:
        workspace = BandWorkspace(system)
    workspace.take(lend_scratch(workspace.assembler.scratch))
    return workspace
