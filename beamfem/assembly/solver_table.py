"""The table of unknowns, factors and loop settings that compiled drivers work on."""

from functools import cache

import numpy as np

from beamfem.kernels import march, model_passes, motion_steps, newton, record, rollers
from beamfem.kernels.band import Band, band
from beamfem.kernels.compiling import Routine


class SolverTable:
    """A table for `kernels.newton` and `kernels.march`; it keeps the arrays whose addresses it holds."""

    def __init__(
        self, free_dofs: np.ndarray, half_width: int, turned: tuple[np.ndarray, np.ndarray], moving: bool
    ) -> None:
        self.table = np.zeros(record.SOLVER_FIELDS, dtype=np.int64)
        self._kept: dict[int, np.ndarray] = {}
        first, normal = turned
        self.routines = _driver_routines(half_width, moving)
        self.set_whole(record.FREE_DOFS, free_dofs)
        self.set_whole(record.ROLLER_FIRST, first)
        self.set(record.ROLLER_NORMAL, normal)
        self.table[record.UNKNOWN], self.table[record.HALF], self.table[record.ROLLERS] = (
            len(free_dofs),
            half_width,
            len(first),
        )

    def set(self, field: int, values: np.ndarray) -> None:
        """Take an array of numbers; compiled code writes to it where it is contiguous."""
        self._put(field, np.ascontiguousarray(values, dtype=float))

    def set_whole(self, field: int, values: np.ndarray) -> None:
        """Take an array of whole numbers."""
        self._put(field, np.ascontiguousarray(values, dtype=np.int64))

    def _put(self, field: int, values: np.ndarray) -> None:
        self._kept[field] = values
        self.table[field] = values.ctypes.data


@cache
def _driver_routines(half_width: int, moving: bool) -> np.ndarray:
    """Return the addresses of what the driver of statics, or of motions, calls for a band of this half width."""
    own = band(half_width)
    found = {
        record.BALANCE: model_passes.balance,
        record.FACTOR: own.factor,
        record.SOLVE_UPPER: own.solve_upper,
        record.HOLD_NORMALS: rollers.hold_normals,
        record.TURN_IN: rollers.turn_in,
        record.TURN_BACK: rollers.turn_back,
    }
    found |= _of_motions(own) if moving else _OF_STATICS
    table = np.zeros(record.SOLVER_ROUTINES, dtype=np.int64)
    for number, routine in found.items():
        table[number] = routine.address
    return table


_OF_STATICS = {
    record.PREDICT_RESULTANTS: model_passes.predict_resultants,
    record.SMALLEST_JACOBIAN: model_passes.smallest_jacobian,
    record.TAKE_STEP: newton.take_step,
}


def _of_motions(own: Band) -> dict[int, Routine]:
    return {
        record.SOLVE_LOWER: own.solve_lower,
        record.PREDICT: motion_steps.predict,
        record.CORRECT: motion_steps.correct,
        record.COMPLETE: motion_steps.complete,
        record.KEEP_DIRECTIONS: motion_steps.keep_directions,
        record.TURNS_SINCE: motion_steps.turns_since,
        record.TURN_PAIRS: motion_steps.turn_pairs,
        record.COUNT_TURNS: motion_steps.count_turns,
        record.JUDGE: motion_steps.judge,
        record.TURN_ALL: march.turn_all,
        record.SOLVE_TURNED: march.solve_turned,
    }
