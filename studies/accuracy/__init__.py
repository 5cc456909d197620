"""Estimated against true errors, and meshes refined to an accuracy against the best uniform ones."""
