"""The table of unknowns, factors and loop settings for compiled drivers."""

from collections.abc import Mapping
from functools import cache

import numpy as np

from beamfem.assembly.equation_numbering import Unknowns
from beamfem.kernels import bordered_band, model_passes, motion_stages, motion_steps, record, rollers
from beamfem.kernels import newton_loop as newton
from beamfem.kernels.band import Band, band
from beamfem.kernels.bidirectional_lu import SHORT, BidirectionalLU, bidirectional_lu
from beamfem.kernels.compiling import Routine
from beamfem.kernels.pointers import address_of


class SolverTable:
    """The constant part of a table for `kernels.newton` and `kernels.march`: the unknowns of a band matrix.

    rotated: equation numbers (nt,) and normals (nt, 2) of inclined rollers; scale (n,): scale of the coordinates.
    """

    def __init__(self, unknowns: Unknowns, rotated: tuple[np.ndarray, np.ndarray], scale: np.ndarray) -> None:
        free_dofs, self.half_width = unknowns.dofs, unknowns.layouts[0].half_width
        self._kept = (
            *(np.ascontiguousarray(array, dtype=np.int64) for array in (free_dofs, rotated[0])),
            *(np.ascontiguousarray(array, dtype=float) for array in (rotated[1], scale, 1.0 / scale)),
            unknowns.reach,
        )
        self._table = np.zeros(record.SOLVER_FIELDS, dtype=np.int64)
        fields = (
            *(record.FREE_DOFS, record.ROLLER_FIRST, record.ROLLER_NORMAL),
            *(record.SCALE, record.INVERSE_SCALE, record.REACH),
        )
        for field, values in zip(fields, self._kept, strict=True):
            self._table[field] = address_of(values)
        self._table[record.UNKNOWN], self._table[record.HALF] = len(free_dofs), self.half_width
        self._table[record.ROLLERS] = len(rotated[0])
        self._table[record.FIRST_FREE] = unknowns.first

    def filled(self, addresses: Mapping[int, int]) -> np.ndarray:
        """Return a copy of the table with further addresses."""
        table = self._table.copy()
        for field, address in addresses.items():
            table[field] = address
        return table

    def routines(self, moving: bool) -> np.ndarray:
        """Return the addresses of the routines of the static or dynamic driver."""
        return _driver_routines(self.half_width, moving, int(self._table[record.UNKNOWN]) < SHORT)


@cache
def _driver_routines(half_width: int, moving: bool, short: bool) -> np.ndarray:
    """Return the addresses of the routines that the static or dynamic driver calls for a band of this half width."""
    routines = {
        record.BALANCE: model_passes.balance,
        record.PREDICT_RESULTANTS: model_passes.predict_resultants,
        record.SMALLEST_JACOBIAN: model_passes.smallest_jacobian,
        record.CONSTRAIN_NORMALS: rollers.constrain_normals,
        record.ROTATE_IN: rollers.rotate_in,
        record.ROTATE_BACK: rollers.rotate_back,
    }
    if moving:
        routines |= _of_motions(bidirectional_lu(half_width, short))
    else:
        routines |= _of_statics(band(half_width))
    table = np.zeros(record.SOLVER_ROUTINES, dtype=np.int64)
    for number, routine in routines.items():
        table[number] = routine.address
    return table


def _of_statics(own: Band) -> dict[int, Routine]:
    return {
        record.FACTOR: own.factor,
        record.SOLVE_UPPER: own.solve_upper,
        record.TAKE_STEP: newton.take_step,
    }


def _of_motions(own: BidirectionalLU) -> dict[int, Routine]:
    return {
        record.KEEP_DIRECTIONS: motion_steps.keep_directions,
        record.ROTATIONS_SINCE: motion_steps.rotations_since,
        record.ROTATE_PAIRS: motion_steps.rotate_pairs,
        record.COUNT_ROTATIONS: motion_steps.count_rotations,
        record.PREDICT: motion_stages.predict,
        record.COMPLETE: motion_stages.complete,
        record.FACTOR_BOTH: own.factor,
        record.SOLVE_BOTH: own.solve,
        record.ASSEMBLE: motion_stages.assemble,
        record.FACTORISE: motion_stages.factorise,
        record.SOLVE: motion_stages.solve,
        record.CORRECT: motion_stages.correct,
        record.FACTOR_BORDERED: bordered_band.factor_bordered,
        record.SOLVE_BORDERED: bordered_band.solve_bordered,
    }
