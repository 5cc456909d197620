"""Masses, springs, dampers and links at points, one file each."""
