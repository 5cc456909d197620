"""Matrices of the unknown coordinates, their factorisations and eigenpairs, independent of any model."""
