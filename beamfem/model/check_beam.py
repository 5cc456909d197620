"""Checks of a beam where it is made: its section law, and the range of the quantities that solvers compute from it."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.curves import Line
from beamfem.element.coordinates import ShearFree
from beamfem.element.forces import Structural
from beamfem.errors import InputError
from beamfem.section.law import ConstitutiveLaw, SectionLaw
from beamfem.section.protocol import CrossSection
from beamfem.validation import LARGEST, SMALLEST, fulfils, members

if TYPE_CHECKING:
    from beamfem.model.beam import Beam


def require_law_fits(beam: "Beam") -> None:
    """Raise InputError if the section has a law but the element assumes a linear one, or if the law returns
    arrays of another shape or numbers that are not finite.

    A law is a function of all strains at one point. Elements that evaluate some strains at other points, or scale them
    there, are defined for quadratic energies only. A shear that is zero at the nodes, for example, is 3/2 of its mean
    at the midpoint: no factor and weight give a law both this mean and the stretch and curvature of the point.
    """
    if not beam.prismatic:
        section = beam.section_at(0.0)
        _require_whole(section)
        if fulfils(section, SectionLaw):
            raise InputError(
                "the section of a Beam is a function of the arc length, but a section with a law of its own must be "
                "the same all along: join beams, each with its own"
            )
        return
    if beam.law is None:
        _require_whole(beam.section)
        return
    name = type(beam.section).__name__
    element = beam.element
    if not isinstance(element.forces, Structural):
        raise InputError(
            f"{name} has a law of its own, of stretch, shear and curvature: it needs Structural forces, such as "
            f"CRBF(order=2) or ANCF(Structural()), but the element {element.name} has {type(element.forces).__name__}"
        )
    if not element.law_points:
        why = ", since its nodes do not shear" if isinstance(element.coordinates, ShearFree) else ""
        raise InputError(
            f"{name} has a law of its own, for stretch, shear and curvature at one point; the element {element.name} "
            f'with integration="{element.integration}" takes some of them at other points or scales them{why}: use '
            "CRBF(order=3), ANCF(Structural()), ANCFCRBF(Structural()) or, without shear at the nodes, "
            'ShearRigid(stretchable=False, integration="reduced")'
        )
    require_shapes(beam.law)


def require_shapes(law: ConstitutiveLaw) -> None:
    """Raise InputError if a law returns arrays of another shape, or numbers that are not finite, at zero strain."""
    if not fulfils(law.section, CrossSection):
        raise InputError(f"{law.name} has resultants, but is no section: it lacks members of CrossSection")
    zero, start = np.zeros((2, 3)), law.at_start(2)
    values = [*law.linearised(zero, start), law.energy(zero, start)]
    if law.remembers:
        values.append(law.remember(zero, start))
    if not all(np.isfinite(each).all() for each in values):
        raise InputError(f"resultants, tangent and energy of {law.name} must be finite at zero strain")


def _require_whole(section: object) -> None:
    """Raise InputError if a section has some methods of a law only: it would be taken as linear without a word."""
    lacking = [name for name in members(SectionLaw) if not hasattr(section, name)]
    found = [name for name in ("resultants", "energy", "remember") if hasattr(section, name)]
    if found and lacking:
        raise InputError(
            f"{type(section).__name__} has {found[0]}, but no {lacking[0]}: a section law needs "
            "resultants(strain, material) and energy(strain, material)"
        )


_SAMPLES = 5  # points of a curve at which its coordinates are checked


def require_magnitudes(beam: "Beam", section: CrossSection) -> None:
    """Raise InputError if the square of a quantity that solvers compute from a beam exceeds double precision.

    The quantities are coordinates and the length h of the shortest element [m]; E A and k_s G A, also times and over h;
    E I / h and E I / h^3; the mass of an element and its rotary inertia over h^2; and for bodies, the section moments
    times E over powers of h.
    """
    for name, value in _quantities(beam, section):
        if not SMALLEST <= value <= LARGEST:
            raise InputError(
                f"{name} of {beam!r} is {value:g}, beyond what double precision can square ({SMALLEST:.1g} to "
                f"{LARGEST:.1g}); give all lengths, forces and masses in units in which they are closer to 1"
            )


def _quantities(beam: "Beam", section: CrossSection) -> list[tuple[str, float]]:
    """Return the quantities as Python floats, whose products and quotients overflow without a warning."""
    curve = beam.curve
    length = float(curve.length)
    if type(curve) is Line:
        reach = max(*map(abs, curve.start), *map(abs, curve.end), 1.0)
    else:
        reach = max(float(np.abs(curve.position(np.linspace(0.0, length, _SAMPLES))).max()), 1.0)
    h = length * beam.shortest
    lengths = [("the length", length), ("the largest coordinate", reach), ("the length h of the shortest element", h)]
    if not h > 0.0:
        return lengths
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        rigidity, inertia = section.rigidity(beam.material), section.inertia(beam.material)
        parts = section.moments(beam.material) if beam.element.forces.fills_body else []
    axial, shear, bending = float(rigidity.axial), float(rigidity.shear), float(rigidity.bending)
    result = [
        *lengths,
        ("E A", axial),
        ("E A / h", axial / h),
        ("E A h", axial * h),
        ("k_s G A", shear),
        ("k_s G A / h", shear / h),
        ("k_s G A h", shear * h),
        ("E I / h", bending / h),
        ("E I / h^3", bending / h / h / h),
        ("the mass of an element", float(inertia.mass) * h),
        ("the rotary inertia of an element over h^2", float(inertia.rotary) / h),
    ]
    for material, moments in parts:
        area, second, fourth = (material.youngs_modulus * moments[order].item() / h for order in (0, 2, 4))
        result += [
            ("E times the moment of order 0 over h^1", area),
            ("E times the moment of order 2 over h^3", second / h / h),
            ("E times the moment of order 4 over h^5", fourth / h / h / h / h),
        ]
    return result
