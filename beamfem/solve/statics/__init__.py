"""Equilibria under loads that grow step by step."""
