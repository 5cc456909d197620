"""Sections of one material given by area moments, and sections given by their stiffness."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.quadrature import gauss_between
from beamfem.section.outline import MomentsOutline, Part
from beamfem.section.protocol import CrossSection, Inertia, Rigidity
from beamfem.validation import convert, finite, positive


@dataclass(frozen=True)
class StiffnessSection:
    """Section given by its stiffness and mass, see `Section.from_stiffness`.

    It is drawn as high as the rectangle with the same E I and E A. Raises InputError for an invalid value.
    """

    axial: float
    shear: float
    bending: float
    mass: float
    rotary_inertia: float
    coupling: float = 0.0

    def __post_init__(self) -> None:
        convert(self, positive, "axial", "shear", "bending", "mass", "rotary_inertia")
        convert(self, finite, "coupling")
        if self.coupling * self.coupling >= self.axial * self.bending:
            raise InputError(
                f"coupling ({self.coupling:g}) must be smaller than sqrt(axial * bending) = "
                f"{np.sqrt(self.axial * self.bending):g}: the section would gain energy by deforming"
            )

    @property
    def shear_factor(self) -> float:
        """Shear correction factor [-]: 1, as the shear stiffness is given as a whole."""
        return 1.0

    @property
    def height(self) -> float:
        """Height [m] of the rectangle with the same E I and E A, for pictures."""
        return float(np.sqrt(12.0 * self.bending / self.axial))

    @property
    def bounds(self) -> tuple[float, float]:
        """Heights y [m] of the lower and the upper face of that rectangle."""
        return -0.5 * self.height, 0.5 * self.height

    def rigidity(self, material: Material | None) -> Rigidity:
        """Return the given stiffness [N], [N], [N m^2], [N m]."""
        return Rigidity(self.axial, self.shear, self.bending, self.coupling)

    def inertia(self, material: Material | None) -> Inertia:
        """Return the given mass per length [kg/m] and rotary inertia [kg m]."""
        return Inertia(self.mass, 0.0, self.rotary_inertia)

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Raise InputError: a section given by its stiffness has no body to integrate over."""
        raise InputError(
            "continuum forces integrate over a body, but a section from its stiffness has none",
            remedy="use Structural or ElasticLine forces, or a Section with a material",
        )

    def materials_at(self, y: np.ndarray, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return an empty list: a section given by its stiffness has no body."""
        return []

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Raise InputError: a section given by its stiffness has no body to integrate over."""
        return [(part, moments, moments) for part, moments in self.moments(material)]


_ROUNDING = 1e-9  # relative, of values from tables
_STRIPS = 8  # Gauss points over the height, for curved bodies


@dataclass(frozen=True)
class Section:
    """Section given by its area moments.

    Raises InputError for an invalid value.

    Parameters
    ----------
    area : float, [m^2]
        Area A.
    second_moment : float, [m^4]
        Second moment of area I.
    shear_factor : float, [-], default 5/6
        Shear correction factor k_s.
    fourth_moment : float, [m^6], optional
        I4 = integral of y^4 dA, by default that of the rectangle of the same area and second moment, I4 = A h^4 / 80
        with h = sqrt(12 I / A).
    height : float, [m], optional
        Height, which gives the faces of the body and their stress. Without a height, the body is drawn as that
        rectangle and its faces have no stress.
    centroid : float, [m], optional
        Height of the centroid above the lower face, by default mid-height.

    Examples
    --------
    >>> ipe100 = bf.Section(area=10.3e-4, second_moment=171e-8, shear_factor=0.4, height=0.1)
    >>> ipe100.bounds
    (-0.05, 0.05)
    """

    area: float
    second_moment: float
    shear_factor: float = 5 / 6
    fourth_moment: float | None = None
    height: float | None = None
    centroid: float | None = None

    def __post_init__(self) -> None:
        convert(self, positive, "area", "second_moment", "shear_factor")
        least = self.second_moment / self.area * self.second_moment  # that of a rectangle is 9/5 of it
        if self.fourth_moment is None:
            object.__setattr__(self, "fourth_moment", 1.8 * least)
        fourth = positive("fourth_moment of Section", self.fourth_moment)
        object.__setattr__(self, "fourth_moment", fourth)
        if fourth < least * (1.0 - _ROUNDING):
            raise InputError(
                f"fourth_moment ({fourth:g}) must be at least second_moment^2 / area = {least:g}: no section has less"
            )
        if self.height is not None:
            self._check_height()
        elif self.centroid is not None:
            raise InputError("the centroid of a Section is above its lower face: give its height as well")

    def _check_height(self) -> None:
        height = positive("height of Section", self.height)
        centroid = 0.5 * height if self.centroid is None else positive("centroid of Section", self.centroid)
        object.__setattr__(self, "height", height)
        object.__setattr__(self, "centroid", centroid)
        if centroid >= height:
            raise InputError(f"centroid ({centroid:g}) must lie below the upper face: less than height ({height:g})")
        # all of the area at the two faces
        largest = self.area * centroid * (height - centroid)
        if self.second_moment > largest * (1.0 + _ROUNDING):
            raise InputError(
                f"a section of height {height:g} with its centroid at {centroid:g} has a second moment of at most "
                f"A c (h - c) = {largest:g}, got {self.second_moment:g}"
            )

    @staticmethod
    def from_stiffness(
        axial: float, shear: float, bending: float, mass: float, rotary_inertia: float, coupling: float = 0.0
    ) -> StiffnessSection:
        """Return a section given by E A [N], k_s G A [N], E I [N m^2], mass [kg/m] and rotary inertia [kg m].

        Inertia is per length, and no material is needed. If the neutral axis is not on the beam's axis, there is a
        coupling C [N m]: N = E A eps + C kappa and M = C eps + E I kappa. Raises InputError for an invalid value.

        >>> section = bf.Section.from_stiffness(axial=1e6, shear=4e5, bending=50.0, mass=0.8, rotary_inertia=1e-4)
        >>> rod = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), section)
        """
        return StiffnessSection(axial, shear, bending, mass, rotary_inertia, coupling)

    @property
    def width(self) -> float:
        """Width [m] of the rectangle with the same area and second moment."""
        return self.area / self._equivalent_height

    @property
    def bounds(self) -> tuple[float, float]:
        """Heights y [m] of the lower and the upper face, from the axis.

        Without a given height they are those of the rectangle with the same area and second moment.
        """
        if self.height is None or self.centroid is None:
            return -0.5 * self._equivalent_height, 0.5 * self._equivalent_height
        return -self.centroid, self.height - self.centroid

    @property
    def _equivalent_height(self) -> float:
        return float(np.sqrt(12.0 * self.second_moment / self.area))

    def rigidity(self, material: Material | None) -> Rigidity:
        """Return E A [N], k_s G A [N] and E I [N m^2] about the centroid. Raises InputError without a material.

        >>> rigidity = bf.Rectangle(0.05, 0.1).rigidity(steel)
        >>> round(rigidity.axial / 1e6), round(rigidity.bending / 1e3)  # MN, kN m^2
        (1050, 875)
        """
        checked_material = required(material)
        modulus = checked_material.youngs_modulus
        shear = self.shear_factor * checked_material.shear_modulus * self.area
        return Rigidity(modulus * self.area, shear, modulus * self.second_moment)

    def inertia(self, material: Material | None) -> Inertia:
        """Return rho A [kg/m] and rho I [kg m] about the centroid. Raises InputError without a material."""
        density = required(material).density
        return Inertia(density * self.area, 0.0, density * self.second_moment)

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return the material with (A, 0, I, 0, I4), see `CrossSection.moments`."""
        return [(required(material), np.array([self.area, 0.0, self.second_moment, 0.0, self.fourth_moment]))]

    def materials_at(self, y: np.ndarray, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return the material, which is the same at all heights. Raises InputError without a material."""
        return [(required(material), np.ones_like(y, dtype=bool))]

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return a Gauss rule over the rectangle with the same area and second moment, see `CrossSection.strips`."""
        half = 0.5 * self._equivalent_height
        heights, weights = gauss_between(-half, half, _STRIPS)
        return [(required(material), heights, self.width * weights)]

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return the section as one part, given by its moments and, if it is known, its height."""
        low, high = self.bounds
        moments = (self.area, 0.0, self.second_moment, 0.0, float(self.fourth_moment or 0.0))
        return (Part(required(material).youngs_modulus, MomentsOutline(moments, low, high, self.height is not None)),)


def required(material: Material | None) -> Material:
    """Return the material of a section that needs one. Raises InputError without a material."""
    if material is None:
        raise InputError(
            "this section needs a material", remedy="give the beam one, or use a section with materials of its own"
        )
    return material


def materials_of(section: CrossSection, material: Material | None) -> list[Material]:
    """Return the materials of a section, from the bottom up; none of one that is known by its stiffness."""
    try:
        return [own for own, _ in section.moments(material)]
    except InputError:
        return []


def thermal_strain(section: CrossSection, material: Material | None) -> np.ndarray:
    """Return stretch, curvature [1/m] and thickness stretch (3, 2) of an unconstrained section due to temperature.

    The columns are for a uniform change of 1 K and a gradient of 1 K/m towards +y. For layers, eps - y kappa is the
    least-squares fit to alpha T(y) weighted by E dA, so that normal force and moment are zero (Timoshenko 1925).
    """
    parts = _parts(section, material)
    expansions = [part.thermal_expansion for part, _ in parts]
    alpha = expansions[0]
    if expansions == [alpha] * len(expansions):
        return np.array([[alpha, 0.0], [0.0, -alpha], [alpha, 0.0]])
    e0, e1, e2 = (sum(part.youngs_modulus * moments[n] for part, moments in parts) for n in range(3))
    f0, f1, f2 = (
        sum(part.thermal_expansion * part.youngs_modulus * moments[n] for part, moments in parts) for n in range(3)
    )
    axial = np.linalg.solve(np.array([[e0, -e1], [-e1, e2]]), np.array([[f0, f1], [-f1, -f2]]))
    return np.vstack([axial, [f0 / e0, f1 / e0]])


def expansion(section: CrossSection, material: Material | None) -> np.ndarray:
    """Return `thermal_strain`, zeros if the section has no material."""
    try:
        return thermal_strain(section, material)
    except InputError:
        return np.zeros((3, 2))


def expands_evenly(section: CrossSection, material: Material | None) -> bool:
    """Return whether the whole section has the same coefficient of thermal expansion."""
    return len({part.thermal_expansion for part, _ in _parts(section, material)}) == 1


def _parts(section: CrossSection, material: Material | None) -> list[tuple[Material, np.ndarray]]:
    """Return the materials of a section with the integrals of 1, y, ..., y^4 over their parts."""
    try:
        return section.moments(material)
    except InputError:  # known by its stiffness
        if material is None:
            raise InputError("heat needs a coefficient of thermal expansion: give the beam a material") from None
        return [(material, np.zeros(5))]
