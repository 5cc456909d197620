"""Pictures and pages; what draws them is imported at the first call."""
