"""Cross-sections, given by area moments, shape, layers or stiffness."""

from beamfem.section.law import RememberingLaw, SectionLaw
from beamfem.section.layered import Layer, Layered
from beamfem.section.moments import Section
from beamfem.section.section_shapes import Circle, Rectangle, ShapedSection, Tube
from beamfem.section.section_stiffness import StiffnessSection

__all__ = [
    "Circle",
    "Layer",
    "Layered",
    "Rectangle",
    "RememberingLaw",
    "Section",
    "SectionLaw",
    "ShapedSection",
    "StiffnessSection",
    "Tube",
]
