"""Check that a beam can have a section law."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.element.coordinates import ShearFree
from beamfem.element.structural import Structural
from beamfem.errors import InputError
from beamfem.section.law import ConstitutiveLaw, SectionLaw
from beamfem.section.protocol import CrossSection
from beamfem.validation import fulfils, members

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
