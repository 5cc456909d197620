"""What acts on a model at a time."""

from typing import NamedTuple

import numpy as np


class LoadsAt(NamedTuple):
    """Loads of a model at a time, in statics at a load factor."""

    body: np.ndarray  # (beams, 4): acceleration [m/s^2] and load per length [N/m]
    points: tuple[np.ndarray, ...]  # (nl, 3) of each block: forces and moments at points
    imposing: np.ndarray  # (k,) factors of the loads that impose strains

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """All of them."""
        return (self.body, *self.points, self.imposing)

    @property
    def any(self) -> bool:
        """Whether anything acts."""
        return any(bool(own.any()) for own in self.arrays)
