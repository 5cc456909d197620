"""Elastic forces: strain measures and the section stiffness that goes with them."""

from dataclasses import dataclass
from typing import cast

import numpy as np

from beamfem.kernels.block import GREEN_LAGRANGE
from beamfem.material import Material
from beamfem.section import Section


@dataclass(frozen=True)
class ContinuumMechanics:
    """Green-Lagrange strain and St. Venant-Kirchhoff stress of the whole body; paper, section 3.3.

    plane_stress: take E nu / (1 - nu^2) for lambda instead of the 3D value. Bends with E I times
    (1 - nu) / ((1 + nu)(1 - 2 nu)), in plane stress 1 / (1 - nu^2), because eyy cannot vary over y.
    """

    plane_stress: bool = False
    name: str = "continuum"
    code: int = GREEN_LAGRANGE

    def strains(self, r_s: np.ndarray, d: np.ndarray, d_s: np.ndarray) -> np.ndarray:
        """Return (..., 6): a, b, c, eyy, g0, g1 with exx = a + b y + c y^2 and 2 exy = g0 + g1 y.

        r_s = r0' (..., 2), d (..., 2), d_s = d' (..., 2) [1/m].
        """

        def dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
            return (u * v).sum(axis=-1)

        return np.stack(
            [
                0.5 * (dot(r_s, r_s) - 1.0),
                dot(r_s, d_s),
                0.5 * dot(d_s, d_s),
                0.5 * (dot(d, d) - 1.0),
                dot(r_s, d),
                dot(d, d_s),
            ],
            axis=-1,
        )

    def stiffness(self, section: Section, material: Material) -> np.ndarray:
        """Return the section stiffness (6, 6): the integral over the section of the energy's second derivatives."""
        lam, mu = material.lame_lambda(self.plane_stress), material.shear_modulus
        area, second, fourth = section.area, section.second_moment, section.fourth_moment
        matrix = np.zeros((6, 6))
        axial = lam + 2.0 * mu
        matrix[0, 0] = matrix[3, 3] = axial * area
        matrix[1, 1] = axial * second
        matrix[2, 2] = axial * cast(float, fourth)
        matrix[0, 2] = matrix[2, 0] = axial * second
        matrix[0, 3] = matrix[3, 0] = lam * area
        matrix[2, 3] = matrix[3, 2] = lam * second
        matrix[4, 4] = mu * area
        matrix[5, 5] = mu * second
        return matrix

    def points(self, degree: int, director_degree: int) -> int:
        """Gauss points that integrate the energy of a straight element exactly; it is quartic in r0' and in d."""
        return 2 * max(degree - 1, director_degree) + 1
