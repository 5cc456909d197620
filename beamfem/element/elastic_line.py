"""Elastic forces of a line whose curvature comes from r_xx."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.axis import Axis
from beamfem.element.coordinates import Coordinates, Gradients
from beamfem.element.uncoupled_stress import UncoupledStress
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.material import Material
from beamfem.physics.measures import elastic_line, evaluate
from beamfem.section.protocol import CrossSection


@dataclass(frozen=True)
class ElasticLine(UncoupledStress):
    """Elastic line with stretch |r_x| - 1, curvature (r_x x r_xx) / |r_x|^2, r_x.r_y and (r_y.r_y - 1) / 2.

    The stiffnesses are E A, E I, G A and, with gradients, E A. The curvature is the derivative of the angle of r_x by
    the reference arc length, so that M = E I dtheta/ds; the section is normal to r_x, and r_y only follows it.

    References
    ----------
    Paper, section 3.4.
    """

    name: ClassVar[str] = "elastic-line"
    code: ClassVar[int] = ELASTIC_LINE
    turns_with: ClassVar[str] = "r_x"
    fills_body: ClassVar[bool] = False
    shear_measures: ClassVar[tuple[bool, ...]] = (False, False, True, False)
    thickness_measures: ClassVar[tuple[bool, ...]] = (False, False, False, True)

    def strains(self, at: Axis) -> np.ndarray:
        """Return stretch [-], curvature [1/m], shear [-] and thickness strain [-] (..., 4) of an axis at points.

        They are |r0'| - 1, (r0' x r0'') / |r0'|^2, r0'.d and (d.d - 1) / 2; paper, section 3.4.
        """
        return evaluate(elastic_line, at.r_s, at.d, at.r_ss)

    def stiffness(
        self, section: CrossSection, material: Material | None, coordinates: Coordinates, reference: Axis
    ) -> np.ndarray:
        """Return the section stiffness (..., 4, 4) at points of the reference axis, in the order of `strains`.

        Its diagonal is E A [N], E I [N m^2], G A [N] and E A [N], zero without gradients; stretch and curvature are
        coupled [N m].
        """
        rigidity = section.rigidity(material)
        thickness = rigidity.axial if isinstance(coordinates, Gradients) else 0.0
        matrix = np.diag([rigidity.axial, rigidity.bending, rigidity.shear / section.shear_factor, thickness])
        matrix[0, 1] = matrix[1, 0] = rigidity.coupling
        return np.broadcast_to(matrix, (*reference.r_s.shape[:-1], 4, 4))

    def imposed(self, free: np.ndarray, reference: Axis) -> tuple[np.ndarray, np.ndarray]:
        """Return first (m, n, 4) and second (m, m, n, 4) order parts of the measures of free strains (m, n, 4).

        A thickness stretch t has the thickness strain t + t^2 / 2; see `ContinuumMechanics.imposed`.
        """
        products = np.zeros((len(free), *free.shape))
        products[..., 3] = 0.5 * free[:, None, :, 3] * free[None, :, :, 3]
        return free[:, :, [0, 2, 1, 3]], products

    def points(self, degree: int, director_degree: int) -> int:
        """Return the number of Gauss points of full integration, exact for curvature and shear of a straight line.

        degree, director_degree: polynomial degrees of the centreline r0 and of the director d.
        """
        return degree + 1
