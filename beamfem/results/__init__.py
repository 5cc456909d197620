"""States of a model as solves hand them back, and what follows: reactions, section forces, stresses, energies."""
