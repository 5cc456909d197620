"""Whether double precision holds what the solvers form of a beam."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from beamfem.errors import InputError
from beamfem.section.protocol import CrossSection
from beamfem.validation import LARGEST, SMALLEST

if TYPE_CHECKING:
    from beamfem.model.beam import Beam


def require_magnitudes(beam: "Beam", section: CrossSection) -> None:
    """Raise InputError where a quantity that solvers form of a beam has no square in double precision.

    They are its coordinates and the length h of its shortest element [m], E A, k_s G A, E A / h, k_s G A h, E I / h and
    E I / h^3, the mass of an element and its rotary inertia over h^2, and of a body the moments of its section times E.
    """
    with np.errstate(over="ignore", under="ignore", divide="ignore", invalid="ignore"):
        formed = tuple(_formed(beam, section))
    for name, value, unit in formed:
        if not SMALLEST <= value <= LARGEST:
            raise InputError(
                f"{name} of {beam!r} is {value:g} {unit}, beyond what double precision can square ({SMALLEST:.1g} to "
                f"{LARGEST:.1g}); give all lengths, forces and masses in units in which they are closer to 1"
            )


def _formed(beam: "Beam", section: CrossSection) -> Iterator[tuple[str, float, str]]:
    curve = beam.curve
    yield "the length", float(curve.length), "m"
    reach = max(1.0, float(np.abs(curve.position(np.linspace(0.0, curve.length, 5))).max()))
    yield "the largest coordinate", reach, "m"
    h = curve.length * beam.shortest
    yield "the length h of the shortest element", h, "m"
    rigidity, inertia = section.rigidity(beam.material), section.inertia(beam.material)
    for name, value in (("E A", rigidity.axial), ("k_s G A", rigidity.shear)):
        yield name, value, "N"
        yield f"{name} / h", value / h, "N/m"
        yield f"{name} h", value * h, "N m"
    yield "E I / h", rigidity.bending / h, "N m"
    yield "E I / h^3", rigidity.bending / h / h / h, "N/m"
    yield "the mass of an element", inertia.mass * h, "kg"
    yield "the rotary inertia of an element over h^2", inertia.rotary / h, "kg"
    if beam.element.forces.fills_body:
        for material, moments in section.moments(beam.material):
            for order in (0, 2, 4):
                value = material.youngs_modulus * float(moments[order]) / h ** (order + 1)
                yield f"E times the moment of order {order} over h^{order + 1}", value, "N/m"
