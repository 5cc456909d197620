"""Meshes of beams, the numbers of their coordinates, and their stress-free reference."""
