"""Protocols of sections, for elastic forces and inertia."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from beamfem.material import Material
from beamfem.section.outline import Part


@dataclass(frozen=True)
class Rigidity:
    """Stiffness of a section: axial [N], shear [N], bending [N m^2] and coupling of stretch with curvature [N m]."""

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
    """A section; the material is None if the section includes its materials."""

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
        """Return each material with a mask of the heights y [m] at which it is found."""
        ...

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return each material with quadrature heights y [m] and weights [m^2] over its part."""
        ...


@runtime_checkable
class HasParts(Protocol):
    """A section that provides its outline, as far as it is known."""

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return the parts of the section from the bottom up, each with its Young's modulus and outline."""
        ...
