"""Analyses of a model: statics, equilibrium paths, stability, modes and motion, in terms of coordinates alone."""

from beamfem.registry import offer
from beamfem.results.solution import Solution

offer(Solution._stable_rows, "beamfem.solve.stability.stability:stable_rows")
