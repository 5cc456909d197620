"""States of a model as returned by the solvers, and derived results: reactions, section forces, stresses, energies."""

from beamfem.model.model_outputs import ModelOutputs
from beamfem.registry import offer

offer(ModelOutputs.with_imperfection, "beamfem.results.imperfection:with_imperfection")
