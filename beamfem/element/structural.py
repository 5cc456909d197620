"""Elastic forces of the geometrically exact beam."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.axis import Axis
from beamfem.element.coordinates import Coordinates, Gradients
from beamfem.kernels.block import STRUCTURAL
from beamfem.material import Material
from beamfem.physics.measures import evaluate, structural
from beamfem.section.protocol import CrossSection


@dataclass(frozen=True)
class Structural:
    """Geometrically exact beam with the section along d.

    The stiffnesses are E A for stretch, k_s G A for shear, E I for curvature and, with gradients, E A for thickness.

    References
    ----------
    Reissner 1972; Simo and Vu-Quoc 1986.
    """

    name: ClassVar[str] = "structural"
    code: ClassVar[int] = STRUCTURAL
    turns_with: ClassVar[str] = "r_y"
    fills_body: ClassVar[bool] = False
    shear_measures: ClassVar[tuple[bool, ...]] = (False, True, False, False)
    thickness_measures: ClassVar[tuple[bool, ...]] = (False, False, False, True)

    def strains(self, at: Axis) -> np.ndarray:
        """Return the strain measures (..., 4): stretch [-], shear [-], curvature [1/m], thickness stretch [-]."""
        return evaluate(structural, at.r_s, at.d, at.d_s)

    def stiffness(
        self, section: CrossSection, material: Material | None, coordinates: Coordinates, reference: Axis
    ) -> np.ndarray:
        """Return the section stiffness (..., 4, 4) at points of the reference axis, in the order of `strains`.

        The diagonal is E A [N], k_s G A [N], E I [N m^2] and E A [N], with the coupling of stretch and curvature [N m]
        beside it; the last E A is zero if the nodes keep the length of d.
        """
        rigidity = section.rigidity(material)
        matrix = np.zeros((*reference.r_s.shape[:-1], 4, 4))
        matrix[..., 0, 0], matrix[..., 1, 1], matrix[..., 2, 2] = rigidity.axial, rigidity.shear, rigidity.bending
        matrix[..., 0, 2] = matrix[..., 2, 0] = rigidity.coupling
        if isinstance(coordinates, Gradients):
            matrix[..., 3, 3] = rigidity.axial
        return matrix

    def imposed(self, free: np.ndarray, reference: Axis) -> tuple[np.ndarray, np.ndarray]:
        """Return the strain measures of free strains (m, n, 4): stretch, shear, curvature [1/m] and thickness stretch.

        They are in two parts: (m, n, ns), linear in the free strains, and (m, m, n, ns), products of two of them.
        """
        return free, np.zeros((len(free), *free.shape))

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return the stress components xx, yy, xy [Pa] of strain components [-], without Poisson coupling."""
        modulus = material.youngs_modulus
        return modulus * xx, modulus * yy, 2.0 * material.shear_modulus * xy

    def points(self, degree: int, director_degree: int) -> int:
        """Return the number of Gauss points of full integration, the same as for the continuum."""
        return 2 * max(degree - 1, director_degree) + 1


def section_frame(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors along the section's normal and along d (..., 2)."""
    across = d / np.linalg.norm(d, axis=-1, keepdims=True)
    return np.stack([across[..., 1], -across[..., 0]], axis=-1), across
