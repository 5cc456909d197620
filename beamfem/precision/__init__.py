"""Bounds of round-off and tangents that keep the last digits of results."""
