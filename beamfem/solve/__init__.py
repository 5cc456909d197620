"""Analyses of a model: statics, equilibrium paths, stability, modes and motion, in terms of coordinates alone."""
