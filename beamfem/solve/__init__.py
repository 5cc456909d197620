"""Solves are verbs on a model; they know coordinates, not elements."""

from beamfem.registry import offer
from beamfem.results.solution import Solution

offer(Solution._stable_rows, "beamfem.solve.stability.stability:stable_rows")
