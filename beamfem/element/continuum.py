"""Elastic forces of the beam as a continuum."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.axis import Axis
from beamfem.element.body_strain import strain_of_measures
from beamfem.element.coordinates import Coordinates, Gradients
from beamfem.element.structural import section_frame
from beamfem.element.uncoupled_stress import UncoupledStress
from beamfem.kernels.block import GREEN_LAGRANGE
from beamfem.material import Material
from beamfem.physics.measures import evaluate, green_lagrange
from beamfem.section.protocol import CrossSection
from beamfem.validation import flag

_STEP = 2.0**-300  # complex step, so small that its square is negligible
# a law maps a material to the stiffness (3, 3) of (exx, eyy, 2 exy) in the volume
Law = Callable[[Material], np.ndarray]


@dataclass(frozen=True)
class _Body:
    """Green-Lagrange strain of the body r0 + y d."""

    @property
    def code(self) -> int:
        """Number of the strain measures in compiled code."""
        return GREEN_LAGRANGE

    @property
    def turns_with(self) -> str:
        """Nodal vector with which the section rotates."""
        return "r_y"

    @property
    def fills_body(self) -> bool:
        """Whether strains are defined at every point of the body."""
        return True

    @property
    def shear_measures(self) -> tuple[bool, ...]:
        """Whether each of the six measures is a shear (6,)."""
        return (False, False, False, False, True, True)

    @property
    def thickness_measures(self) -> tuple[bool, ...]:
        """Whether each of the six measures is a thickness strain alone (6,): none, as eyy is coupled with exx."""
        return (False,) * 6

    def strains(self, at: Axis) -> np.ndarray:
        """Return the Green-Lagrange strain of the body, as polynomials of the height y, for an axis at points.

        With the measures (a [-], b [1/m], c [1/m^2], eyy [-], g0 [-], g1 [1/m]) (..., 6), exx = a + b y + c y^2 and 2
        exy = g0 + g1 y; paper, section 3.3.
        """
        return evaluate(green_lagrange, at.r_s, at.d, at.d_s)

    def imposed(self, free: np.ndarray, reference: Axis) -> tuple[np.ndarray, np.ndarray]:
        """Return first (m, n, 6) and second (m, m, n, 6) order parts of the measures of m free strains.

        For factors f_i of the free strains, the measures are the sum of f_i first_i + f_i f_j second_ij over all i, j.
        The free body has r0' + stretch n + shear t, d (1 + thickness), d' (1 + thickness) - curvature n. The measures
        are quadratic in these vectors, so complex steps give both parts without subtraction.

        free (m, n, 4): stretch [-], shear [-], curvature [1/m] and thickness stretch [-] at n points of the reference.
        """
        along, across = section_frame(reference.d)
        stretch, shear, curvature, thickness = np.moveaxis(free, -1, 0)[..., None]
        change = (
            stretch * along + shear * across,
            thickness * reference.d,
            thickness * reference.d_s - curvature * along,
        )
        count, start = len(free), (reference.r_s, reference.d, reference.d_s)
        first = np.array([_slope(start, [v[i] for v in change]) for i in range(count)])
        second = [[_slope([v[i] for v in change], [v[j] for v in change]) for j in range(count)] for i in range(count)]
        return first, 0.5 * np.array(second)

    def points(self, degree: int, director_degree: int) -> int:
        """Return the number of Gauss points that integrate the energy of a straight element exactly.

        The energy is quartic in r0' and in d, of the polynomial degrees `degree` and `director_degree`.
        """
        return 2 * max(degree - 1, director_degree) + 1


@dataclass(frozen=True)
class ContinuumMechanics(_Body):
    """Green-Lagrange strain and St. Venant-Kirchhoff stress of the whole body.

    The bending stiffness is E I times (1 - nu) / ((1 + nu)(1 - 2 nu)), in plane stress 1 / (1 - nu^2), because eyy
    cannot vary over y.

    Parameters
    ----------
    plane_stress : bool, default False
        Use lambda = E nu / (1 - nu^2) instead of the 3D value.

    References
    ----------
    Paper, section 3.3.

    Examples
    --------
    >>> element = bf.ANCF(bf.ContinuumMechanics(plane_stress=True))
    """

    plane_stress: bool = False
    name: ClassVar[str] = "continuum"

    def __post_init__(self) -> None:
        flag("plane_stress", self.plane_stress)

    def stiffness(
        self, section: CrossSection, material: Material | None, coordinates: Coordinates, reference: Axis
    ) -> np.ndarray:
        """Return the stiffness (..., 6, 6) [N to N m^4] at points of the reference axis, in the order of `strains`.

        It is the integral of B^T D B over the section, where B(y) maps the measures to (exx, eyy, 2 exy), and D is the
        stiffness of the material.
        """
        return _over_section(section, material, reference, self._law)

    def _law(self, material: Material) -> np.ndarray:
        lam, mu = material.lame_lambda(self.plane_stress), material.shear_modulus
        return np.array([[lam + 2.0 * mu, lam, 0.0], [lam, lam + 2.0 * mu, 0.0], [0.0, 0.0, mu]])

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return the second Piola-Kirchhoff stress [Pa] of Green-Lagrange strains exx, eyy and exy.

        S = lambda tr(E) 1 + 2 mu E (St. Venant-Kirchhoff); exy is half the engineering shear strain.
        """
        return tuple(np.tensordot(self._law(material), np.array([xx, yy, 2.0 * xy]), axes=1))


@dataclass(frozen=True)
class SplitContinuum(UncoupledStress, _Body):
    """Green-Lagrange strain, with Poisson coupling on the centreline only.

    Over the section the stress is E exx, E eyy, 2 k_s mu exy; on the centreline, the Poisson coupling of plane stress
    is added. The bending stiffness is E I. If rotations keep the thickness constant, there is no coupling, and the
    axial stiffness is E A.

    References
    ----------
    Gerstmayr, Matikainen and Mikkola 2008.
    """

    name: ClassVar[str] = "split"

    def stiffness(
        self, section: CrossSection, material: Material | None, coordinates: Coordinates, reference: Axis
    ) -> np.ndarray:
        """Return the stiffness (..., 6, 6) [N to N m^4] at points of the reference axis, in the order of `strains`.

        Over the section the modulus of exx, eyy and 2 exy is E, E and k_s mu; with gradients, the centreline adds the
        Poisson coupling of plane stress to a and eyy.
        """

        def uncoupled(part: Material) -> np.ndarray:
            modulus = part.youngs_modulus
            return np.diag([modulus, modulus, section.shear_factor * part.shear_modulus])

        matrix = _over_section(section, material, reference, uncoupled).copy()
        if isinstance(coordinates, Gradients):
            for part, moments in section.moments(material):
                ratio = part.poisson_ratio
                extra = part.youngs_modulus * ratio / (1.0 - ratio**2) * moments[0]
                matrix[..., 0, 0] += ratio * extra
                matrix[..., 3, 3] += ratio * extra
                matrix[..., 0, 3] += extra
                matrix[..., 3, 0] += extra
        return matrix


def _over_section(section: CrossSection, material: Material | None, reference: Axis, law: Law) -> np.ndarray:
    """Integrate a law over the section: stiffness (..., 6, 6) of (a, b, c, eyy, g0, g1).

    For a straight reference, the moments of the section are used; for a curved one, strips of the section and the
    metric of the curved body, see `body_strain.in_section_frame`.
    """
    low, high = section.bounds
    if np.abs(reference.d_s).max(initial=0.0) * (high - low) < _STRAIGHT:
        total = np.zeros((6, 6))
        for part, moments in section.moments(material):
            total += moments[_MOMENT] * law(part)[_COMPONENT[:, None], _COMPONENT]
        return np.broadcast_to(total, (*reference.r_s.shape[:-1], 6, 6))
    result = np.zeros((*reference.r_s.shape[:-1], 6, 6))
    for part, heights, weights in section.strips(material):
        strain, volume = strain_of_measures(reference, np.asarray(heights))
        each = np.swapaxes(strain, -1, -2) @ law(part) @ strain
        result += ((weights * volume)[..., None, None] * each).sum(axis=-3)
    return result


_STRAIGHT = 1e-13  # curvature times height below which a reference is straight to round-off


# each of (a, b, c, eyy, g0, g1) is one of (exx, eyy, 2 exy), with one power of y; moments for products of two of them
_COMPONENT = np.array([0, 0, 0, 1, 2, 2])
_MOMENT = np.add.outer((0, 1, 2, 0, 0, 1), (0, 1, 2, 0, 0, 1))


def _slope(at: Sequence[np.ndarray], change: Sequence[np.ndarray]) -> np.ndarray:
    """Return the derivative (n, 6) of the measures at r0', d and d' (n, 2) along a change of these."""
    moved = [vector + 1j * _STEP * rate for vector, rate in zip(at, change, strict=True)]
    return evaluate(green_lagrange, *moved).imag / _STEP
