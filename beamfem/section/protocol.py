"""Protocols of sections, for elastic forces and inertia."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from beamfem.material import Material
from beamfem.section.outline import Part


@dataclass(frozen=True)
class Rigidity:
    """E A [N], k_s G A [N], E I [N m^2], and the coupling of stretch with curvature [N m], about the beam's axis."""

    axial: float
    shear: float
    bending: float
    coupling: float = 0.0


@dataclass(frozen=True)
class Inertia:
    """Mass per length [kg/m] and the integrals of the density times y [kg] and y^2 [kg m], about the beam's axis."""

    mass: float
    first_moment: float
    rotary: float


@runtime_checkable
class CrossSection(Protocol):
    """Protocol of sections. The material is that of the beam, None if the section has its own.

    Methods that need a material raise an InputError without one.
    """

    @property
    def shear_factor(self) -> float:
        """Shear correction factor k_s [-]."""

    @property
    def bounds(self) -> tuple[float, float]:
        """Heights y [m] of the lower and the upper face of the body that is drawn, from the axis."""

    def rigidity(self, material: Material | None) -> Rigidity:
        """Return the stiffness of the section about the axis of the beam."""

    def inertia(self, material: Material | None) -> Inertia:
        """Return the inertia of the section per length about the axis of the beam."""

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return each material with the integrals of 1, y, ..., y^4 (5,) [m^2 to m^6] over its part, y from axis."""

    def materials_at(self, y: np.ndarray, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return each material with a mask (n,) of those of the heights y (n,) [m] that are in its part."""

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return a quadrature over the height of the part of each material, for bodies with a curved reference.

        It has heights y (n,) [m] and weights (n,) [m^2].
        """


@runtime_checkable
class HasParts(Protocol):
    """A section whose shape is known, at least in part."""

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return the parts from the bottom up, from which the stress over the height follows."""
