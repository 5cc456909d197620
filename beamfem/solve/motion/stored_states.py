"""Which states of a motion are kept, and the rotations that are counted from step to step."""

from typing import NamedTuple

import numpy as np

from beamfem.kernels.motion_steps import count_rotations


class Saving(NamedTuple):
    """Rows of a motion to fill.

    states (rows, 3, n): p, p', p''; first: number of the first step of this call; every: steps per row; pairs (m, 2):
    numbers of the coordinates x and y of vectors whose rotation is counted; rotations (m,) [rad]: those so far;
    saved_rotations (rows, m) [rad]: that of each row.
    """

    states: np.ndarray
    first: int
    every: int
    pairs: np.ndarray
    rotations: np.ndarray
    saved_rotations: np.ndarray

    def keep(self, step: int, before: np.ndarray, state: np.ndarray) -> None:
        """Count the rotations of a step from one state (4, n) to the next, and keep this one if it has a row."""
        count_rotations(len(self.pairs), self.pairs, before, state, self.rotations)
        self.keep_state(step, state)

    def keep_state(self, step: int, state: np.ndarray) -> None:
        """Keep the state (4, n) at the end of a step if it has a row."""
        row, rest = divmod(self.first + step, self.every)
        if rest == 0:
            self.states[row], self.saved_rotations[row] = state[:3], self.rotations

    def after(self, steps: int) -> "Saving":
        """Return the same for what follows some steps."""
        return self._replace(first=self.first + steps)
