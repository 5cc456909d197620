"""Elastic forces: strain measures and the section stiffness that goes with them.

Each has a `name`, the `code` of its measures in compiled code, the nodal vector that the section turns with, whether
strains are defined at every point of the body, and which of its measures are shears and pure thickness strains.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.coordinates import Coordinates, Gradients
from beamfem.element.fields import Axis, dot, section_frame
from beamfem.kernels.block import ELASTIC_LINE, GREEN_LAGRANGE, STRUCTURAL
from beamfem.material import Material
from beamfem.physics.kinematics import elastic_line, evaluate, green_lagrange, structural
from beamfem.section.protocol import CrossSection
from beamfem.validation import flag

Strain = tuple[np.ndarray, np.ndarray, np.ndarray]  # exx, eyy and 2 exy


InverseJacobian = tuple[np.ndarray, np.ndarray, np.ndarray]  # k11, k21 and k22 of [[k11, 0], [k21, k22]]


def inverse_jacobian(reference: Axis, y: np.ndarray) -> tuple[InverseJacobian, np.ndarray]:
    """Return J^-1 and det J (..., heights) of points (...) of the reference axis at heights y (heights,) [m].

    J = (r0' + y d', d); components are those along n and t = d / |d|.
    """
    along, across = section_frame(reference.d)
    first = reference.r_s[..., None, :] + y[..., None] * reference.d_s[..., None, :]
    j11, j21 = dot(first, along[..., None, :]), dot(first, across[..., None, :])
    j22 = np.linalg.norm(reference.d, axis=-1)[..., None]
    k11, k22 = 1.0 / j11, 1.0 / j22
    return (k11, -j21 * k11 * k22, k22), j11 * j22


def convected(measures: np.ndarray, y: np.ndarray) -> Strain:
    """Return the convected strain (..., heights) of measures (..., 6) at heights y (heights,) [m]."""
    a, b, c, eyy, g0, g1 = np.moveaxis(measures, -1, 0)[..., None]
    xx = a + y * (b + y * c)
    return xx, np.broadcast_to(eyy, xx.shape), g0 + y * g1


def in_section_frame(inverse: InverseJacobian, strain: Strain) -> Strain:
    """Return E = J^-T (E_convected) J^-1 in the frame of the section."""
    (k11, k21, k22), (xx, yy, xy) = inverse, strain
    return k11**2 * xx + k21**2 * yy + k11 * k21 * xy, k22**2 * yy, 2.0 * k21 * k22 * yy + k11 * k22 * xy


def strain_of_measures(reference: Axis, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivative (..., heights, 3, 6) of (exx, eyy, 2 exy) by the measures, and det J (..., heights)."""
    (k11, k21, k22), volume = inverse_jacobian(reference, y)
    entries = k11[..., None, :], k21[..., None, :], k22[..., None, :]
    rows = np.stack(in_section_frame(entries, convected(np.eye(6), y)), axis=-3)
    return np.moveaxis(rows, -1, -3), volume


def green_strain(now: Axis, reference: Axis, y: np.ndarray) -> Strain:
    """Return exx, eyy and 2 exy (..., heights) at heights y (heights,) [m] in the frame of the reference."""
    change = evaluate(green_lagrange, now.r_s, now.d, now.d_s)
    change = change - evaluate(green_lagrange, reference.r_s, reference.d, reference.d_s)
    return in_section_frame(inverse_jacobian(reference, y)[0], convected(change, y))


_STEP = 2.0**-300  # complex step, so small that its square is negligible
# a law maps a material to the stiffness (3, 3) of (exx, eyy, 2 exy) in the volume
Law = Callable[[Material], np.ndarray]


class UncoupledStress:
    """Stress without Poisson coupling, as `Structural`, `ElasticLine` and, off the axis, `SplitContinuum` have it."""

    def stress(self, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray, material: Material) -> tuple[np.ndarray, ...]:
        """Return the stress E exx, E eyy and 2 G exy [Pa] of strains exx, eyy and exy (half the shear angle)."""
        modulus = material.youngs_modulus
        return modulus * xx, modulus * yy, 2.0 * material.shear_modulus * xy


@dataclass(frozen=True)
class Structural(UncoupledStress):
    """Geometrically exact beam with the section along d.

    The stiffnesses are E A for stretch, k_s G A for shear, E I for curvature and, with gradients, E A for thickness.
    Source: Reissner 1972; Simo and Vu-Quoc 1986.
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


@dataclass(frozen=True)
class ElasticLine(UncoupledStress):
    """Elastic line with stretch |r_x| - 1, curvature (r_x x r_xx) / |r_x|^2, r_x.r_y and (r_y.r_y - 1) / 2.

    The stiffnesses are E A, E I, G A and, with gradients, E A. The curvature is the derivative of the angle of r_x by
    the reference arc length, so that M = E I dtheta/ds; the section is normal to r_x, and r_y only follows it. Source:
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


@dataclass(frozen=True)
class _Body:
    """Green-Lagrange strain of the body r0 + y d."""

    code: ClassVar[int] = GREEN_LAGRANGE
    turns_with: ClassVar[str] = "r_y"
    fills_body: ClassVar[bool] = True
    shear_measures: ClassVar[tuple[bool, ...]] = (False, False, False, False, True, True)
    thickness_measures: ClassVar[tuple[bool, ...]] = (False,) * 6  # none, as eyy is coupled with exx

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
    cannot vary over y. Source: paper, section 3.3.

    Parameters
    ----------
    plane_stress : bool, default False
        Use lambda = E nu / (1 - nu^2) instead of the 3D value.

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
    axial stiffness is E A. Source: Gerstmayr, Matikainen and Mikkola 2008.
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
    metric of the curved body, see `in_section_frame`.
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


Forces = ContinuumMechanics | SplitContinuum | ElasticLine | Structural
