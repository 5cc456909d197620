"""Check that the quantities that solvers compute from a beam are in the range of double precision."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.curves import Line
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.protocol import CrossSection
from beamfem.validation import LARGEST, SMALLEST

if TYPE_CHECKING:
    from beamfem.model.beam import Beam

_SAMPLES = 5  # points of a curve at which its coordinates are checked


def require_magnitudes(beam: "Beam", section: CrossSection) -> None:
    """Raise InputError if the square of a quantity that solvers compute from a beam exceeds double precision.

    The quantities are coordinates and the length h of the shortest element [m]; E A and k_s G A, also times and over h;
    E I / h and E I / h^3; the mass of an element and its rotary inertia over h^2; and for bodies, the section moments
    times E over powers of h.
    """
    quantities = _formed(beam, section)
    if all(SMALLEST <= value <= LARGEST for value in quantities):
        return
    for name, value in zip(_names(beam, section), quantities, strict=True):
        if not SMALLEST <= value <= LARGEST:
            raise InputError(
                f"{name} of {beam!r} is {value:g}, beyond what double precision can square ({SMALLEST:.1g} to "
                f"{LARGEST:.1g}); give all lengths, forces and masses in units in which they are closer to 1"
            )


def _formed(beam: "Beam", section: CrossSection) -> list[float]:
    """Return the quantities as Python floats, whose products and quotients overflow without a warning."""
    curve = beam.curve
    length = float(curve.length)
    if type(curve) is Line:
        reach = max(*map(abs, curve.start), *map(abs, curve.end), 1.0)
    else:
        reach = max(float(np.abs(curve.position(np.linspace(0.0, length, _SAMPLES))).max()), 1.0)
    h = length * beam.shortest
    if not h > 0.0:
        return [length, reach, h]
    axial, shear, bending, mass, rotary = _resistance(section, beam.material)
    quantities = [length, reach, h, axial, axial / h, axial * h, shear, shear / h, shear * h]
    quantities += (bending / h, bending / h / h / h, mass * h, rotary / h)
    if beam.element.forces.fills_body:
        with np.errstate(over="ignore", under="ignore"):
            parts = section.moments(beam.material)
        for material, moments in parts:
            area, second, fourth = (material.youngs_modulus * moments[order].item() / h for order in (0, 2, 4))
            quantities += [area, second / h / h, fourth / h / h / h / h]
    return quantities


def _resistance(section: CrossSection, material: Material | None) -> tuple[float, ...]:
    """Return E A, k_s G A [N], E I [N m^2], mass [kg/m] and rotary inertia [kg m]."""
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        rigidity, inertia = section.rigidity(material), section.inertia(material)
    return tuple(map(float, (rigidity.axial, rigidity.shear, rigidity.bending, inertia.mass, inertia.rotary)))


def _names(beam: "Beam", section: CrossSection) -> list[str]:
    names = ["the length", "the largest coordinate", "the length h of the shortest element"]
    if not beam.curve.length * beam.shortest > 0.0:
        return names
    for stiffness in ("E A", "k_s G A"):
        names += [stiffness, f"{stiffness} / h", f"{stiffness} h"]
    names += ["E I / h", "E I / h^3", "the mass of an element", "the rotary inertia of an element over h^2"]
    if beam.element.forces.fills_body:
        for _ in section.moments(beam.material):
            names += [f"E times the moment of order {order} over h^{order + 1}" for order in (0, 2, 4)]
    return names
