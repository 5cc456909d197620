"""Time steps of models whose tangent is a narrow band: many in one compiled call."""

import numpy as np

from beamfem.kernels.advance import advance, working_space
from beamfem.model.system import System

Saving = tuple[np.ndarray, int, int, np.ndarray, np.ndarray, np.ndarray]


class BandMotion:
    """Marches through time steps; keeps tangent and differences of the acceleration from one call to the next.

    rule: step, alpha_m, alpha_f, gamma, beta; limits: tolerance of the correction relative to the scale of a
    coordinate, largest number of iterations; statistics (8,): see `kernels.advance.advance`.
    """

    def __init__(self, system: System, rule: np.ndarray, limits: np.ndarray, statistics: np.ndarray) -> None:
        self._system, self._rule, self._limits = system, rule, limits
        size, unknown, work = system.model.size, len(system.free_dofs), system.workspaces()
        rows = np.zeros((unknown, 2 * system.layouts[0].half_width + 1))
        directions = np.zeros((2, sum(len(own.nodes[0]) for own in work), 2))
        self._work = work
        self._memory = rows, rows.reshape(-1), np.zeros((3, size)), *directions, statistics
        self._space = working_space(size, unknown)

    def advance(self, state: np.ndarray, held: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        held (steps, 3, nh): values of the held coordinates and their rates at the times (steps,) [s]; saving: see
        `kernels.advance.advance`.
        """
        system = self._system
        completed: int = advance(
            system.forms,
            system.blocks,
            self._work,
            system.point_loads,
            system.springs,
            system.layouts,
            system.free_dofs,
            system.held_dofs,
            system.turned,
            system.turning,
            state,
            (held, *_sample_loads(system, times)),
            self._rule,
            self._limits,
            system.scale,
            self._memory,
            self._space,
            saving,
        )
        return completed


def _sample_loads(system: System, times: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Body forces (steps, beams, 4) and point values of each block (steps, nl, 3); one row where nothing varies."""
    if not system.varying:
        times = times[:1]
    body = np.array([system.body(now) for now in times])
    values = [system.point_values(now) for now in times]
    return body, tuple(np.array([value[i] for value in values]) for i in range(len(system.blocks)))
