"""Stress of elastic forces whose law couples no strains of a point."""

import numpy as np

from beamfem.material import Material


class UncoupledStress:
    """Stress without Poisson coupling, as `Structural`, `ElasticLine` and, off the axis, `SplitContinuum` have it."""

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return the stress of given strains, without Poisson coupling.

        The stress is E exx, E eyy and 2 G exy.

        Parameters
        ----------
        xx, yy, xy : array, [-]
            Strain components of points of the body; xy is half the engineering shear strain.
        material : Material
            Material at the points.

        Returns
        -------
        xx, yy, xy : array, [Pa]
            Stress components.

        Examples
        --------
        >>> strain = np.array([1e-3]), np.zeros(1), np.zeros(1)
        >>> bf.Structural().stress(*strain, steel)[0] / 1e6  # MPa
        array([210.])
        """
        modulus = material.youngs_modulus
        return modulus * xx, modulus * yy, 2.0 * material.shear_modulus * xy
