"""States of a model as returned by the solvers, and derived results: reactions, section forces, stresses, energies."""

from beamfem.model.model import Model
from beamfem.registry import offer

offer(Model.with_imperfection, "beamfem.results.imperfection:with_imperfection")
