"""A section given by its stiffness."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.protocol import Inertia, Rigidity
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
