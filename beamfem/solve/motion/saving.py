"""Which states of a motion are kept, and the rotations that are counted from step to step."""

from typing import NamedTuple

import numpy as np

from beamfem.kernels.motion_steps import count_turns


class Saving(NamedTuple):
    """Rows of a motion to fill.

    states (rows, 3, n): p, p', p''; first: number of the first step of this call; every: steps per row; pairs (m, 2):
    numbers of the coordinates x and y of vectors whose rotation is counted; turned (m,) [rad]: their rotation so far;
    rows_turned (rows, m) [rad]: that of each row.
    """

    states: np.ndarray
    first: int
    every: int
    pairs: np.ndarray
    turned: np.ndarray
    rows_turned: np.ndarray

    def keep(self, step: int, before: np.ndarray, state: np.ndarray) -> None:
        """Count the rotations of a step from one state (4, n) to the next, and keep this one if it has a row."""
        count_turns(len(self.pairs), self.pairs, before, state, self.turned)
        self.keep_state(step, state)

    def keep_state(self, step: int, state: np.ndarray) -> None:
        """Keep the state (4, n) at the end of a step if it has a row."""
        row, rest = divmod(self.first + step, self.every)
        if rest == 0:
            self.states[row], self.rows_turned[row] = state[:3], self.turned

    def after(self, steps: int) -> "Saving":
        """Return the same for what follows some steps."""
        return self._replace(first=self.first + steps)
