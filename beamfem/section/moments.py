"""Sections of one material, by their area moments."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.quadrature import gauss_between
from beamfem.section.outline import MomentsOutline, Part
from beamfem.section.protocol import Inertia, Rigidity
from beamfem.section.stiffness import StiffnessSection
from beamfem.validation import convert, positive

_ROUNDING = 1e-9  # of numbers from tables
_STRIPS = 8  # Gauss points over the height, for a body whose reference is curved


@dataclass(frozen=True)
class Section:
    """Section by its area moments; without `fourth_moment` that of the rectangle of the same area and second moment.

    area A [m^2], second_moment I [m^4], shear_factor k_s [-], fourth_moment I4 = integral of y^4 dA [m^6].
    For a rectangle h = sqrt(12 I / A) and I4 = A h^4 / 80.
    height [m], centroid [m] above the lower face (the default is mid-height): where the faces are, for bodies and their
    stress. Without a height the body is drawn as that rectangle and its faces have no stress. Raises InputError.
    """

    area: float
    second_moment: float
    shear_factor: float = 5 / 6
    fourth_moment: float | None = None
    height: float | None = None
    centroid: float | None = None

    def __post_init__(self) -> None:
        convert(self, positive, "area", "second_moment", "shear_factor")
        least = self.second_moment / self.area * self.second_moment  # the rectangle's is 9/5 of it
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
        """Return a section by its stiffness: E A [N], k_s G A [N], E I [N m^2], mass [kg/m], rotary inertia [kg m].

        coupling [N m] of stretch with curvature, from a neutral axis off the beam's axis: N = E A eps + C kappa,
        M = C eps + E I kappa. Needs no material. Raises InputError.
        """
        return StiffnessSection(axial, shear, bending, mass, rotary_inertia, coupling)

    @property
    def width(self) -> float:
        """Width of the equivalent rectangle [m]."""
        return self.area / self._equivalent_height

    @property
    def bounds(self) -> tuple[float, float]:
        """Lower and upper y [m] of the faces, those of the equivalent rectangle where no height is given."""
        if self.height is None or self.centroid is None:
            return -0.5 * self._equivalent_height, 0.5 * self._equivalent_height
        return -self.centroid, self.height - self.centroid

    @property
    def _equivalent_height(self) -> float:
        return float(np.sqrt(12.0 * self.second_moment / self.area))

    def rigidity(self, material: Material | None) -> Rigidity:
        """Return E A, k_s G A and E I. Raises InputError without a material."""
        own = required(material)
        modulus = own.youngs_modulus
        shear = self.shear_factor * own.shear_modulus * self.area
        return Rigidity(modulus * self.area, shear, modulus * self.second_moment)

    def inertia(self, material: Material | None) -> Inertia:
        """Return density times area and second moment. Raises InputError without a material."""
        density = required(material).density
        return Inertia(density * self.area, 0.0, density * self.second_moment)

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return the material with A, 0, I, 0, I4. Raises InputError without a material."""
        return [(required(material), np.array([self.area, 0.0, self.second_moment, 0.0, self.fourth_moment]))]

    def materials_at(self, y: np.ndarray, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return the material at all heights."""
        return [(required(material), np.ones_like(y, dtype=bool))]

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return the material with heights and weights over the equivalent rectangle."""
        half = 0.5 * self._equivalent_height
        heights, weights = gauss_between(-half, half, _STRIPS)
        return [(required(material), heights, self.width * weights)]

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return the section as one part of which the moments are known, and the height where it was given."""
        low, high = self.bounds
        moments = (self.area, 0.0, self.second_moment, 0.0, float(self.fourth_moment or 0.0))
        return (Part(required(material).youngs_modulus, MomentsOutline(moments, low, high, self.height is not None)),)


def required(material: Material | None) -> Material:
    """Return the material, or raise InputError if a section needs one and has none."""
    if material is None:
        raise InputError("this section needs a material: give Beam one, or use a section with materials of its own")
    return material
