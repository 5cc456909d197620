"""Analyses are verbs on a model; they know coordinates, not elements."""
