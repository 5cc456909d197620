"""Time steps of models whose tangent is a narrow band: many in one compiled call."""

import numpy as np

from beamfem.assembly.solver_table import SolverTable
from beamfem.kernels import record
from beamfem.kernels.march import march
from beamfem.model.system import System

Saving = tuple[np.ndarray, int, int, np.ndarray, np.ndarray, np.ndarray]


class BandMotion:
    """Marches through time steps; keeps tangent and differences of the acceleration from one call to the next.

    rule: step, alpha_m, alpha_f, gamma, beta; limits: tolerance of the correction relative to the scale of a
    coordinate, largest number of iterations; statistics (8,): see `kernels.march.march`.
    """

    def __init__(self, system: System, rule: np.ndarray, limits: np.ndarray, statistics: np.ndarray) -> None:
        self._system = system
        size, unknown, half = system.model.size, len(system.free_dofs), system.layouts[0].half_width
        h, alpha_m, alpha_f, gamma, beta = rule
        self._assembler, self._solver = (
            system.assembler(),
            SolverTable(system.free_dofs, half, system.turned, moving=True),
        )
        self._assembler.weigh((1.0, gamma / (h * beta), (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))))
        self._assembler.require("tangent")
        self._rows, self._residual = np.zeros((unknown, 2 * half + 1)), np.empty(size)
        inverse_scale = np.zeros(size)
        inverse_scale[system.free_dofs] = 1.0 / system.scale[system.free_dofs]
        nodes = sum(len(block.dof) for block in system.blocks)
        parts = {
            record.ROWS: self._rows,
            record.RIGHT: np.empty(unknown),
            record.STEP: np.empty(max(size, unknown) + 1),
            record.BEFORE: np.empty((4, size)),
            record.DIFFERENCES: np.zeros((3, size)),
            record.INVERSE_SCALE: inverse_scale,
            record.RULE: rule,
            record.LIMITS: limits,
            record.STATISTICS: statistics,
            record.KEPT: np.zeros((nodes, 2)),
            record.TURNS: np.zeros((nodes, 2)),
        }
        for field, array in parts.items():
            self._solver.set(field, array)
        self._solver.set_whole(record.PAIR_TABLE, system.turning)
        self._solver.set_whole(record.HELD_DOFS, system.held_dofs)
        self._solver.table[record.PAIRS], self._solver.table[record.HELD] = len(system.turning), len(system.held_dofs)

    def advance(self, state: np.ndarray, held: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        held (steps, 3, nh): values of the held coordinates and their rates at the times (steps,) [s]; saving: rows
        (steps, 3, n), number of the first step, and how many steps make a row; then x and y (m, 2) of vectors whose
        turning is counted, how far they have turned (m,) [rad] and that of the rows (steps, m).
        """
        saved, first, every, counted, turned_by, saved_turns = saving
        body, values = _sample_loads(self._system, times)
        assembler, solver, table = self._assembler, self._solver, self._solver.table
        assembler.load(body, values)
        assembler.place(state[0], state[1], state[2], self._residual, self._rows)
        for field, array in (
            (record.STATE, state),
            (record.HELD_VALUES, held),
            (record.BODIES, body),
            (record.SAVED, saved),
            (record.TURNED_BY, turned_by),
            (record.SAVED_TURNS, saved_turns),
        ):
            solver.set(field, array)
        solver.set_whole(record.TURN_TABLE, counted)
        solver.set_whole(record.LOAD_VALUES, np.array([each.ctypes.data for each in assembler.values]))
        table[[record.STEPS, record.FIRST_STEP, record.EVERY]] = len(held), first, every
        table[record.TURN_COUNT] = len(counted)
        table[record.BODY_STRIDE] = body[0].size if len(body) > 1 else 0
        table[record.LOADS_VARY] = int(len(body) > 1)
        return int(march(assembler.table, table, solver.routines))


def _sample_loads(system: System, times: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Body forces (steps, beams, 4) and point values of each block (steps, nl, 3); one row where nothing varies."""
    if not system.varying:
        times = times[:1]
    body = np.array([system.body(now) for now in times])
    values = [system.point_values(now) for now in times]
    return body, tuple(np.array([value[i] for value in values]) for i in range(len(system.blocks)))
