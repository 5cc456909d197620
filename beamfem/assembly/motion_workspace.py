"""Workspace of compiled time steps, reused by the next motion of the same model."""

from collections.abc import Iterator
from contextlib import contextmanager

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
        size, unknown, half = system.model.size, len(system.free_dofs), system.layouts[0].half_width
        pattern, pairs = system.unknowns.pattern, runs_of(system.rotating)
        self.assembler, self._pairs = system.assembler(), pairs
        nodes = sum(int(work.table[record.NODES]) for work in self.assembler.works)
        first = system.unknowns.first
        in_place = first >= 0
        room = Arena(
            {
                "residual": (size,),
                record.ROWS: (unknown, 2 * half + 1) if pattern is None else (len(pattern.data),),
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
