"""States of a model as returned by the solvers, and derived results: reactions, section forces, stresses, energies."""
