"""Elastic forces of the geometrically exact beam."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.axis import Axis
from beamfem.element.coordinates import Coordinates, Gradients
from beamfem.element.uncoupled_stress import UncoupledStress
from beamfem.kernels.block import STRUCTURAL
from beamfem.material import Material
from beamfem.physics.measures import evaluate, structural
from beamfem.section.protocol import CrossSection


@dataclass(frozen=True)
class Structural(UncoupledStress):
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
        """Return stretch [-], shear [-], curvature [1/m] and thickness stretch [-] (..., 4) of an axis at points.

        With t = d / |d| and the normal n of the section, they are r0'.n - 1, r0'.t, (d x d') / |d|^2 and |d| - 1.
        """
        return evaluate(structural, at.r_s, at.d, at.d_s)

    def stiffness(
        self, section: CrossSection, material: Material | None, coordinates: Coordinates, reference: Axis
    ) -> np.ndarray:
        """Return the section stiffness (..., 4, 4) at points of the reference axis, in the order of `strains`.

        Its diagonal is E A [N], k_s G A [N], E I [N m^2] and E A [N], zero if the nodes keep the length of d; stretch
        and curvature are coupled [N m].
        """
        rigidity = section.rigidity(material)
        matrix = np.zeros((*reference.r_s.shape[:-1], 4, 4))
        matrix[..., 0, 0], matrix[..., 1, 1], matrix[..., 2, 2] = rigidity.axial, rigidity.shear, rigidity.bending
        matrix[..., 0, 2] = matrix[..., 2, 0] = rigidity.coupling
        if isinstance(coordinates, Gradients):
            matrix[..., 3, 3] = rigidity.axial
        return matrix

    def imposed(self, free: np.ndarray, reference: Axis) -> tuple[np.ndarray, np.ndarray]:
        """Return first (m, n, 4) and second (m, m, n, 4) order parts of the measures of free strains (m, n, 4).

        The free strains are the measures themselves; see `ContinuumMechanics.imposed`.
        """
        return free, np.zeros((len(free), *free.shape))

    def points(self, degree: int, director_degree: int) -> int:
        """Return the number of Gauss points of full integration, that of the continuum.

        degree, director_degree: polynomial degrees of the centreline r0 and of the director d.
        """
        return 2 * max(degree - 1, director_degree) + 1


def section_frame(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors along the section's normal and along d (..., 2)."""
    across = d / np.linalg.norm(d, axis=-1, keepdims=True)
    return np.stack([across[..., 1], -across[..., 0]], axis=-1), across
