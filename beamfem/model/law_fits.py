"""Check that a beam can have a section law."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.element.structural import Structural
from beamfem.errors import InputError
from beamfem.section.law import SectionLaw
from beamfem.section.law_checks import require_law
from beamfem.validation import fulfils, members

if TYPE_CHECKING:
    from beamfem.model.beam import Beam


def require_law_fits(beam: "Beam") -> None:
    """Raise InputError if the section has a law but the element assumes a linear one, or if the law is inconsistent.

    A law is a function of all strains at one point. Elements that evaluate some strains at other points, or replace
    them by assumed strains, are defined for quadratic energies only.
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
    if not isinstance(beam.element.forces, Structural):
        raise InputError(
            f"{name} has a law of its own, of stretch, shear and curvature: it needs Structural forces, such as "
            f"CRBF(order=2), but the element {beam.element.name} has {type(beam.element.forces).__name__}"
        )
    whole = np.ones((1, len(beam.element.energy_points()[0]), 4, 4))
    whole[..., 3, :] = whole[..., :, 3] = 0.0  # laws have no thickness stretch
    counted = beam.element.energy_stiffness(whole, np.ones(whole.shape[:2]))
    if not np.array_equal(counted, whole):
        raise InputError(
            f"{name} has a law of its own, for all strains at a point; the element {beam.element.name} takes some of "
            f"them at other points: use CRBF(order=2) or another order"
        )
    require_law(beam.law)


def _require_whole(section: object) -> None:
    """Raise InputError if a section has some methods of a law only: it would be taken as linear without a word."""
    lacking = [name for name in members(SectionLaw) if not hasattr(section, name)]
    found = [name for name in ("resultants", "energy", "remember") if hasattr(section, name)]
    if found and lacking:
        raise InputError(
            f"{type(section).__name__} has {found[0]}, but no {lacking[0]}: a section law needs "
            "resultants(strain, material) and energy(strain, material)"
        )
