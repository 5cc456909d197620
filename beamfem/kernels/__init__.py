"""Compiled kernels: plain arrays in, plain arrays out. Each is checked against `beamfem.forms`."""
