"""Equilibrium paths and their branches."""
