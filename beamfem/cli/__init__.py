"""The command `beamfem`."""
