"""Mesh and step convergence of any function."""
