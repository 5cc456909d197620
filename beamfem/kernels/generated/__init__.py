"""Passes written by `beamfem.physics.generate`."""
