"""Sections of common shapes."""

import math
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
    width, height = positive("width of Rectangle", width), positive("height of Rectangle", height)
    positive("shear_factor of Rectangle", shear_factor)
    outline = RectangleOutline(width, -0.5 * height, 0.5 * height)
    area, second = width * height, width * _power(height, 3) / 12.0
    _require_moments("Rectangle", area, second)
    return ShapedSection(area, second, shear_factor, height=height, outline=outline)


def Circle(diameter: float, shear_factor: float = 0.9) -> Section:
    """Return the full circular section of a diameter [m]: A = pi d^2/4, I = pi d^4/64, I4 = pi d^6/512.

    shear_factor: 9/10 by the energy of Jourawski's stress. Raises InputError.
    """
    diameter = positive("diameter of Circle", diameter)
    positive("shear_factor of Circle", shear_factor)
    return Tube(diameter, 0.5 * diameter, shear_factor)


def Tube(diameter: float, thickness: float, shear_factor: float = 0.5) -> Section:
    """Return the circular tube of an outer diameter [m] and a wall thickness [m].

    shear_factor: 1/2, right for a thin wall; a full circle has 9/10. Raises InputError.
    """
    diameter, thickness = positive("diameter of Tube", diameter), positive("thickness of Tube", thickness)
    positive("shear_factor of Tube", shear_factor)
    if thickness > 0.5 * diameter:
        raise InputError(f"the wall of a Tube ({thickness:g}) is at most half its diameter ({diameter:g})")
    inner = diameter - 2.0 * thickness
    powers = (_power(diameter, n) - _power(inner, n) for n in (2, 4, 6))
    area, second, fourth = (np.pi * power / by for power, by in zip(powers, (4.0, 64.0, 512.0), strict=True))
    _require_moments("Tube", area, second, fourth)
    outline = TubeOutline(0.5 * diameter, 0.5 * inner)
    return ShapedSection(area, second, shear_factor, fourth, height=diameter, outline=outline)


def _power(length: float, order: int) -> float:
    """Return a power, inf where it is too large; the operator would raise an exception."""
    return math.prod([length] * order)


def _require_moments(kind: str, *moments: float) -> None:
    """Raise InputError if double precision has no moments [m^2, m^4, m^6] of a section so large or small."""
    for name, value in zip(("area", "second moment", "fourth moment"), moments, strict=False):
        if not 0.0 < value < math.inf:
            raise InputError(f"the {name} of this {kind} is {value:g} in double precision; give lengths in other units")
