"""Estimates of the discretisation error of results."""
