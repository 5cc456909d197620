"""Workspace of compiled time steps, reused by the next motion of the same model."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from beamfem.assembly.rotating_vectors import runs_of
from beamfem.assembly.scratch_memory import Arena
from beamfem.assembly.system import System
from beamfem.kernels import motion_record, record
from beamfem.kernels.pointers import address_of
from beamfem.kernels.predictor import difference_rows, padded

_KEPT = 40_000_000  # entries of the largest tangent whose workspace is kept for the next motion of the model


class MotionWorkspace:
    """Workspace for one motion, and the tables that describe it to compiled code.

    arrays: by their fields in the table of the solver; residual, rows: addresses of the residual and of the matrix.
    """

    def __init__(self, system: System) -> None:
        size, unknown, unknowns = system.model.size, len(system.free_dofs), system.unknowns
        pairs, multipliers = runs_of(system.rotating), system.connectors.multipliers
        self.assembler, self._pairs = system.assembler(), pairs
        nodes = sum(int(work.table[record.NODES]) for work in self.assembler.works)
        first = unknowns.first
        in_place = first >= 0
        room = Arena(
            {
                "residual": (size,),
                record.ROWS: (unknowns.entries,),
                record.EDGE_COLUMNS: (len(unknowns.border), unknown),
                record.EDGE_FACTORS: (unknowns.border_size, unknowns.border_size + 1),
                **({} if in_place else {record.RIGHT: (unknown,)}),
                record.STEP: (max(size, unknown) + 2,),
                record.CHANGE: (padded(size),),
                record.BEFORE: (4, size),
                record.DIFFERENCES: (difference_rows(size),),
                record.INVERSE_SCALE: (padded(size),),
                record.KEPT: (2, nodes),
                record.ROTATIONS: (2, nodes),
                record.RULE: (motion_record.RULE_FIELDS,),
                record.LIMITS: (motion_record.LIMIT_FIELDS,),
            }
        )
        self.arrays, addresses = room.arrays, room.addresses
        self.arrays[record.INVERSE_SCALE][system.free_dofs] = 1.0 / system.scale[system.free_dofs]
        self.residual, self.rows = addresses.pop("residual"), addresses[record.ROWS]
        if in_place:  # unknowns in a row are solved for where the residual is
            addresses[record.RIGHT] = self.residual + 8 * first
            self.arrays[record.RIGHT] = self.arrays["residual"][first : first + unknown]
        self.solver = system.solver_table.filled(addresses)
        self._prescribed = system.prescribed_dofs
        self.solver[record.PAIR_TABLE] = address_of(pairs)
        self.solver[record.PRESCRIBED_DOFS] = address_of(self._prescribed)
        self.solver[record.RUNS_OF_PAIRS], self.solver[record.NODE_STRIDE] = len(pairs), nodes
        self.solver[record.PRESCRIBED] = len(self._prescribed)
        self._border, self._multipliers = np.ascontiguousarray(unknowns.border), multipliers
        self.solver[record.EDGE_NUMBERS] = address_of(self._border)
        self.solver[record.MULTIPLIERS] = address_of(self._multipliers)
        self.solver[record.BORDER] = self.rows + 8 * (unknowns.entries - unknowns.border_size**2)


@contextmanager
def motion_workspace(system: System) -> Iterator[MotionWorkspace]:
    """Lend a workspace that no other motion uses; what motions write into it is arbitrary at first."""
    try:
        space = system.spare_motions.pop()
    except IndexError:
        space = MotionWorkspace(system)
    yield space
    if space.arrays[record.ROWS].size <= _KEPT:
        space.assembler.unload()
        system.spare_motions.append(space)
