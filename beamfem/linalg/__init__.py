"""Matrices of the unknown coordinates, their factors and their eigenpairs; they know no model."""
