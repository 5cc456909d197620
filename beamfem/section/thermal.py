"""Thermal strains of an unconstrained section."""

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.protocol import CrossSection


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
