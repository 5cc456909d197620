"""Workspace of the compiled Newton iteration with a band matrix, reused by the next solve of the same model."""

from collections.abc import Callable
from typing import Any

from beamfem.assembly import scratch_memory as scratch
from beamfem.assembly.applied_loads import LoadsAt
from beamfem.assembly.connector_equilibrium import ConnectedBalance
from beamfem.assembly.equations import STATICS
from beamfem.assembly.scratch_memory import Arena
from beamfem.assembly.system import System
from beamfem.kernels import newton_record, record
from beamfem.kernels.pointers import address_of

_KEPT = 100_000  # entries of the largest tangent for which allocation is a noticeable part of a solve


class BandWorkspace:
    """Workspace for one static solve with a band matrix, and the tables that describe it to compiled code.

    addresses: tables of the equations, the unknowns and the routines, the arguments of compiled drivers.
    """

    def __init__(self, system: System) -> None:
        n, unknown, half = system.model.size, len(system.free_dofs), system.layouts[0].half_width
        self.assembler = system.assembler(shared=True)
        self.assembler.weigh(STATICS)
        self.assembler.require("tangent", "prediction")
        self._room = Arena(
            {
                "p": (n,),
                "residual": (n,),
                record.STEP: (n,),
                record.PRESCRIBED_STEP: (n,),
                record.PRESCRIBED_FORCE: (n,),
                record.RIGHT: (unknown,),
                record.ROWS: (unknown, 2 * half + 1),
                record.LIMITS: (newton_record.LIMIT_FIELDS,),
                record.FOUND: (newton_record.FOUND_FIELDS,),
                record.LINEAR: (n,),
            }
        )
        arrays, addresses = self._room.arrays, self._room.addresses
        self.p, self.residual, self.step, self.limits = (
            arrays[name] for name in ("p", "residual", record.STEP, record.LIMITS)
        )
        self.found, self.linear = arrays[record.FOUND], arrays[record.LINEAR]
        self.prescribed_step, self.prescribed_force = arrays[record.PRESCRIBED_STEP], arrays[record.PRESCRIBED_FORCE]
        states = addresses.pop("p"), addresses[record.STEP], addresses[record.STEP]
        self.assembler.place_at(states, addresses.pop("residual"), addresses[record.ROWS], arrays[record.ROWS].size)
        routines = system.solver_table.routines(moving=False)
        self._connected = None
        if system.called.items:
            own = self.p, self.residual, arrays[record.ROWS]
            self._connected = ConnectedBalance(system, self.assembler, *own)
            routines = routines.copy()
            routines[record.BALANCE] = self._connected.address
        tables = system.solver_table.filled(addresses), routines
        self._tables, self.addresses = tables, (self.assembler.address, *map(address_of, tables))
        self._entries = arrays[record.ROWS].size

    def begin(self, loads: LoadsAt, load_factor: float) -> None:
        """Set the loads of an iteration."""
        self.assembler.take(loads)
        if self._connected is not None:
            self._connected.load_factor = load_factor

    def call(self, driver: Callable[..., Any]) -> Any:
        """Call a compiled driver and return its result. Raises errors of section laws and connectors in it."""
        caller = self.assembler if self._connected is None else self._connected
        return caller.call(driver, *self.addresses)

    def return_scratch(self, system: System) -> None:
        """Return the scratch memory, and keep the workspace for the next solve if it is small."""
        scratch.take_back(self._scratch)
        if self._entries <= _KEPT:
            system.spare.append(self)

    def take(self, shared: scratch.Scratch) -> None:
        """Use shared scratch memory until `return_scratch`."""
        self._scratch = shared
        self.assembler.work_in(shared)


def band_workspace(system: System) -> BandWorkspace:
    """Return a workspace that no other solve uses."""
    try:
        workspace: BandWorkspace = system.spare.pop()
    except IndexError:
        workspace = BandWorkspace(system)
    workspace.take(scratch.lend(workspace.assembler.scratch))
    return workspace
