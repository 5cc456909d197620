"""Beam elements: independent choices of a field, its nodal coordinates and the elastic forces."""
