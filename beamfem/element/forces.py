"""Elastic forces: strain measures and the section stiffness that goes with them."""

from beamfem.element.continuum import ContinuumMechanics, SplitContinuum
from beamfem.element.elastic_line import ElasticLine
from beamfem.element.structural import Structural

Forces = ContinuumMechanics | SplitContinuum | ElasticLine | Structural

__all__ = ["ContinuumMechanics", "ElasticLine", "Forces", "SplitContinuum", "Structural"]
