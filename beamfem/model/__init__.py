"""Geometry, loads and supports of beams, and the numbering of their coordinates; independent of solvers."""
