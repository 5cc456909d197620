"""Verification manual: published and independent values, and what beamfem gives."""
