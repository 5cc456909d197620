"""Geometry, loads and supports of beams, and the numbering of their coordinates; a model knows no solver."""
