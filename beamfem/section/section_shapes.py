"""Sections of common shapes."""

import math
from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.moments import Section, required
from beamfem.section.outline import Part, RectangleOutline, StripOutline, TubeOutline
from beamfem.validation import positive


@dataclass(frozen=True)
class ShapedSection(Section):
    """A section of known shape, see `Rectangle`, `Circle`, `Tube`, `Polygon` and `Profile`.

    outline: its shape, or strips of it from the bottom up; third_moment: integral of y^3 dA [m^5].
    """

    outline: RectangleOutline | TubeOutline | tuple[StripOutline, ...] | None = field(default=None, repr=False)
    third_moment: float = field(default=0.0, repr=False)
    name: str = ""

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return the material with (A, 0, I, I3, I4), see `CrossSection.moments`. Raises InputError without one."""
        moments = [self.area, 0.0, self.second_moment, self.third_moment, self.fourth_moment]
        return [(required(material), np.array(moments))]

    def parts(self, material: Material | None) -> tuple[Part, ...]:
        """Return the section as a part for each outline. Raises InputError without a material."""
        if self.outline is None:
            return super().parts(material)
        outlines = self.outline if isinstance(self.outline, tuple) else (self.outline,)
        return tuple(Part(required(material).youngs_modulus, outline) for outline in outlines)


def Rectangle(width: float, height: float, shear_factor: float = 5 / 6) -> ShapedSection:
    """Return a rectangular section, with A = width height and I = width height^3 / 12.

    Raises InputError for a size that is not positive.

    Parameters
    ----------
    width : float, [m]
        Size out of the plane.
    height : float, [m]
        Size along y.
    shear_factor : float, [-], default 5/6
        Shear correction factor k_s.

    Examples
    --------
    >>> section = bf.Rectangle(0.05, 0.1)
    >>> round(section.area, 6), round(section.second_moment, 9)
    (0.005, 4.167e-06)
    """
    width, height = positive("width of Rectangle", width), positive("height of Rectangle", height)
    positive("shear_factor of Rectangle", shear_factor)
    outline = RectangleOutline(width, -0.5 * height, 0.5 * height)
    area, second = width * height, width * _power(height, 3) / 12.0
    _require_moments("Rectangle", area, second)
    return ShapedSection(area, second, shear_factor, height=height, outline=outline)


def Circle(diameter: float, shear_factor: float = 0.9) -> ShapedSection:
    """Return a full circular section.

    Its moments are A = pi d^2/4, I = pi d^4/64 and I4 = pi d^6/512. Raises InputError for a diameter that is not
    positive.

    Parameters
    ----------
    diameter : float, [m]
        Diameter d.
    shear_factor : float, [-], default 9/10
        Shear correction factor k_s; 9/10 follows from the energy of Jourawski's shear stress.

    Examples
    --------
    >>> section = bf.Circle(0.1)
    >>> round(section.area, 6), round(section.second_moment, 9)
    (0.007854, 4.909e-06)
    """
    diameter = positive("diameter of Circle", diameter)
    positive("shear_factor of Circle", shear_factor)
    return Tube(diameter, 0.5 * diameter, shear_factor)


def Tube(diameter: float, thickness: float, shear_factor: float = 0.5) -> ShapedSection:
    """Return a circular tube.

    Raises InputError for a size that is not positive, or a wall thicker than half the diameter.

    Parameters
    ----------
    diameter : float, [m]
        Outer diameter.
    thickness : float, [m]
        Wall thickness.
    shear_factor : float, [-], default 1/2
        Shear correction factor k_s; 1/2 is for a thin wall, 9/10 for a full circle.

    Examples
    --------
    >>> section = bf.Tube(0.1, 0.005)
    >>> round(section.area, 6), round(section.second_moment, 9)
    (0.001492, 1.688e-06)
    """
    diameter, thickness = positive("diameter of Tube", diameter), positive("thickness of Tube", thickness)
    positive("shear_factor of Tube", shear_factor)
    if thickness > 0.5 * diameter:
        raise InputError(f"the wall of a Tube ({thickness:g}) is at most half its diameter ({diameter:g})")
    inner = diameter - 2.0 * thickness
    powers = (_power(diameter, n) - _power(inner, n) for n in (2, 4, 6))
    area, second, fourth = (np.pi * power / divisor for power, divisor in zip(powers, (4.0, 64.0, 512.0), strict=True))
    _require_moments("Tube", area, second, fourth)
    outline = TubeOutline(0.5 * diameter, 0.5 * inner)
    return ShapedSection(area, second, shear_factor, fourth, height=diameter, outline=outline)


def _power(length: float, order: int) -> float:
    """Return a power, inf if it overflows; the operator ** would raise an exception."""
    return math.prod([length] * order)


def _require_moments(kind: str, *moments: float) -> None:
    """Raise InputError if the moments [m^2, m^4, m^6] of a section overflow or underflow double precision."""
    for name, value in zip(("area", "second moment", "fourth moment"), moments, strict=False):
        if not 0.0 < value < math.inf:
            raise InputError(f"the {name} of this {kind} is {value:g} in double precision; give lengths in other units")
