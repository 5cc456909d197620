"""Elastic forces: strain measures and the section stiffness that goes with them."""

from dataclasses import dataclass
from typing import cast

import numpy as np

from beamfem.element.coordinates import Gradients, Rotation
from beamfem.kernels.block import GREEN_LAGRANGE, STRUCTURAL
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

    def stiffness(self, section: Section, material: Material, coordinates: Gradients | Rotation) -> np.ndarray:
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

    def conjugates(
        self, resultants: np.ndarray, r_s: np.ndarray, d: np.ndarray, d_s: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return dW/dr0' and dW/dd' (..., 2) of stress resultants (..., 6)."""
        s = resultants[..., None]
        force = s[..., 0, :] * r_s + s[..., 1, :] * d_s + s[..., 4, :] * d
        couple = s[..., 1, :] * r_s + s[..., 2, :] * d_s + s[..., 5, :] * d
        return force, couple

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return second Piola-Kirchhoff stress xx, yy, xy [Pa] of Green strain components."""
        mu = material.shear_modulus
        trace = material.lame_lambda(self.plane_stress) * (xx + yy)
        return trace + 2 * mu * xx, trace + 2 * mu * yy, 2 * mu * xy

    def points(self, degree: int, director_degree: int) -> int:
        """Gauss points that integrate the energy of a straight element exactly; it is quartic in r0' and in d."""
        return 2 * max(degree - 1, director_degree) + 1


@dataclass(frozen=True)
class Structural:
    """Geometrically exact beam of Reissner 1972 and Simo and Vu-Quoc 1986, section along d.

    Resists stretch with E A, shear with k_s G A, curvature with E I; with gradients, thickness stretch with E A.
    """

    name: str = "structural"
    code: int = STRUCTURAL

    def strains(self, r_s: np.ndarray, d: np.ndarray, d_s: np.ndarray) -> np.ndarray:
        """Return (..., 4): stretch, shear, curvature [1/m], thickness stretch; r_s = r0', d_s = d' [1/m]."""
        size = np.linalg.norm(d, axis=-1)
        along, across = _frame(d)
        turn = (d[..., 0] * d_s[..., 1] - d[..., 1] * d_s[..., 0]) / size**2
        return np.stack([(r_s * along).sum(-1) - 1.0, (r_s * across).sum(-1), turn, size - 1.0], axis=-1)

    def stiffness(self, section: Section, material: Material, coordinates: Gradients | Rotation) -> np.ndarray:
        """Return diag(E A, k_s G A, E I, E A); the last is zero where rotations keep the length of d at the nodes."""
        axial = material.youngs_modulus * section.area
        shear = section.shear_factor * material.shear_modulus * section.area
        thickness = axial if isinstance(coordinates, Gradients) else 0.0
        return np.diag([axial, shear, material.youngs_modulus * section.second_moment, thickness])

    def conjugates(
        self, resultants: np.ndarray, r_s: np.ndarray, d: np.ndarray, d_s: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return dW/dr0' and dW/dd' (..., 2) of stress resultants (..., 4)."""
        along, across = _frame(d)
        s = resultants[..., None]
        size = np.linalg.norm(d, axis=-1, keepdims=True)
        return s[..., 0, :] * along + s[..., 1, :] * across, -s[..., 2, :] * along / size

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return stress xx, yy, xy [Pa] of strain components, without Poisson coupling."""
        modulus = material.youngs_modulus
        return modulus * xx, modulus * yy, 2.0 * material.shear_modulus * xy

    def points(self, degree: int, director_degree: int) -> int:
        """Gauss points of full integration, as many as for the continuum."""
        return 2 * max(degree - 1, director_degree) + 1


def _frame(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors along the section's normal and along d (..., 2)."""
    across = d / np.linalg.norm(d, axis=-1, keepdims=True)
    return np.stack([across[..., 1], -across[..., 0]], axis=-1), across


Forces = ContinuumMechanics | Structural
