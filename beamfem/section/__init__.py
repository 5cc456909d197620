"""Cross-sections, given by area moments, shape, layers or stiffness."""

from beamfem.section.fibre_laws import ElasticPlastic, FibreLaw, FibreLawWithHistory, Maxwell, RambergOsgood
from beamfem.section.fibres import ElasticFibreSection, Fibres, RememberingFibreSection
from beamfem.section.law import RememberingLaw, SectionLaw
from beamfem.section.layered import Layer, Layered
from beamfem.section.moments import Section, StiffnessSection
from beamfem.section.polygon import Polygon
from beamfem.section.profiles import Profile
from beamfem.section.section_shapes import Circle, Rectangle, ShapedSection, Tube
