"""Sections of common shapes."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.moments import Section, required
from beamfem.section.outline import Part, RectangleOutline, TubeOutline
from beamfem.validation import positive


@dataclass(frozen=True)
class ShapedSection(Section):
    """A section of which the shape is known: a rectangle, a circle or a tube; see `Rectangle`, `Circle` and `Tube`."""

    outline: RectangleOutline | TubeOutline | None = None

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return the section as one part with its outline."""
        if self.outline is None:
            return super().parts(material)
        return (Part(required(material).youngs_modulus, self.outline),)


def Rectangle(width: float, height: float, shear_factor: float = 5 / 6) -> Section:
    """Return the rectangular section width [m] (out of the plane) x height [m] (along y). Raises InputError."""
    positive("width", width)
    positive("height", height)
    outline = RectangleOutline(width, -0.5 * height, 0.5 * height)
    return ShapedSection(width * height, width * height**3 / 12.0, shear_factor, height=height, outline=outline)


def Circle(diameter: float, shear_factor: float = 0.9) -> Section:
    """Return the full circular section of a diameter [m]: A = pi d^2/4, I = pi d^4/64, I4 = pi d^6/512.

    shear_factor: 9/10 by the energy of Jourawski's stress. Raises InputError.
    """
    positive("diameter", diameter)
    return Tube(diameter, 0.5 * diameter, shear_factor)


def Tube(diameter: float, thickness: float, shear_factor: float = 0.5) -> Section:
    """Return the circular tube of an outer diameter [m] and a wall thickness [m].

    shear_factor: 1/2, right for a thin wall; a full circle has 9/10. Raises InputError.
    """
    positive("diameter", diameter)
    positive("thickness", thickness)
    if thickness > 0.5 * diameter:
        raise InputError(f"the wall of a Tube ({thickness:g} m) is at most half its diameter ({diameter:g} m)")
    inner = diameter - 2.0 * thickness
    area = np.pi * (diameter**2 - inner**2) / 4.0
    second = np.pi * (diameter**4 - inner**4) / 64.0
    fourth = np.pi * (diameter**6 - inner**6) / 512.0
    outline = TubeOutline(0.5 * diameter, 0.5 * inner)
    return ShapedSection(
        float(area), float(second), shear_factor, float(fourth), height=float(diameter), outline=outline
    )
