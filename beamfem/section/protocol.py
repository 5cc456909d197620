"""What elastic forces and inertia need of a section."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from beamfem.material import Material
from beamfem.section.outline import Part


@dataclass(frozen=True)
class Rigidity:
    """Resistance of a section: axial [N], shear [N], bending [N m^2] and coupling of stretch with curvature [N m]."""

    axial: float
    shear: float
    bending: float
    coupling: float = 0.0


@dataclass(frozen=True)
class Inertia:
    """Mass per length [kg/m], its first moment over y [kg] and its second [kg m]."""

    mass: float
    first_moment: float
    rotary: float


@runtime_checkable
class CrossSection(Protocol):
    """A section; the material is None if the section brings its own."""

    @property
    def shear_factor(self) -> float: ...
    @property
    def bounds(self) -> tuple[float, float]: ...  # [m], y of the lower and upper face of the body that is drawn
    def rigidity(self, material: Material | None) -> Rigidity: ...
    def inertia(self, material: Material | None) -> Inertia: ...

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return each material with the integrals of 1, y, y^2, y^3, y^4 [m^2 ... m^6] over its part."""
        ...

    def materials_at(self, y: np.ndarray, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return each material with the heights of y [m] where it is, as booleans of the shape of y."""
        ...

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return each material with quadrature heights y [m] and weights [m^2] over its part."""
        ...


@runtime_checkable
class HasParts(Protocol):
    """A section that knows its shape, or as much of it as there is to know."""

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return its parts of one material from the bottom up, each with its outline."""
        ...
