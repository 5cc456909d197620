"""The linear law of the thickness stretch beside a section law, which has only stretch, shear and curvature."""

from typing import NamedTuple

import numpy as np

THICKNESS = 3  # number of the thickness stretch among the strain measures


class ThicknessLaw(NamedTuple):
    """Stiffness (...) [N] against thickness stretches from the stress-free state (...), the derivative of resultants.

    For a stiffness times the weights of points [N m], resultants are so too.
    """

    stiffness: np.ndarray

    def resultants(self, stretch: np.ndarray) -> np.ndarray:
        """Return the resultants (...) [N]."""
        return np.asarray(self.stiffness * stretch)

    def energy(self, stretch: np.ndarray) -> np.ndarray:
        """Return the energy [J] of stretches (..., n), summed over points with a stiffness (n,) times their weights."""
        return np.asarray(0.5 * stretch**2 @ self.stiffness)
