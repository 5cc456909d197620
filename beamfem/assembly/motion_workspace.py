"""Workspace of compiled time steps, reused by the next motion of the same model."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from beamfem.assembly.arena import Arena
from beamfem.assembly.rotating_vectors import runs_of
from beamfem.assembly.system import System
from beamfem.assembly.tiles import tiles_of
from beamfem.kernels import motion_record, record
from beamfem.kernels.extrapolation import difference_rows, padded
from beamfem.kernels.pointers import address_of

_KEPT = 40_000_000  # entries of the largest tangent whose workspace is kept for the next motion of the model
_NONE = np.empty(0, dtype=np.int64)


class MotionWorkspace:
    """Workspace for one motion, and the tables that describe it to compiled code.

    arrays: by their fields in the table of the solver; residual, rows: addresses of the residual and of the matrix;
    in_two: whether the stages of a step are computed for two halves separately; loads: indices of the loads of each
    group among those of the model's block, None if groups are blocks.
    """

    def __init__(self, system: System) -> None:
        size, unknown, half = system.model.size, len(system.free_dofs), system.layouts[0].half_width
        pattern, tiles = system.unknowns.pattern, tiles_of(system)
        self.assembler = system.assembler() if tiles is None else tiles.assembler
        self.loads = None if tiles is None else tiles.loads
        self.in_two = tiles is not None
        self._bounds = _whole(system) if tiles is None else tiles.bounds
        self._tiles = _NONE if tiles is None else tiles.table
        pairs = runs_of(system.rotating)
        self._kept = pairs, tiles  # what the tables point to
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
                record.DIFFERENCES: (difference_rows(size, len(self._bounds)),),
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
        for field, values in (
            (record.PAIR_TABLE, pairs),
            (record.PRESCRIBED_DOFS, self._prescribed),
            (record.BOUNDS, self._bounds),
            (record.TILES, self._tiles),
        ):
            self.solver[field] = address_of(values)
        self.solver[record.PARTS] = len(self._bounds)
        self.solver[record.ROWS_DOWN] = 0 if tiles is None else tiles.rows_down
        self.solver[record.RUNS_OF_PAIRS], self.solver[record.NODE_STRIDE] = len(pairs), nodes
        self.solver[record.PRESCRIBED] = len(self._prescribed)


def _whole(system: System) -> np.ndarray:
    """Return the bounds (1, fields) of a single part, the whole model."""
    return np.array([[0, system.model.size, 0, len(system.free_dofs), 0, 0]], dtype=np.int64)


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
