"""Equilibrium paths, buckling and flutter of frames and columns from the literature."""
