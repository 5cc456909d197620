"""Stress of elastic forces whose law couples no strains of a point."""

import numpy as np

from beamfem.material import Material


class UncoupledStress:
    """Stress without Poisson coupling, as `Structural`, `ElasticLine` and, off the axis, `SplitContinuum` have it."""

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return the stress E exx, E eyy and 2 G exy [Pa] of strains exx, eyy and exy (half the shear angle)."""
        modulus = material.youngs_modulus
        return modulus * xx, modulus * yy, 2.0 * material.shear_modulus * xy
