"""Protocols of sections, for elastic forces and inertia."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from beamfem.material import Material
from beamfem.section.outline import Part


@dataclass(frozen=True)
class Rigidity:
    """Stiffness of a section about the beam's axis.

    Parameters
    ----------
    axial : float, [N]
        Axial stiffness E A.
    shear : float, [N]
        Shear stiffness k_s G A.
    bending : float, [N m^2]
        Bending stiffness E I.
    coupling : float, [N m], default 0
        Coupling of stretch with curvature.
    """

    axial: float
    shear: float
    bending: float
    coupling: float = 0.0


@dataclass(frozen=True)
class Inertia:
    """Inertia of a section about the beam's axis.

    Parameters
    ----------
    mass : float, [kg/m]
        Mass per length.
    first_moment : float, [kg]
        Integral of the density times y over the section.
    rotary : float, [kg m]
        Integral of the density times y^2 over the section: the rotary inertia per length.
    """

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
        """Return the parts from the bottom up, from which the stress over the height follows.

        Raises InputError if the section needs a material and gets none.
        """
