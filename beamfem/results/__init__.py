"""States of a model as solves hand them back, and what follows: reactions, section forces, stresses, energies."""

from beamfem.model.model import Model
from beamfem.registry import offer

offer(Model.with_imperfection, "beamfem.results.imperfection:with_imperfection")
